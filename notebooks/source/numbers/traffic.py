"""What the numbers and claims in this lesson's text are computed from, beside tools/course/known.py."""

from functools import cache

import numpy as np
from bootcourse.course.lessons.traffic import simulation as traffic

SETTLED = 32.5  # m; at this distance, centre to centre, a driver holds 10 m/s behind a car at 10 m/s


@cache
def lowest_speeds(slowest: float = 4.0) -> list[float]:
    """Of traffic's eight drivers in a row, behind a leader that brakes from 10 m/s to `slowest` (m/s) for 20 s."""
    ahead, speeds = np.repeat([10.0, slowest, 10.0], [60, 40, 140]), []
    for _ in range(8):
        ahead = traffic.behind(ahead, v=10.0, gap=SETTLED)[:-1, 1]
        speeds.append(ahead.min())
    return speeds
