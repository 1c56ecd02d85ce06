"""Answers to the exercises of the lesson on offline learning."""

import numpy as np
import torch
from torch.nn import functional

from tests.answers import equivalent, right, wrong

# conservative_loss ------------------------------------------------------------------------------------


TERMS = "(q.logsumexp(-1) - q.gather(-1, actions.unsqueeze(-1)).squeeze(-1))"
equivalent("conservative_loss", f"{TERMS}.mean(-1)  ->  {TERMS}.mean(0)", "the batch is the only axis left")


@right("conservative_loss")
def as_a_clone_of_softmax(q, actions):
    return functional.cross_entropy(q, actions)


@right("conservative_loss")
def state_by_state(q, actions):
    total = 0.0
    for row, action in zip(q, actions, strict=True):
        total = total + torch.log(torch.exp(row).sum()) - row[action]
    return total / len(q)


@wrong("conservative_loss", "no gradient reaches `q`")
def as_a_number(q, actions):
    return functional.cross_entropy(q, actions).item()


@wrong("conservative_loss")
def only_the_others(q, actions):
    others = q.masked_fill(functional.one_hot(actions, q.shape[-1]).bool(), -torch.inf)
    return (others.logsumexp(-1) - q.gather(-1, actions.unsqueeze(-1)).squeeze(-1)).mean()


@wrong("conservative_loss")
def summed(q, actions):
    return functional.cross_entropy(q, actions, reduction="sum")


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
