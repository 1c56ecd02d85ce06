"""Numbers that the lesson on the soft constraint shows before its exercises compute them."""

import numpy as np
import torch
from torch import Tensor

from bootcourse.learn.bootstrap import kl_to_rule


def kl_of(pi: Tensor, rule_actions: Tensor, p: float = 0.9) -> float:
    """The KL (nats) of a policy in one state: pi (1, 9) probabilities above 0, rule_actions (1,) in 0..8."""
    return kl_to_rule(pi.log(), rule_actions, torch.tensor(p)).item()


def spread(scores: np.ndarray) -> str:
    """The median agent, the lowest and the highest, "47 (46 to 50)"; of two agents both, "−9 and 23"."""
    low, half, high = np.percentile(scores, [0, 50, 100])
    words = f"{scores[0]:.0f} and {scores[1]:.0f}" if len(scores) == 2 else f"{half:.0f} ({low:.0f} to {high:.0f})"
    return words.replace("-", "−")
