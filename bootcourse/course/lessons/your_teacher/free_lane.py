"""What the drives show from which students learn: whether they reach the free lane, and whether they crash."""

from functools import cache

import numpy as np

from bootcourse.course.lessons.your_teacher.crashes import lanes_of
from bootcourse.course.lessons.your_teacher.taught_agents import demonstrated
from bootcourse.road.state import EGO, SPEED


@cache
def shown(teacher: str) -> tuple[float, float]:
    """(share of the drives that reach the free lane, share that crash) of what a teacher demonstrates."""
    drives = demonstrated(teacher)
    reach = [(lanes_of(drive) == 0).any() for drive in drives]
    return float(np.mean(reach)), float(np.mean([drive.accident > 0 for drive in drives]))


def driven_in_it(teacher: str) -> tuple[float, float]:
    """(mean speed in m/s at the decisions in the free lane, how many a drive has that reaches it) of these drives."""
    drives = demonstrated(teacher)
    speeds = [drive.cars[: len(drive.actions), EGO, SPEED][lanes_of(drive) == 0] for drive in drives]
    reached = [each for each in speeds if len(each)]
    return float(np.concatenate(reached).mean()), float(np.mean([len(each) for each in reached]))
