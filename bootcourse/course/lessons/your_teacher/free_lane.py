"""What the drives show from which students learn: whether they reach the free lane, and whether they crash."""

from functools import cache

import numpy as np

from bootcourse.course.lessons.your_teacher.crashes import lanes_of
from bootcourse.course.lessons.your_teacher.taught_agents import demonstrated


@cache
def shown(teacher: str) -> tuple[float, float]:
    """(share of the drives that reach the free lane, share that crash) of what a teacher demonstrates."""
    drives = demonstrated(teacher)
    reach = [(lanes_of(drive) == 0).any() for drive in drives]
    return float(np.mean(reach)), float(np.mean([drive.accident > 0 for drive in drives]))
