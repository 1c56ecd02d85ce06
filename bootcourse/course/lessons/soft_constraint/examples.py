"""Numbers that the lesson on the soft constraint shows: three agents' KL."""

import torch

from bootcourse.learn.bootstrap import kl_to_rule
from bootcourse.scenario import ACTION_NAMES, N_ACTIONS


def three_agents() -> list[list[str]]:
    """A row for each of three policies: its words, and its KL (nats) where the rule says "keep left" with p = 0.9."""
    rule_says, p = torch.tensor([ACTION_NAMES.index("keep left")]), torch.tensor(0.9)
    rows = []
    for action in ("keep left", "accelerate straight"):
        sure = torch.full((1, N_ACTIONS), 1e-12)
        sure[0, ACTION_NAMES.index(action)] = 1.0
        rows.append([action, f"{kl_to_rule(sure.log(), rule_says, p).item():.3f}"])
    even = torch.full((1, N_ACTIONS), 1 / N_ACTIONS)
    return [*rows, ["no action: all nine even", f"{kl_to_rule(even.log(), rule_says, p).item():.3f}"]]
