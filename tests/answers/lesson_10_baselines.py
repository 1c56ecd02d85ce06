"""Answers to the exercises of the lesson on the baselines."""

import math
import statistics

import numpy as np
import torch
from torch.nn import functional

from tests.answers import right, wrong

# conservative_loss ------------------------------------------------------------------------------------


@right("conservative_loss")
def as_a_clone_of_softmax(q, actions):
    return functional.cross_entropy(q, actions)


@right("conservative_loss")
def state_by_state(q, actions):
    total = 0.0
    for row, action in zip(q, actions, strict=True):
        total = total + torch.log(torch.exp(row).sum()) - row[action]
    return total / len(q)


@wrong("conservative_loss")
def only_the_others(q, actions):
    others = q.masked_fill(functional.one_hot(actions, q.shape[-1]).bool(), -torch.inf)
    return (others.logsumexp(-1) - q.gather(-1, actions.unsqueeze(-1)).squeeze(-1)).mean()


@wrong("conservative_loss")
def summed(q, actions):
    return functional.cross_entropy(q, actions, reduction="sum")


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


# share_of_the_bound -----------------------------------------------------------------------------------


@right("share_of_the_bound")
def of_sums(returns, bound):
    return returns.sum(axis=1) / bound.sum()


@right("share_of_the_bound")
def weighted(returns, bound):
    return np.average(returns / bound, axis=1, weights=bound)


@wrong("share_of_the_bound", "share of its own")
def of_all_agents(returns, bound):
    return np.mean([row.mean() for row in returns]) / bound.mean()


@wrong("share_of_the_bound")
def upside_down(returns, bound):
    return bound.mean() / returns.mean(axis=1)


@wrong("share_of_the_bound")
def by_road(returns, bound):
    return returns.mean(axis=0) / bound
