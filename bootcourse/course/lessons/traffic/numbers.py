"""What the numbers and claims in this lesson's text are computed from, beside tools/course/known.py."""

import dataclasses
from functools import cache

from bootcourse.course.lessons.traffic import simulation as traffic
from bootcourse.scenario import DEFAULT

SETTLED = 32.5  # m; at this distance, centre to centre, a driver holds 10 m/s behind a car at 10 m/s


@cache
def lowest_speeds(slowest: float) -> list[float]:
    """Of traffic's eight drivers in a row, behind a leader that brakes from 10 m/s to `slowest` (m/s)."""
    return [speeds.min() for speeds in traffic.row(traffic.leader(slowest))]


@cache
def slowest(spacing: float, first: float, a_max: float = 0.5, b: float = 0.5, dt: float = 0.5) -> float:
    """The speed (m/s) of the slowest car of a ring after 800 s, one of whose cars begins at `first` (m/s)."""
    drivers = dataclasses.replace(DEFAULT.traffic, a_max=a_max, b=b)
    return traffic.ring(spacing, first, seconds=800, traffic=drivers, dt=dt)[1][-1].min()


@cache
def in_halves(speeding_up: float, braking: float) -> float:
    """The same in the ring of 20 m after 1,600 s, if drivers speed up and brake so many times as strongly."""
    stronger = traffic.stronger(speeding_up, braking)
    return traffic.ring(20, seconds=1600, acceleration=stronger)[1][-1].min()
