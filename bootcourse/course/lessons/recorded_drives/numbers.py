"""What the numbers and claims in this lesson's text are computed from, beside tools/course/known.py."""

from functools import cache

import numpy as np

from bootcourse.course.lessons.recorded_drives import choosing
from bootcourse.course.lessons.recorded_drives.exercises import conservative_loss  # noqa: F401 (the text names it)
from bootcourse.episodes.record import record
from bootcourse.episodes.rollout import Rollout
from bootcourse.policies import stochastic_rule_policy
from bootcourse.research.results import Results
from bootcourse.scenario import DEFAULT
from bootcourse.statistics import ESCAPES
from tools.course.known import of, shipped_results


def of_paper(method: str) -> Results:
    """The agents of a method in the study whose demonstrations are the stochastic rule's."""
    return shipped_results("paper").of(method)


@cache
def overlap_of(which: int) -> float:
    """In which share of the recorded seconds the first agent of one of `choosing.METHODS` would do what was done."""
    return choosing.overlap(list(choosing.agents().values())[which], choosing.recorded())


@cache
def estimated() -> np.ndarray:
    """What each of the lesson's six agents is worth by each of four fits, (fits, agents), as in its notebook."""
    return choosing.fits(choosing.agents().values(), choosing.recorded(), times=4)


@cache
def truth() -> np.ndarray:
    """What each of the six is worth on the road, (agents,)."""
    return np.array([choosing.worth(agent, range(100), 0.8) for agent in choosing.agents().values()])


def accidents_of_escapers() -> np.ndarray:
    """In which share of its drives each GAIL agent that escapes leaves the road, (agents,)."""
    return of("gail").scores("road_departure")[of("gail").scores("success") >= ESCAPES]


def misses() -> np.ndarray:
    """By how much the worst fit misses what each of the six is worth."""
    return np.abs(estimated() - truth()).max(axis=0)


def largest() -> list[int]:
    """Which of the six has the largest estimate in each fit."""
    return estimated().argmax(axis=1).tolist()


@cache
def by_stochastic_rule() -> list[Rollout]:
    """Drives of the stochastic rule, the second study's teacher, on 100 roads."""
    return record(stochastic_rule_policy(DEFAULT, np.random.default_rng(0)), range(100))
