"""Answers to the exercises of the lesson on imitation."""

import math
import statistics

import numpy as np
import torch
from torch.nn import functional

from tests.answers import equivalent, right, wrong

# discriminator_loss -----------------------------------------------------------------------------------


for _name in ("-expert_logits", "own_logits"):
    _change = f"F.softplus({_name}).mean(-1)  ->  F.softplus({_name}).mean(0)"
    equivalent("discriminator_loss", _change, "the batch is the only axis")


@right("discriminator_loss")
def as_two_classes(rule_logits, own_logits):
    ones, zeros = torch.ones_like(rule_logits), torch.zeros_like(own_logits)
    of_the_rule = functional.binary_cross_entropy_with_logits(rule_logits, ones)
    return of_the_rule + functional.binary_cross_entropy_with_logits(own_logits, zeros)


@right("discriminator_loss")
def by_logsigmoid(rule_logits, own_logits):
    return -functional.logsigmoid(rule_logits).mean() - functional.logsigmoid(-own_logits).mean()


@wrong("discriminator_loss")
def of_all_logits_together(rule_logits, own_logits):
    return functional.softplus(torch.cat([-rule_logits, own_logits])).mean()


@wrong("discriminator_loss", "take each for the other")
def loop_with_the_wrong_sign(rule_logits, own_logits):
    right = sum(functional.logsigmoid(x) for x in rule_logits) / len(rule_logits)
    return right + sum(functional.logsigmoid(-x) for x in own_logits) / len(own_logits)


@wrong("discriminator_loss")
def half_of_it(rule_logits, own_logits):
    return (functional.softplus(-rule_logits).mean() + functional.softplus(own_logits).mean()) / 2


@wrong("discriminator_loss")
def with_the_same_sign(rule_logits, own_logits):
    return functional.softplus(rule_logits).mean() + functional.softplus(own_logits).mean()


@wrong("discriminator_loss")
def safe_by_clamping(rule_logits, own_logits):
    d = torch.sigmoid(rule_logits), torch.sigmoid(own_logits)
    return -d[0].clamp(min=1e-6).log().mean() - (1 - d[1]).clamp(min=1e-6).log().mean()


# imitation_reward -------------------------------------------------------------------------------------


@right("imitation_reward")
def log_of_a_sum(own_logits):
    return torch.logaddexp(own_logits, torch.zeros_like(own_logits))


@right("imitation_reward")
def by_symmetry(own_logits):
    return -functional.logsigmoid(-own_logits)


@wrong("imitation_reward")
def clipped(own_logits):
    return -torch.log((1 - torch.sigmoid(own_logits)).clamp(min=1e-6))


@wrong("imitation_reward")
def cut_at_zero(own_logits):
    return torch.relu(own_logits)


# deviation_of_a_rate ----------------------------------------------------------------------------------


equivalent("deviation_of_a_rate", "[100.0, 0.0]  ->  [-100.0, 0.0]", "-100 lies as far from 0 as 100 does")


@right("deviation_of_a_rate")
def by_formula(k, n):
    p = k / n
    return 100 * math.sqrt(p * (1 - p) * n / (n - 1))


@right("deviation_of_a_rate")
def of_a_list(k, n):
    return statistics.stdev([100.0] * k + [0.0] * (n - k))


@wrong("deviation_of_a_rate")
def half_of_an_interval(k, n):
    return 1.96 * 100 * math.sqrt(k / n * (1 - k / n) / n)


# episodes_needed --------------------------------------------------------------------------------------


NEEDED = "np.ceil(np.log(0.05) / np.log(1 - rate))"
equivalent("episodes_needed", f"return int({NEEDED})  ->  return {NEEDED}", "the same whole number, as a float")


@right("episodes_needed")
def by_trying(rate):
    n = 1
    while (1 - rate) ** n > 0.05:
        n += 1
    return n


@right("episodes_needed")
def with_another_base(rate):
    return int(np.ceil(np.log10(0.05) / np.log10(1 - rate)))


@wrong("episodes_needed", "one of 95 %")
def of_the_other_share(rate):
    n = 1
    while (1 - rate) ** n > 0.95:
        n += 1
    return n


@wrong("episodes_needed")
def both_sides(rate):
    return math.ceil(math.log(0.025) / math.log(1 - rate))


@wrong("episodes_needed")
def added_up(rate):
    return math.ceil(0.95 / rate)
