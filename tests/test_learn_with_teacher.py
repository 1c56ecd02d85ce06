"""JSRL, RLPD and IBRL: equations and targets against numbers worked by hand, the curriculum, their files."""

import math

import numpy as np
import pytest
import torch

from bootcourse.learn.ibrl import better_of_two
from bootcourse.learn.jsrl import guide_decisions, holds
from bootcourse.learn.learner import SACLearner, learner_for
from bootcourse.learn.networks import init_mlp
from bootcourse.learn.rlpd import normalised_mlp, smallest_of
from bootcourse.learn.settings import settings_for, with_seeds
from tests.test_baselines import a_batch


def learner(method: str, seeds: int = 2, **changes) -> SACLearner:
    return learner_for(with_seeds(settings_for(method, hidden=(8,), **changes), seeds), 26)


# JSRL


def curriculum(*returns: float, **changes) -> list[int]:
    """h before the first episode and after each of the episodes with these returns: one road, two counted at a time."""
    usual = {"guide_decisions": 12, "stages": 3, "window": 2, "tolerance": 0.1, "envs_per_agent": 1}
    one = learner("jsrl", 1, **(usual | changes))
    guides = [int(one.guided)]
    for total in returns:
        one.note_episodes(np.array([[True]]), np.array([[total]]))
        guides.append(int(one.guided))
    return guides


def test_the_teacher_s_part_shrinks_in_equal_steps():
    assert [guide_decisions(stage, 10, 150) for stage in range(11)] == list(range(150, -1, -15))


def test_a_return_holds_within_the_tolerance_of_the_best_so_far():
    assert holds(45.0, 50.0, 0.1) and not holds(44.9, 50.0, 0.1) and holds(60.0, 50.0, 0.0)
    assert holds(-11.0, -10.0, 0.1) and not holds(-11.1, -10.0, 0.1)
    assert holds(-8.0, -math.inf, 0.0)


def test_the_curriculum_takes_a_step_when_the_mean_of_the_last_episodes_holds():
    assert curriculum(50, 50) == [12, 12, 8]  # the first mean is the best so far
    assert curriculum(50, 50, 40, 40, 50) == [12, 12, 8, 8, 8, 4]  # 40 is too low, and (40 + 50) / 2 holds
    assert curriculum(*[50] * 6, 0, 0) == [12, 12, 8, 8, 4, 4, 0, 0, 0]  # then the agent drives alone


def test_an_episode_that_began_with_a_longer_guide_does_not_count():
    one = learner("jsrl", 1, guide_decisions=12, stages=3, window=2, envs_per_agent=3)
    one.note_episodes(np.array([[True, True, False]]), np.array([[50.0, 50.0, 0.0]]))
    assert one.guided.tolist() == [[12, 8, 12]]  # the first road's next episode began before the step
    one.note_episodes(np.array([[True, False, True]]), np.array([[-99.0, 0.0, -99.0]]))
    assert one.guided.tolist() == [[8, 8, 8]] and one.counted.tolist() == [0]


def test_the_teacher_drives_first_and_the_agent_from_then_on():
    one, states = learner("jsrl", 1, guide_decisions=3, envs_per_agent=4), torch.randn(1, 4, 26)
    taught, decided = torch.tensor([[1, 1, 5, 5]]), torch.tensor([[2.0, 3.0, 0.0, 9.0]])
    policy, own = one.acting_policy(states, taught, decided), one.probabilities(states)
    assert policy[0, 0].tolist() == [0, 1, 0, 0, 0, 0, 0, 0, 0] and policy[0, 2, 5] == 1
    assert torch.equal(policy[0, [1, 3]], own[0, [1, 3]])
    assert torch.equal(one.driving_policy(one.actor, one.critics, states, taught), own.detach())


# RLPD


def test_a_critic_s_hidden_layers_are_normalised_before_the_relu():
    weights = init_mlp((4, 5, 6, 3), [torch.Generator().manual_seed(0)])
    layers = []
    for weight, bias in zip(weights[::2], weights[1::2], strict=True):
        linear = torch.nn.Linear(*weight.shape[1:])
        linear.weight.data, linear.bias.data = weight[0].T.contiguous(), bias[0, 0]
        width = linear.out_features
        layers += [linear, torch.nn.LayerNorm(width, elementwise_affine=False), torch.nn.ReLU()]
    x = torch.randn(7, 4)
    expected = torch.nn.Sequential(*layers[:-2])(x)
    torch.testing.assert_close(normalised_mlp(weights, x[None])[0], expected)


def test_the_target_takes_the_smallest_value_of_each_agent_s_chosen_critics():
    q = torch.tensor([[[[1.0, 9.0]], [[4.0, 4.0]]], [[[2.0, 8.0]], [[3.0, 5.0]]], [[[0.0, 0.0]], [[9.0, 1.0]]]])
    assert smallest_of(q, torch.tensor([[0, 1], [1, 2]])).tolist() == [[[1.0, 8.0]], [[3.0, 1.0]]]


def test_each_update_draws_two_different_critics_of_the_five_for_each_agent():
    one, seen = learner("rlpd"), []
    for _ in range(30):
        drawn = one.drawn_critics()
        assert torch.equal(drawn, one.drawn_critics()) and (drawn[:, 0] != drawn[:, 1]).all()
        seen.append(drawn)
        one.updates_made += 1
    seen = torch.stack(seen)
    assert all(set(seen[:, i].flatten().tolist()) == {0, 1, 2, 3, 4} for i in range(2))
    assert not torch.equal(seen[:, 0], seen[:, 1])


def test_rlpd_s_target_and_losses_are_those_of_the_equations():
    one, batch = learner("rlpd", 1, alpha_init=0.3), a_batch(agents=1)
    first, second = one.drawn_critics()[0].tolist()
    with torch.no_grad():
        q, next_q = one.q_pair(one.critics, batch.states), one.q_pair(one.target_critics, batch.next_states)
        pi, next_pi = one.probabilities(batch.states)[0], one.probabilities(batch.next_states)[0]
        losses, y = one.losses(batch), one.critic_target(batch)[0]
    assert q.shape == (5, 1, 6, 9)
    for j in range(6):
        value = sum(
            next_pi[j, a] * (min(next_q[first, 0, j, a], next_q[second, 0, j, a]) - 0.3 * next_pi[j, a].log())
            for a in range(9)
        )
        expected = batch.rewards[0, j] + 0.97 * (1 - batch.terminated[0, j]) * value  # without a bonus or a KL
        assert float(y[j]) == pytest.approx(float(expected), abs=1e-5)
    squares = [(q[k, 0, j, batch.actions[0, j]] - y[j]) ** 2 for k in range(5) for j in range(6)]
    assert float(losses["critic_loss"]) == pytest.approx(float(sum(squares)) / 6, rel=1e-5)
    actor = [-(pi[j] * (q[:, 0, j].mean(0) - 0.3 * pi[j].log())).sum() for j in range(6)]
    assert float(losses["actor_loss"]) == pytest.approx(float(sum(actor)) / 6, abs=1e-5)


# IBRL


def test_ibrl_takes_its_own_action_where_it_is_worth_more_than_the_rule_s():
    pi, q = torch.tensor([[0.5, 0.2, 0.3]]), torch.tensor([[1.0, 3.0, 2.0]])
    torch.testing.assert_close(better_of_two(pi, q, torch.tensor([2])), torch.tensor([[0.0, 0.2, 0.8]]))


def test_the_target_values_the_choice_between_the_rule_s_next_action_and_one_s_own():
    one, batch = learner("ibrl"), a_batch()
    pi, q_pair = one.probabilities(batch.next_states), one.q_pair(one.target_critics, batch.next_states)
    target = one.critic_target(batch).detach()
    for i in range(2):
        for j in range(6):
            q, taught = q_pair[:, i, j].amin(0).tolist(), int(batch.next_rule_actions[i, j])
            value = sum(float(pi[i, j, a]) * max(q[a], q[taught]) for a in range(9))
            expected = batch.rewards[i, j] + 0.97 * (1 - batch.terminated[i, j]) * value
            assert float(target[i, j]) == pytest.approx(float(expected), abs=1e-5)


def test_an_agent_chooses_by_the_target_critics_as_it_did_in_training():
    one = learner("ibrl")
    for seed in range(5):
        one.update(a_batch(seed=seed))
    batch = a_batch(seed=9)
    acting = one.acting_policy(batch.states, batch.rule_actions, torch.zeros(2, 6))
    for i in range(2):
        driving = one.agent(i).probabilities(batch.states[i].numpy(), batch.rule_actions[i].numpy())
        torch.testing.assert_close(torch.from_numpy(driving), acting[i])
