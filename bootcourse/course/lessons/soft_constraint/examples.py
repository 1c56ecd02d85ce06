"""Numbers that the lesson on the soft constraint shows: three policies' KL, and what fast agents earn and do."""

from collections.abc import Sequence
from functools import cache

import numpy as np
import torch

from bootcourse.course.shipped import shipped_agents
from bootcourse.episodes.record import record
from bootcourse.episodes.rollout import Rollout
from bootcourse.learn.bootstrap import kl_to_rule
from bootcourse.policies import rule_policy
from bootcourse.road.state import EGO, SPEED
from bootcourse.scenario import ACTION_NAMES, DEFAULT, N_ACTIONS

ROADS, LATER = range(20), 40  # s: from here on the seconds count


def three_agents() -> list[list[str]]:
    """A row for each of three policies: its words, and its KL (nats) where the rule says "keep left" with p = 0.9."""
    rule_says, p = torch.tensor([ACTION_NAMES.index("keep left")]), torch.tensor(0.9)
    rows = []
    for action in ("keep left", "accelerate straight"):
        sure = torch.full((1, N_ACTIONS), 1e-12)
        sure[0, ACTION_NAMES.index(action)] = 1.0
        rows.append([f"sure of {action}", f"{kl_to_rule(sure.log(), rule_says, p).item():.3f}"])
    even = torch.full((1, N_ACTIONS), 1 / N_ACTIONS)
    return [*rows, ["all nine even", f"{kl_to_rule(even.log(), rule_says, p).item():.3f}"]]


def a_second(drives: Sequence[Rollout]) -> tuple[float, float, float]:
    """Speed (m/s), reward, and the share of actions that are not the rule's, means of the seconds that count."""
    speeds = [drive.states[:: drive.scenario.clock.steps][: len(drive.actions), EGO, SPEED] for drive in drives]
    others = [drive.actions != drive.rule_actions for drive in drives]
    kinds = speeds, [drive.rewards for drive in drives], others
    return tuple(float(np.concatenate([each[LATER:] for each in kind]).mean()) for kind in kinds)


@cache
def fast_and_rule() -> dict[str, tuple[float, float, float]]:
    """`a_second` of the study's first five agents with the soft constraint together, and of the rule."""
    by_agents = [drive for agent in shipped_agents("soft") for drive in record(agent.as_policy(), ROADS)]
    return {"five fast agents": a_second(by_agents), "the rule": a_second(record(rule_policy(DEFAULT), ROADS))}


def fast_seconds() -> list[list[str]]:
    """A row of a table for each of the two."""
    return [
        [name, f"{speed:.1f}", f"{reward:.2f}", f"{100 * others:.0f} %"]
        for name, (speed, reward, others) in fast_and_rule().items()
    ]
