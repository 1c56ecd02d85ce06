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


@right("discriminator_loss")
def by_logaddexp(rule_logits, own_logits):
    terms = (torch.logaddexp(x, torch.zeros_like(x)).mean() for x in (-rule_logits, own_logits))
    return sum(terms)


@wrong("discriminator_loss", "no gradient")
def as_a_number(rule_logits, own_logits):
    return float(by_logsigmoid(rule_logits, own_logits))


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


@right("imitation_reward")
def large_and_small_apart(own_logits):
    return own_logits.clamp(min=0) + torch.log1p(torch.exp(-own_logits.abs()))


@wrong("imitation_reward", "training needs one")
def with_numpy(own_logits):
    return np.logaddexp(0, own_logits.numpy())


@wrong("imitation_reward", "shape")
def one_for_the_batch(own_logits):
    return functional.softplus(own_logits).mean()


@wrong("imitation_reward")
def in_bits(own_logits):
    return functional.softplus(own_logits) / math.log(2)


@wrong("imitation_reward")
def shifted_to_zero_where_it_cannot_tell(own_logits):
    return functional.softplus(own_logits) - math.log(2)


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


@right("deviation_of_a_rate")
def by_the_sum_of_squares(k, n):
    mean = 100 * k / n
    return np.sqrt((k * (100 - mean) ** 2 + (n - k) * mean**2) / (n - 1))


@wrong("deviation_of_a_rate")
def right_for_one_of_n(k, n):
    return 100 / math.sqrt(n)


@wrong("deviation_of_a_rate")
def of_twenty(k, n):
    return by_formula(k, 20) if k <= 20 else 0.0


@wrong("deviation_of_a_rate")
def mean_distance_from_the_mean(k, n):
    return np.abs(np.repeat([100.0, 0.0], [k, n - k]) - 100 * k / n).mean()


@wrong("deviation_of_a_rate", "raises an error")
def of_k_numbers(k, n):
    return statistics.stdev([100.0] * k)


@wrong("deviation_of_a_rate", "2 values")
def with_the_mean(k, n):
    return 100 * k / n, by_formula(k, n)


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


@right("episodes_needed")
def by_halving(rate):
    low, high = 0, 1_000_000  # too few, enough
    while high - low > 1:
        middle = (low + high) // 2
        low, high = (low, middle) if (1 - rate) ** middle <= 0.05 else (middle, high)
    return high


@wrong("episodes_needed")
def to_the_nearest(rate):
    return round(math.log(0.05) / math.log(1 - rate))


@wrong("episodes_needed")
def one_more(rate):
    return by_trying(rate) + 1


@wrong("episodes_needed")
def for_99_percent(rate):
    return math.ceil(math.log(0.01) / math.log(1 - rate))


@wrong("episodes_needed", "returns")
def as_an_array(rate):
    return np.array([by_trying(rate)])
