"""Numbers that the lesson on the soft constraint shows before its exercises compute them, and how its agents ended."""

from collections.abc import Mapping

import numpy as np
import torch
from torch import Tensor

from bootcourse.learn.bootstrap import kl_to_rule
from bootcourse.research.results import Results

HEADINGS = ["ten agents each", "find the way", "escape", "return"]
BELOW = "The return: the median of those that escape (lowest to highest), on 1,000 roads."


def kl_of(pi: Tensor, rule_actions: Tensor, p: float = 0.9) -> float:
    """The KL (nats) of a policy in one state: pi (1, 9) probabilities above 0, rule_actions (1,) in 0..8."""
    return kl_to_rule(pi.log(), rule_actions, torch.tensor(p)).item()


def outcomes(kinds: Mapping[str, Results]) -> list[list[str]]:
    """A row for each kind of agents with the soft constraint, below `HEADINGS`."""
    rows = []
    for kind, agents in kinds.items():
        found, kept = agents.found_and_kept("soft")
        low, half, high = np.percentile(agents.scores("returns")[kept], [0, 50, 100])
        rows.append([kind, str(found.sum()), str(kept.sum()), f"{half:.0f} ({low:.0f} to {high:.0f})"])
    return rows
