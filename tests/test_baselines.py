"""Behaviour cloning, CQL and GAIL: each loss against brute force, each ingredient at work."""

import math

import numpy as np
import pytest
import torch

from bootcourse.errors import BootcourseError
from bootcourse.learn import bc, cql, gail, sac
from bootcourse.learn.learner import SACLearner, learner_for
from bootcourse.learn.networks import init_mlp, mlp
from bootcourse.learn.replay_buffer import Batch
from bootcourse.learn.settings import settings_for, with_seeds
from bootcourse.learn.training import Training


def a_batch(agents: int = 2, batch: int = 6, demonstrations: int = 3, seed: int = 0) -> Batch:
    """Random transitions, the first of them demonstrations; 26 numbers, 9 actions."""
    rng = np.random.default_rng(seed)
    states, next_states = torch.from_numpy(rng.normal(size=(2, agents, batch, 26))).float()
    actions, rule_actions, next_rule_actions = torch.from_numpy(rng.integers(9, size=(3, agents, batch)))
    rewards = torch.from_numpy(rng.normal(size=(agents, batch))).float()
    terminated = torch.from_numpy(rng.integers(2, size=(agents, batch))).float()
    is_demonstration = (torch.arange(batch) < demonstrations).float().expand(agents, batch)
    return Batch(states, next_states, actions, rewards, terminated, rule_actions, next_rule_actions, is_demonstration)


def learner(method: str, seeds: int = 2, **changes) -> SACLearner:
    return learner_for(with_seeds(settings_for(method, **changes), seeds), 26)


def test_the_cloning_loss_is_the_mean_of_minus_log_pi_of_what_the_demonstrator_did():
    log_pi = torch.randn(2, 4, 9).log_softmax(-1)
    actions = torch.randint(9, (2, 4))
    by_hand = [[-log_pi[i, j, actions[i, j]].item() for j in range(4)] for i in range(2)]
    np.testing.assert_allclose(bc.cloning_loss(log_pi, actions), np.mean(by_hand, axis=1), rtol=1e-6)


def test_the_conservative_term_is_log_sum_exp_less_the_value_of_what_the_data_did():
    q, actions = torch.randn(2, 4, 3), torch.randint(3, (2, 4))
    by_hand = [
        np.mean([math.log(sum(math.exp(x) for x in row)) - row[a] for row, a in zip(rows.tolist(), taken, strict=True)])
        for rows, taken in zip(q, actions.tolist(), strict=True)
    ]
    np.testing.assert_allclose(sac.conservative_loss(q, actions), by_hand, rtol=1e-5)


def test_double_q_learning_chooses_with_one_critic_and_values_with_the_other():
    q, q_next = torch.tensor([[0.0, 2.0, 1.0]]), torch.tensor([[5.0, 6.0, 7.0]])
    assert cql.greedy_value(q, q_next).tolist() == [6.0]


def test_the_discriminator_s_loss_is_the_cross_entropy_of_telling_the_two_apart():
    expert, own = torch.randn(2, 5), torch.randn(2, 5)
    d_expert, d_own = (1 / (1 + np.exp(-x.double().numpy())) for x in (expert, own))
    by_hand = -np.log(d_expert).mean(-1) - np.log(1 - d_own).mean(-1)
    np.testing.assert_allclose(gail.discriminator_loss(expert, own), by_hand, rtol=1e-5)


def test_the_imitation_reward_is_minus_log_of_one_minus_d_and_never_negative():
    logits = torch.linspace(-5, 5, 11)
    d = 1 / (1 + np.exp(-logits.double().numpy()))
    np.testing.assert_allclose(gail.imitation_reward(logits), -np.log(1 - d), rtol=1e-5)
    assert (gail.imitation_reward(logits) >= 0).all()


def test_the_gradient_penalty_is_half_the_squared_slope_by_finite_differences():
    network = [p.double() for p in init_mlp((4, 8, 1), [torch.Generator().manual_seed(i) for i in range(2)])]
    expert = torch.randn(2, 3, 4, dtype=torch.float64)
    step = 1e-6 * torch.eye(4, dtype=torch.float64)
    slopes = [(mlp(network, expert + d) - mlp(network, expert - d)).squeeze(-1) / 2e-6 for d in step]
    by_hand = (torch.stack(slopes, -1) ** 2).sum(-1).mean(-1) / 2
    np.testing.assert_allclose(gail.gradient_penalty(network, expert).detach(), by_hand, rtol=1e-6)


def test_a_clone_learns_what_was_done_and_dagger_what_the_teacher_would_have_done():
    batch = a_batch()._replace(actions=torch.full((2, 6), 7), rule_actions=torch.full((2, 6), 1))
    for method, learned, other in (("bc", 7, 1), ("dagger", 1, 7)):
        cloner = learner(method)
        pi = cloner.probabilities(batch.states)
        by_hand = -pi[..., learned].log().mean(1)
        torch.testing.assert_close(cloner.losses(batch)["actor_loss"].detach(), by_hand)
        for _ in range(20):
            cloner.update(batch)
        after = cloner.probabilities(batch.states)
        assert (after[..., learned] / after[..., other] > pi[..., learned] / pi[..., other]).all()


def test_cql_drives_by_the_softmax_of_its_first_critic_over_alpha():
    one, batch = learner("cql", alpha_init=0.5), a_batch()
    one.update(batch)
    q = one.q_pair(one.critics, batch.states)[0]
    torch.testing.assert_close(one.probabilities(batch.states), (q / 0.5).softmax(-1))


def test_gail_never_looks_at_the_road_s_reward():
    first, second = learner("gail"), learner("gail")
    first.update(a_batch())
    second.update(a_batch()._replace(rewards=torch.full((2, 6), 1e3)))
    pairs = zip([*first.critics, *first.actor], [*second.critics, *second.actor], strict=True)
    assert all(torch.equal(one, other) for one, other in pairs)


def test_a_batch_that_gail_cannot_halve_is_refused():
    with pytest.raises(BootcourseError, match="leave beta_start at 0.5"):
        learner("gail").update(a_batch(demonstrations=2))


@pytest.mark.parametrize(
    ("method", "share"), [("bc", 1.0), ("cql", 1.0), ("cql_sac", 1.0), ("gail", 0.5), ("dagger", 0.5), ("rlpd", 0.5)]
)
def test_the_demonstrations_share_of_a_batch_stays_where_it_starts(method, share):
    training = Training([settings_for(method, demonstration_episodes=2, learning_starts=16)], 10)
    training.step()
    for finished in (0, 5000):
        training.curves.finished[:] = finished
        batch = training.replay.sample(64, training.beta, training.sample_rngs)
        assert batch.is_demonstration.mean().item() == share
