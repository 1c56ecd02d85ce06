"""Numbers that the lesson on the soft constraint shows before its exercises compute them."""

import torch
from torch import Tensor

from bootcourse.learn.bootstrap import kl_to_rule


def kl_of(pi: Tensor, rule_actions: Tensor, p: float = 0.9) -> float:
    """The KL (nats) of a policy in one state: pi (1, 9) probabilities above 0, rule_actions (1,) in 0..8."""
    return kl_to_rule(pi.log(), rule_actions, torch.tensor(p)).item()
