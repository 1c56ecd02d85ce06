"""The risk of an action: how probable is an accident soon? And a policy that avoids risky actions. Pure functions.

A risk is learned from the agent's own accidents, as the safety critic of Srinivasan et al. (arXiv 2010.14603) and of
Thananjeyan et al. (arXiv 2010.15920) is, here within the next k decisions and without discount, so that it is a
probability.
"""

import torch
import torch.nn.functional as F
from torch import Tensor


def accident_within(accident: Tensor, ended: Tensor, decisions: int) -> Tensor:
    """1 where an accident ends the episode within the next k decisions, this one included, else 0.

    accident, ended, result: (horizon, ...) 0 or 1. The last k - 1 rows look beyond the horizon: see `risk_loss`.
    """
    until, found = torch.full_like(accident[0], torch.inf), []
    for now, end in zip(accident.flip(0), ended.flip(0), strict=True):
        until = torch.where(now > 0, 1.0, torch.where(end > 0, torch.inf, until + 1))
        found.append(until <= decisions)
    return torch.stack(found).flip(0).float()


def resolved(like: Tensor, decisions: int) -> Tensor:
    """1 for the rows whose next k decisions are all within the horizon, else 0: (horizon, ...).

    The other rows know accidents only, and would make them look more frequent than they are.
    """
    known = torch.zeros_like(like)
    known[: len(like) - decisions + 1] = 1
    return known


def risk_loss(logits: Tensor, label: Tensor, known: Tensor) -> Tensor:
    """The mean cross-entropy of the labels that are known: (..., batch) each -> (...)."""
    loss = F.binary_cross_entropy_with_logits(logits, label.expand_as(logits), reduction="none")
    return (loss * known).sum(-1) / known.sum(-1).clamp(min=1)


def masked(pi: Tensor, risk: Tensor, limit: Tensor) -> Tensor:
    """π among the actions whose risk is at most ε; where there is none, among the least risky ones: (..., actions).

    pi, risk (..., actions); limit broadcasts against them.
    """
    allowed = risk <= torch.maximum(limit, risk.amin(-1, keepdim=True))
    left = pi.clamp(min=torch.finfo(pi.dtype).tiny) * allowed  # what is left has a sum, too, where π is 0
    return left / left.sum(-1, keepdim=True)
