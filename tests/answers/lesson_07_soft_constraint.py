"""Answers to the exercises of the lesson on the soft constraint."""

import math

import torch

from bootcourse.learn.bootstrap import kl_to_rule
from tests.answers import equivalent, right, wrong

SAME = "its slope in log π is the same for all actions, so no logit feels it"
equivalent("soft_constraint", "log_pi - log_rule  ->  log_pi.detach() - log_rule", SAME)
FULL = "math.log((1 - p) / 8))"
equivalent(
    "soft_constraint", f"torch.full_like(log_pi, {FULL}  ->  torch.full_like(log_pi.detach(), {FULL}", "only its shape"
)
equivalent("constrained_loss", "alpha * log_pi  ->  alpha * log_pi.detach()", SAME)


def pi_tilde(rule_action, p, others=None):
    """(batch, 9)"""
    probabilities = torch.full((len(rule_action), 9), (1 - p) / 8 if others is None else others).double()
    probabilities[torch.arange(len(rule_action)), rule_action] = p
    return probabilities


@right("soft_constraint")
def the_library_s(log_pi, rule_action, p):
    return kl_to_rule(log_pi, rule_action, torch.tensor(p))


@right("soft_constraint")
def with_probabilities(log_pi, rule_action, p):
    pi = log_pi.exp()
    return (pi * torch.log(pi / pi_tilde(rule_action, p))).sum(dim=1)


@right("soft_constraint")
def torch_s_own(log_pi, rule_action, p):
    rule = pi_tilde(rule_action, p).log()
    return torch.nn.functional.kl_div(rule, log_pi, reduction="none", log_target=True).sum(-1)


@right("soft_constraint")
def minus_entropy_minus_cross(log_pi, rule_action, p):
    pi = log_pi.exp()
    of_rule = pi.gather(1, rule_action[:, None])[:, 0]
    cross = of_rule * math.log(p) + (1 - of_rule) * math.log((1 - p) / 8)
    return (pi * log_pi).sum(-1) - cross


@wrong("soft_constraint", "no gradient")
def a_measurement(log_pi, rule_action, p):
    with torch.no_grad():
        return with_probabilities(log_pi, rule_action, p)


@wrong("soft_constraint", "the other way round")
def reverse(log_pi, rule_action, p):
    rule = pi_tilde(rule_action, p)
    return (rule * (rule.log() - log_pi)).sum(-1)


@wrong("soft_constraint", "the other way round")
def torch_s_own_turned(log_pi, rule_action, p):
    rule = pi_tilde(rule_action, p)
    return torch.nn.functional.kl_div(log_pi, rule, reduction="none").sum(-1)


@wrong("soft_constraint", "cross-entropy")
def cross_entropy(log_pi, rule_action, p):
    return -(log_pi.exp() * pi_tilde(rule_action, p).log()).sum(-1)


@wrong("soft_constraint", "without weighing")
def unweighted(log_pi, rule_action, p):
    return (log_pi - pi_tilde(rule_action, p).log()).sum(-1)


@wrong("soft_constraint", "*share*")
def others_get_it_each(log_pi, rule_action, p):
    return (log_pi.exp() * (log_pi - pi_tilde(rule_action, p, 1 - p).log())).sum(-1)


@wrong("soft_constraint", "eight are left")
def shared_by_nine(log_pi, rule_action, p):
    return (log_pi.exp() * (log_pi - pi_tilde(rule_action, p, (1 - p) / 9).log())).sum(-1)


@wrong("soft_constraint", "never negative")
def negative(log_pi, rule_action, p):
    return (log_pi.exp() * (pi_tilde(rule_action, p).log() - log_pi)).sum(-1)


@wrong("soft_constraint", "bits")
def in_bits(log_pi, rule_action, p):
    pi = log_pi.exp()
    return (pi * torch.log2(pi / pi_tilde(rule_action, p))).sum(-1)


@wrong("soft_constraint", "mean over the batch")
def averaged(log_pi, rule_action, p):
    return with_probabilities(log_pi, rule_action, p).mean()


@wrong("soft_constraint")
def mean_over_actions(log_pi, rule_action, p):
    return (log_pi.exp() * (log_pi - pi_tilde(rule_action, p).log())).mean(-1)


@wrong("soft_constraint", "shape")
def not_summed(log_pi, rule_action, p):
    return log_pi.exp() * (log_pi - pi_tilde(rule_action, p).log())


@wrong("soft_constraint", "shape")
def over_the_wrong_axis(log_pi, rule_action, p):
    return (log_pi.exp() * (log_pi - pi_tilde(rule_action, p).log())).sum(0)


@wrong("soft_constraint")
def of_the_rule_s_action_only(log_pi, rule_action, p):
    return log_pi.gather(1, rule_action[:, None])[:, 0] - math.log(p)


@wrong("soft_constraint")
def log_pi_for_pi(log_pi, rule_action, p):
    return (log_pi * (log_pi - pi_tilde(rule_action, p).log())).sum(-1)


@wrong("soft_constraint")
def a_sample_for_the_sum(log_pi, rule_action, p):
    drawn = torch.multinomial(log_pi.exp(), 1)
    return (log_pi - pi_tilde(rule_action, p).log()).gather(1, drawn)[:, 0]


@wrong("soft_constraint")
def the_same_rule_for_all(log_pi, rule_action, p):
    return with_probabilities(log_pi, rule_action[:1].expand(len(rule_action)), p)


# log_stochastic_rule --------------------------------------------------------------------------------


@right("log_stochastic_rule")
def with_where(rule_action, p):
    is_rule = torch.arange(9) == rule_action[:, None]
    return torch.where(is_rule, math.log(p), math.log((1 - p) / 8))


@right("log_stochastic_rule")
def one_hot(rule_action, p):
    mine = torch.nn.functional.one_hot(rule_action, 9).double()
    return torch.log(mine * p + (1 - mine) * (1 - p) / 8)


@right("log_stochastic_rule")
def row_by_row(rule_action, p):
    rows = []
    for action in rule_action.tolist():
        rows.append([math.log(p) if a == action else math.log((1 - p) / 8) for a in range(9)])
    return torch.tensor(rows)


@wrong("log_stochastic_rule", "probabilities themselves")
def not_logarithms(rule_action, p):
    return pi_tilde(rule_action, p)


@wrong("log_stochastic_rule", "*share*")
def each_gets_the_rest(rule_action, p):
    return pi_tilde(rule_action, p, 1 - p).log()


@wrong("log_stochastic_rule", "eight are left")
def nine_get_the_rest(rule_action, p):
    return pi_tilde(rule_action, p, (1 - p) / 9).log()


@wrong("log_stochastic_rule", "base 10")
def to_base_ten(rule_action, p):
    return torch.log10(pi_tilde(rule_action, p))


@wrong("log_stochastic_rule", "prices")
def prices(rule_action, p):
    return -pi_tilde(rule_action, p).log()


@wrong("log_stochastic_rule", "Pair each row")
def columns_for_rows(rule_action, p):
    log_rule = torch.full((len(rule_action), 9), math.log((1 - p) / 8))
    log_rule[:, rule_action] = math.log(p)
    return log_rule


@wrong("log_stochastic_rule", "shape")
def transposed(rule_action, p):
    return with_where(rule_action, p).T


# regularised_policy ---------------------------------------------------------------------------------


@right("regularised_policy")
def as_powers(q, log_rule, alpha, xi):
    weights = torch.exp((q - q.amax(-1, keepdim=True)) / (alpha + xi)) * log_rule.exp() ** (xi / (alpha + xi))
    return weights / weights.sum(-1, keepdim=True)


@right("regularised_policy")
def with_softmax(q, log_rule, alpha, xi):
    return torch.softmax(q / (alpha + xi) + log_rule * xi / (alpha + xi), dim=1)


@wrong("regularised_policy")
def without_the_rule(q, log_rule, alpha, xi):
    return torch.softmax(q / alpha, -1)


@wrong("regularised_policy")
def a_mixture(q, log_rule, alpha, xi):
    return (alpha * torch.softmax(q / alpha, -1) + xi * log_rule.exp()) / (alpha + xi)


# constrained_loss -----------------------------------------------------------------------------------


@right("constrained_loss")
def three_means(log_pi, q, alpha, xi, kl):
    pi = log_pi.exp()
    expected = (pi * q.detach()).sum(-1).mean()
    entropy = -(pi * log_pi).sum(-1).mean()
    return -(expected + alpha * entropy - xi * kl.mean())


@right("constrained_loss")
def as_a_cost(log_pi, q, alpha, xi, kl):
    cost = (torch.exp(log_pi) * (alpha * log_pi - q.clone().detach())).sum(dim=1)
    return torch.mean(cost + xi * kl)


@right("constrained_loss")
def softmax_again(log_pi, q, alpha, xi, kl):
    pi = log_pi.softmax(-1)
    return -((pi * (q.detach() - alpha * log_pi.log_softmax(-1))).sum(-1) - xi * kl).mean()


@wrong("constrained_loss")
def all_detached(log_pi, q, alpha, xi, kl):
    return three_means(log_pi, q, alpha, xi, kl).detach()


@wrong("constrained_loss")
def policy_detached(log_pi, q, alpha, xi, kl):
    return three_means(log_pi.detach(), q, alpha, xi, kl)


@wrong("constrained_loss", "shape")
def one_for_each_state(log_pi, q, alpha, xi, kl):
    return -((log_pi.exp() * (q.detach() - alpha * log_pi)).sum(-1) - xi * kl)


# constrained_target ---------------------------------------------------------------------------------


@right("constrained_target")
def with_the_smaller_of_two(reward, terminated, next_log_pi, next_q_pair, next_kl, alpha, xi, gamma):
    pi, q = next_log_pi.exp(), torch.minimum(next_q_pair[0], next_q_pair[1])
    entropy = torch.special.entr(pi).sum(-1)
    value = (pi * q).sum(-1) + alpha * entropy - xi * next_kl
    return torch.where(terminated > 0, reward, reward + gamma * value)


@right("constrained_target")
def one_row_after_the_other(reward, terminated, next_log_pi, next_q_pair, next_kl, alpha, xi, gamma):
    rows = []
    for i in range(len(reward)):
        q, log_pi = next_q_pair[:, i].min(dim=0).values, next_log_pi[i]
        value = sum(log_pi[a].exp() * (q[a] - alpha * log_pi[a]) for a in range(len(q))) - xi * next_kl[i]
        rows.append(reward[i] + (0 if terminated[i] else gamma * value))
    return torch.stack(rows)


@wrong("constrained_target")
def value_first_and_then_the_minimum(reward, terminated, next_log_pi, next_q_pair, next_kl, alpha, xi, gamma):
    values = (next_log_pi.exp() * (next_q_pair - alpha * next_log_pi)).sum(-1)  # two values: their smaller one
    return reward + gamma * (1 - terminated) * (values.min(0).values - xi * next_kl)


@wrong("constrained_target")
def masked_reward(reward, terminated, next_log_pi, next_q_pair, next_kl, alpha, xi, gamma):
    value = (next_log_pi.exp() * (next_q_pair.amin(0) - alpha * next_log_pi)).sum(-1) - xi * next_kl
    return (1 - terminated) * (reward + gamma * value)


@wrong("constrained_target")
def discount_of_the_course(reward, terminated, next_log_pi, next_q_pair, next_kl, alpha, xi, gamma):
    value = (next_log_pi.exp() * (next_q_pair.amin(0) - alpha * next_log_pi)).sum(-1) - xi * next_kl
    return reward + 0.8 * (1 - terminated) * value


@wrong("constrained_target", "differ")
def xi_of_the_course(reward, terminated, next_log_pi, next_q_pair, next_kl, alpha, xi, gamma):
    value = (next_log_pi.exp() * (next_q_pair.amin(0) - alpha * next_log_pi)).sum(-1) - 200 * alpha * next_kl
    return reward + gamma * (1 - terminated) * value


@wrong("constrained_target", "outside the value")
def a_penalty_on_the_reward(reward, terminated, next_log_pi, next_q_pair, next_kl, alpha, xi, gamma):
    value = (next_log_pi.exp() * (next_q_pair.amin(0) - alpha * next_log_pi)).sum(-1)
    return reward - xi * next_kl + gamma * (1 - terminated) * value


@right("constrained_target")
def action_by_action(reward, terminated, next_log_pi, next_q_pair, next_kl, alpha, xi, gamma):
    value = -xi * next_kl
    for a in range(9):
        q = torch.minimum(next_q_pair[0, :, a], next_q_pair[1, :, a])
        value = value + next_log_pi[:, a].exp() * (q - alpha * next_log_pi[:, a])
    return reward + gamma * (1 - terminated) * value
