"""What the numbers and claims in this lesson's text are computed from, beside tools/course/known.py."""

import dataclasses
from functools import cache

import numpy as np
from bootcourse.course.lessons.traffic import simulation as traffic
from bootcourse.errors import BootcourseError
from bootcourse.scenario import DEFAULT


@cache
def lowest_speeds() -> list[float]:
    """Of traffic's eight drivers in a row, behind a leader that brakes to 4 m/s for 20 s."""
    ahead, found = np.repeat([10.0, 4.0, 10.0], [60, 40, 140]), []
    for _ in range(8):
        ahead = traffic.behind(ahead, v=10.0, gap=25.0)[:-1, 1]
        found.append(ahead.min())
    return found


def accepts_road(length: float) -> bool:
    """Whether the default scenario accepts a road of this length (m)."""
    try:
        dataclasses.replace(DEFAULT, road=dataclasses.replace(DEFAULT.road, length=length))
    except BootcourseError:
        return False
    return True
