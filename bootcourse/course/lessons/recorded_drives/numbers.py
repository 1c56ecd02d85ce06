"""What the numbers and claims in this lesson's text are computed from, beside tools/course/known.py."""

from functools import cache

import numpy as np

from bootcourse.course.lessons.recorded_drives import choosing
from bootcourse.course.lessons.recorded_drives.exercises import conservative_loss  # noqa: F401 (the text names it)
from bootcourse.course.lessons.recorded_drives.figures import half_success, updates_made
from bootcourse.course.shipped import shipped_agents
from bootcourse.statistics import ESCAPES
from tools.course.known import of


def share(what: str) -> float:
    """In how many % of the test drives of our GAIL agents this happened: "success", "road_departure", ..."""
    return float(100 * of("gail").episodes(what).mean())


def least_share() -> float:
    """How many % of GAIL's drives that leave the road succeed at least: if each one without success left it."""
    return 100 * (1 - (100 - share("success")) / share("road_departure"))


def others() -> np.ndarray:
    """The success of the GAIL agents that do not escape."""
    success = of("gail").scores("success")
    return success[success < ESCAPES]


def slower(axis: str) -> float:
    """How many times CQL's episodes, or updates, GAIL needs until half of its drives succeed: of the medians."""
    medians = []
    for method in ("gail", "cql"):
        at = half_success(of(method).curves["success"])
        needed = at if axis == "episodes" else np.take_along_axis(updates_made(of(method)), at[:, None] - 1, 1)[:, 0]
        medians.append(np.median(needed[at > 0]))
    return float(medians[0] / medians[1])


@cache
def worth_of(method: str) -> float:
    """What the first agent of a method is worth from the start at γ = 0.8, the mean of 100 roads."""
    return choosing.worth(shipped_agents(method)[0].as_policy(), range(100), 0.8)[0]


@cache
def overlap_of(method: str) -> float:
    """In which share of the recorded seconds it would do what was done."""
    return choosing.overlap(shipped_agents(method)[0].as_policy(), choosing.recorded())
