"""Numbers that the lesson on the soft constraint shows before its exercises compute them, and how its agents ended."""

from collections.abc import Mapping, Sequence

import numpy as np
import torch
from torch import Tensor

from bootcourse.learn.bootstrap import kl_to_rule
from bootcourse.research.results import Results

TWO_ACTIONS = ["all Q equal, α = ξ", "the rule's action", "any other"]
HEADINGS = ["", "find the way out", "escape", "return", "mean return of all"]
BELOW = " agents in each row. The return: the median of those that escape (lowest to highest), on 1,000 roads."


def kl_of(pi: Tensor, rule_actions: Tensor, p: float = 0.9) -> float:
    """The KL (nats) of a policy in one state: pi (1, 9) probabilities above 0, rule_actions (1,) in 0..8."""
    return kl_to_rule(pi.log(), rule_actions, torch.tensor(p)).item()


def beside(rule: Tensor, best: Tensor) -> list[list[str]]:
    """A row for each policy, below `TWO_ACTIONS`: π̃, the best one with all Q equal and α = ξ, and the even one.

    rule, best: (1, 9) probabilities; the largest is of the rule's action, the others are equal.
    """
    policies = {"π̃": rule, "the best policy": best, "even": torch.full_like(rule, 1 / rule.shape[1])}
    return [[name, f"{pi.max():.3f}", f"{pi.min():.3f}"] for name, pi in policies.items()]


def outcomes(kinds: Mapping[str, Sequence[Results]]) -> list[list[str]]:
    """A row for each kind of agents with the soft constraint, of one study or of several, below `HEADINGS`."""
    rows = []
    for kind, studies in kinds.items():
        found, kept = np.concatenate([each.found_and_kept("soft") for each in studies], axis=1)
        returns = np.concatenate([each.scores("returns") for each in studies])
        low, half, high = np.percentile(returns[kept], [0, 50, 100])
        each = f"{half:.0f} ({low:.0f} to {high:.0f})"
        rows.append([kind, str(found.sum()), str(kept.sum()), each, f"{returns.mean():.0f}"])
    return rows
