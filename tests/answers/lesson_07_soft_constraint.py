"""Answers to the exercises of the lesson on the soft constraint."""

import math

import torch

from bootcourse.learn.bootstrap import kl_to_rule
from tests.answers import right, wrong


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
