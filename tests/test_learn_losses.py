"""Every loss against numbers worked by hand. (test_learn_learner.py compares them with the textbook's.)"""

import math
from types import SimpleNamespace

import numpy as np
import pytest
import torch

from bootcourse.learn import bootstrap, sac

AGENTS, BATCH, ACTIONS = 2, 5, 9
P = torch.full((AGENTS,), 0.9)


@pytest.fixture
def drawn() -> SimpleNamespace:
    """Values, policies, the rule's actions and coefficients, drawn at random; agents differ in α."""
    rng = torch.Generator().manual_seed(0)
    q, logits = torch.randn(2, AGENTS, BATCH, ACTIONS, generator=rng)
    chosen, constraint = (
        torch.randint(ACTIONS, (AGENTS, BATCH), generator=rng),
        torch.rand(AGENTS, BATCH, generator=rng),
    )
    alpha = torch.tensor([[0.3], [2.0]])
    return SimpleNamespace(
        q=q, log_pi=logits.log_softmax(-1), chosen=chosen, constraint=constraint, alpha=alpha, rng=rng
    )


def close(ours, expected):
    torch.testing.assert_close(ours, torch.as_tensor(expected, dtype=ours.dtype), atol=1e-5, rtol=1e-5)


def sure(action: int) -> torch.Tensor:
    """log π, (1, 9), of a policy that is sure of an action."""
    return torch.full((1, ACTIONS), -200.0).index_fill(-1, torch.tensor([action]), 0.0)


UNIFORM = torch.full((1, ACTIONS), -math.log(9))
GOOD, ONE = torch.tensor([[0.0, 1.0, 2.0] + [0.0] * 6]), torch.eye(ACTIONS)[3:4]
T = torch.tensor
BY_HAND = {
    "the uniform policy": lambda: (sac.log_policy(torch.zeros(1, ACTIONS)), UNIFORM),
    "its entropy": lambda: (sac.entropy(UNIFORM), [math.log(9)]),
    "the entropy of a sure policy": lambda: (sac.entropy(sure(4)), [0.0]),
    "a target goes on after the time limit and ends with an accident": lambda: (
        sac.critic_target(T([1.0, -10.0]), T([0.0, 1.0]), T([10.0, 10.0]), 0.8), [9.0, -10.0]),
    "the squared error": lambda: (sac.critic_loss(T([[1.0, 2.0, 3.0]]), T([[0.0, 2.0, 5.0]])), [5 / 3]),
    "the smaller critic": lambda: (sac.min_q(T([[[1.0, 5.0]], [[2.0, 3.0]]])), [[1.0, 3.0]]),
    "the stochastic rule": lambda: (
        bootstrap.log_stochastic_rule(T([[4]]), P[:1]).exp()[0, 0], [0.0125] * 4 + [0.9] + [0.0125] * 4),
    "the price of another action, 4.382 nats": lambda: (
        bootstrap.kl_to_rule(sure(7), T([1]), T(0.9)), [math.log(8 / 0.1)]),
    "and 6.685 nats": lambda: (bootstrap.kl_to_rule(sure(7), T([1]), T(0.99)), [math.log(8 / 0.01)]),
    "to be surer than the rule costs little": lambda: (
        bootstrap.kl_to_rule(sure(0), T([0]), T(0.9)), [-math.log(0.9)]),
    "and much in the other direction": lambda: (
        bootstrap.kl_from_rule(sure(0), T([0]), T(0.9)), [0.9 * math.log(0.9) + 0.1 * (math.log(0.0125) + 200)]),
    "ξ is 200 α unless it is fixed, and has a least value": lambda: (
        bootstrap.constraint_strength(
            torch.full((5,), 0.01), torch.full((5,), 200.0), T([math.nan, 0.0, 0.7, math.nan, 0.0]),
            T([0.0, 0.0, 0.0, 3.0, 0.1])),
        [2.0, 0.0, 0.7, 3.0, 0.1]),
    "the bonus is the demonstrations'": lambda: (
        bootstrap.augmented_reward(T([0.1, -10.0, 0.1]), T([1.0, 1.0, 0.0]), 2.0), [2.1, -8.0, 0.1]),
    "an action that leads by the margin": lambda: (bootstrap.large_margin_loss(1.0 * ONE, T([3])), [0.0]),
    "an action that leads by less": lambda: (bootstrap.large_margin_loss(0.25 * ONE, T([3])), [0.75]),
    "a tie passes the paper's filter": lambda: (bootstrap.paper_q_filter(0 * ONE, T([5])), [1.0]),
    "the good and not the best does not": lambda: (bootstrap.paper_q_filter(GOOD, T([1])), [0.0]),
    "but passes the usual one": lambda: (bootstrap.q_filter(GOOD, T([1]), UNIFORM), [1.0]),
}  # fmt: skip


@pytest.mark.parametrize("name", BY_HAND)
def test_a_number_worked_by_hand(name):
    close(*BY_HAND[name]())


def test_the_log_policy_is_the_logarithm_of_softmax_however_large_the_logits(drawn):
    close(sac.log_policy(1000 * drawn.q), (1000 * drawn.q).log_softmax(-1))


def test_the_actor_loss_gives_the_critic_no_gradient_and_the_temperature_loss_the_policy_none(drawn):
    q, log_pi, state_entropy = (
        drawn.q.requires_grad_(),
        drawn.log_pi.requires_grad_(),
        torch.ones(1, 4).requires_grad_(),
    )
    sac.actor_loss(log_pi, q, torch.ones(AGENTS, 1)).sum().backward()
    sac.temperature_loss(torch.zeros(1, requires_grad=True), state_entropy, torch.zeros(1)).sum().backward()
    assert q.grad is state_entropy.grad is None and log_pi.grad.abs().sum() > 0


@pytest.mark.parametrize(("entropy", "moves"), [(0.1, 1), (2.0, -1)])
def test_alpha_rises_while_the_entropy_is_under_its_target_and_falls_while_above(entropy, moves):
    log_alpha = torch.tensor([-1.0], requires_grad=True)
    loss = sac.temperature_loss(log_alpha, torch.full((1, 4), entropy), torch.tensor([1.0]))
    close(loss.detach(), [math.exp(-1) * (entropy - 1)])
    loss.sum().backward()
    assert np.sign(-log_alpha.grad.item()) == moves


@pytest.mark.parametrize("kl", [bootstrap.kl_to_rule, bootstrap.kl_from_rule])
def test_the_kl_is_zero_exactly_where_the_policy_is_the_stochastic_rule(kl, drawn):
    assert (kl(bootstrap.log_stochastic_rule(drawn.chosen, P), drawn.chosen, P) == 0).all()
    assert (kl(drawn.log_pi, drawn.chosen, P) > 0.01).all()


def test_nothing_scores_higher_than_the_regularised_policy(drawn):
    alpha, xi = 0.3, 2.0
    log_rule = bootstrap.log_stochastic_rule(drawn.chosen, P)

    def objective(log_policy):
        kl = (log_policy.exp() * (log_policy - log_rule)).sum(-1)
        return (log_policy.exp() * drawn.q).sum(-1) + alpha * sac.entropy(log_policy) - xi * kl

    best = bootstrap.regularised_policy(drawn.q, log_rule, alpha, xi).log()
    for size in (1e-2, 0.1, 1.0, 10.0):
        others = (best + size * torch.randn(200, AGENTS, BATCH, ACTIONS, generator=drawn.rng)).log_softmax(-1)
        assert (objective(others) <= objective(best) + 1e-5).all()


@pytest.mark.parametrize(("episode", "beta"), [(0, 0.6), (500, 0.3), (1000, 0.0), (2000, 0.0)])
def test_beta_falls_from_0_6_to_0_in_1000_episodes(episode, beta):
    assert bootstrap.demonstration_share(episode, 0.6, 1000) == pytest.approx(beta)
    assert bootstrap.demonstration_share(np.array([episode]), np.array([0.6]), np.array([1000])) == pytest.approx(beta)
    assert bootstrap.demonstration_share(episode, 0.6, None) == 0.6  # it stays
