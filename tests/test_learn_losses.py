"""Every loss against loops that spell it out, on cases small enough to check by hand."""

import math

import numpy as np
import pytest
import torch

from bootcourse.learn import bootstrap, sac

P = torch.tensor(0.9)
AGENTS, BATCH, ACTIONS = 2, 5, 9


@pytest.fixture
def rng():
    return torch.Generator().manual_seed(0)


@pytest.fixture
def q(rng):
    return torch.randn(AGENTS, BATCH, ACTIONS, generator=rng)


@pytest.fixture
def log_pi(rng):
    return torch.randn(AGENTS, BATCH, ACTIONS, generator=rng).log_softmax(-1)


@pytest.fixture
def chosen(rng):
    return torch.randint(ACTIONS, (AGENTS, BATCH), generator=rng)


def every_state():
    return [(i, j) for i in range(AGENTS) for j in range(BATCH)]


def close(ours, spelled_out):
    torch.testing.assert_close(ours, torch.as_tensor(spelled_out, dtype=ours.dtype), atol=1e-5, rtol=1e-5)


def test_the_log_policy_is_the_logarithm_of_softmax_however_large_the_logits(rng):
    logits = 1000 * torch.randn(7, ACTIONS, generator=rng)
    close(sac.log_policy(logits), logits.log_softmax(-1))
    close(sac.log_policy(torch.zeros(3, ACTIONS)), torch.full((3, ACTIONS), -math.log(9)))


def test_the_soft_value_is_expected_q_plus_alpha_times_entropy_less_the_constraint(q, log_pi):
    alpha, constraint = torch.tensor([[0.3], [2.0]]), torch.rand(AGENTS, BATCH)
    expected = torch.zeros(AGENTS, BATCH)
    for i, j in every_state():
        pi = [math.exp(x) for x in log_pi[i, j]]
        entropy = -sum(x * math.log(x) for x in pi)
        mean_q = sum(x * float(value) for x, value in zip(pi, q[i, j], strict=True))
        expected[i, j] = mean_q + float(alpha[i]) * entropy - constraint[i, j]
    close(sac.soft_value(log_pi, q, alpha, constraint), expected)


def test_entropy_is_log_nine_for_the_uniform_policy_and_zero_for_a_certain_one():
    close(sac.entropy(torch.full((1, 9), -math.log(9))), [math.log(9)])
    certain = torch.full((1, 9), -200.0)
    certain[0, 4] = 0.0
    close(sac.entropy(certain), [0.0])


def test_what_ran_out_of_time_goes_on_in_the_target_and_what_terminated_does_not():
    terminated, next_value = torch.tensor([[0.0, 1.0]]), torch.tensor([[10.0, 10.0]])
    target = sac.critic_target(torch.tensor([[1.0, -10.0]]), terminated, next_value, torch.tensor([[0.8]]))
    close(target, [[9.0, -10.0]])


def test_the_critic_loss_is_the_mean_squared_error():
    close(sac.critic_loss(torch.tensor([[1.0, 2.0, 3.0]]), torch.tensor([[0.0, 2.0, 5.0]])), [5 / 3])


def test_the_actor_loss_gives_the_critic_no_gradient(q, log_pi):
    q, log_pi = q.requires_grad_(), log_pi.requires_grad_()
    sac.actor_loss(log_pi, q, torch.ones(AGENTS, 1)).sum().backward()
    assert q.grad is None and log_pi.grad.abs().sum() > 0


@pytest.mark.parametrize(("entropy", "moves"), [(0.1, 1), (2.0, -1)])
def test_alpha_rises_while_the_entropy_is_under_its_target_and_falls_while_above(entropy, moves):
    log_alpha = torch.tensor([-1.0], requires_grad=True)
    loss = sac.temperature_loss(log_alpha, torch.full((1, 4), entropy), torch.tensor([1.0]))
    close(loss.detach(), [math.exp(-1) * (entropy - 1)])
    loss.sum().backward()
    assert np.sign(-log_alpha.grad.item()) == moves


def test_the_temperature_loss_gives_the_policy_no_gradient():
    entropy = torch.ones(1, 4, requires_grad=True)
    loss = sac.temperature_loss(torch.zeros(1, requires_grad=True), entropy, torch.zeros(1))
    loss.sum().backward()
    assert entropy.grad is None


def test_the_smaller_critic_is_taken_for_each_action():
    close(sac.min_q(torch.tensor([[[1.0, 5.0]], [[2.0, 3.0]]])), [[1.0, 3.0]])


def test_the_stochastic_rule_gives_p_to_the_rules_action_and_shares_the_rest():
    rule = bootstrap.log_stochastic_rule(torch.tensor([[4]]), torch.tensor([0.9])).exp()
    close(rule[0, 0], [0.0125] * 4 + [0.9] + [0.0125] * 4)


def test_the_kl_is_what_its_sum_says(log_pi, chosen):
    expected = torch.zeros(AGENTS, BATCH)
    for i, j in every_state():
        for a in range(ACTIONS):
            rule = 0.9 if a == chosen[i, j] else 0.1 / 8
            expected[i, j] += math.exp(log_pi[i, j, a]) * (float(log_pi[i, j, a]) - math.log(rule))
    close(bootstrap.kl_to_rule(log_pi, chosen, torch.full((AGENTS,), 0.9)), expected)


@pytest.mark.parametrize("kl", [bootstrap.kl_to_rule, bootstrap.kl_from_rule])
def test_the_kl_is_zero_exactly_where_the_policy_is_the_stochastic_rule(kl, chosen, log_pi):
    p = torch.full((AGENTS,), 0.9)
    same = bootstrap.log_stochastic_rule(chosen, p)
    assert (kl(same, chosen, p) == 0).all()
    assert (kl(log_pi, chosen, p) > 0.01).all()


@pytest.mark.parametrize(("p", "pull"), [(0.9, 4.382), (0.99, 6.685)])
def test_a_policy_that_is_sure_of_another_action_pays_log_of_eight_over_one_minus_p(p, pull):
    sure = torch.full((1, 9), -200.0)
    sure[0, 7] = 0.0
    kl = bootstrap.kl_to_rule(sure, torch.tensor([1]), torch.tensor(p))
    close(kl, [math.log(8 / (1 - p))])
    assert kl.item() == pytest.approx(pull, abs=1e-3)


def test_it_costs_little_to_be_surer_than_the_rule_though_the_other_direction_would_charge_much():
    sure = torch.full((1, 9), -50.0)
    sure[0, 0] = 0.0
    rule = bootstrap.log_stochastic_rule(torch.tensor([0]), P)
    reversed_kl = (rule.exp() * (rule - sure)).sum(-1)
    close(bootstrap.kl_to_rule(sure, torch.tensor([0]), P), [-math.log(0.9)])
    assert reversed_kl.item() > 4.0


def test_nothing_scores_higher_than_the_regularised_policy(q, chosen, rng):
    alpha, xi = 0.3, 2.0
    log_rule = bootstrap.log_stochastic_rule(chosen, torch.full((AGENTS,), 0.9))

    def objective(log_policy):
        kl = (log_policy.exp() * (log_policy - log_rule)).sum(-1)
        return (log_policy.exp() * q).sum(-1) + alpha * sac.entropy(log_policy) - xi * kl

    best = bootstrap.regularised_policy(q, log_rule, alpha, xi).log()
    for size in (1e-2, 0.1, 1.0, 10.0):
        others = (best + size * torch.randn(200, AGENTS, BATCH, ACTIONS, generator=rng)).log_softmax(-1)
        assert (objective(others) <= objective(best) + 1e-5).all()
    kl = bootstrap.kl_to_rule(best, chosen, torch.full((AGENTS,), 0.9))
    close(objective(best), sac.soft_value(best, q, torch.full((AGENTS, 1), alpha), xi * kl))


def test_xi_is_200_alpha_unless_it_is_fixed():
    alpha = torch.tensor([0.01, 0.01, 0.01])
    xi = bootstrap.constraint_strength(alpha, torch.full((3,), 200.0), torch.tensor([math.nan, 0.0, 0.7]))
    close(xi, [2.0, 0.0, 0.7])  # 2: w_kl of the paper's table


@pytest.mark.parametrize(("episode", "beta"), [(0, 0.6), (500, 0.3), (1000, 0.0), (2000, 0.0)])
def test_beta_falls_from_0_6_to_0_in_1000_episodes(episode, beta):
    assert bootstrap.demonstration_share(episode, 0.6, 1000) == pytest.approx(beta)
    assert bootstrap.demonstration_share(np.array([episode]), np.array([0.6]), np.array([1000])) == pytest.approx(beta)
    assert bootstrap.demonstration_share(episode, 0.6, None) == 0.6  # it stays


def test_the_bonus_goes_to_demonstrations_only():
    reward, is_demonstration = torch.tensor([[0.1, -10.0, 0.1]]), torch.tensor([[1.0, 1.0, 0.0]])
    close(bootstrap.augmented_reward(reward, is_demonstration, torch.tensor([[2.0]])), [[2.1, -8.0, 0.1]])


def test_the_large_margin_loss_is_what_its_maximum_says(q, chosen):
    expected = torch.zeros(AGENTS, BATCH)
    for i, j in every_state():
        expert = int(chosen[i, j])
        best = max(float(q[i, j, a]) + (0.0 if a == expert else 1.0) for a in range(ACTIONS))
        expected[i, j] = best - float(q[i, j, expert])
    close(bootstrap.large_margin_loss(q, chosen), expected)


def test_the_large_margin_loss_is_zero_once_the_demonstrators_action_leads_by_the_margin():
    q = torch.zeros(1, 9)
    q[0, 3] = 1.0
    assert bootstrap.large_margin_loss(q, torch.tensor([3])).item() == 0.0
    q[0, 3] = 0.25
    assert bootstrap.large_margin_loss(q, torch.tensor([3])).item() == 0.75


def test_the_papers_filter_is_on_only_where_the_demonstrators_action_is_greedy_already(q, chosen):
    keep = bootstrap.paper_q_filter(q, chosen)
    for i, j in every_state():
        assert keep[i, j] == float(q[i, j].argmax() == chosen[i, j])
    assert bootstrap.paper_q_filter(q, q.argmax(-1)).all()
    assert bootstrap.paper_q_filter(torch.zeros(1, 9), torch.tensor([5])).item() == 1.0  # a tie is on


def test_the_usual_filter_is_on_where_the_demonstrators_action_beats_the_policy(q, chosen, log_pi):
    keep = bootstrap.q_filter(q, chosen, log_pi)
    for i, j in every_state():
        mean = sum(math.exp(log_pi[i, j, a]) * float(q[i, j, a]) for a in range(ACTIONS))
        assert keep[i, j] == float(float(q[i, j, chosen[i, j]]) > mean)
    assert 0 < keep.mean() < 1


def test_the_two_filters_differ_where_the_demonstrators_action_is_good_but_not_the_best():
    q = torch.tensor([[0.0, 1.0, 2.0] + [0.0] * 6])
    uniform = torch.full((1, 9), -math.log(9))
    assert bootstrap.paper_q_filter(q, torch.tensor([1])).item() == 0.0
    assert bootstrap.q_filter(q, torch.tensor([1]), uniform).item() == 1.0
