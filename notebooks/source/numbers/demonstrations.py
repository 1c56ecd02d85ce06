"""What the numbers and claims in this lesson's text are computed from, beside tools/course/known.py."""

from functools import cache

import numpy as np
from bootcourse.episodes.record import record
from bootcourse.road.state import EGO, LANE, TRAP_1, X
from bootcourse.scenario import ACTION_NAMES
from tools.course.known import rule_drives, shipped_runs


def way_out() -> tuple[float, float]:
    """After how many seconds the rule is in the free lane, and ahead of trap 1: medians of those drives."""
    cars = [drive.states[::2] for drive in rule_drives()]
    free = [np.argmax(each[:, EGO, LANE] == 0) for each in cars]
    ahead = [np.argmax(each[:, EGO, X] > each[:, TRAP_1, X]) for each in cars]
    return float(np.median(free)), float(np.median(ahead))


def rule_keeps_left(second: int) -> float:
    """The share of those drives in which the rule keeps its speed and steers left at a second."""
    keep_left = ACTION_NAMES.index("keep left")
    return float(np.mean([drive.actions[second] == keep_left for drive in rule_drives()]))


@cache
def clone_agrees(seed: int, second: int) -> float:
    """The share of 40 roads on which a clone of the study does at a second what the rule would do in its place."""
    drives = record(shipped_runs("bc")[seed].agent.as_policy(), range(40))
    return float(np.mean([drive.actions[second] == drive.rule_actions[second] for drive in drives]))
