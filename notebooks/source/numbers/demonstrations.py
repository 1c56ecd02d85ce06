"""What the numbers and claims in this lesson's text are computed from, beside tools/course/known.py."""

from functools import cache

import numpy as np
from bootcourse.episodes.evaluate import drive_episodes, held_out_seeds
from bootcourse.episodes.record import record
from bootcourse.policies import stochastic_rule_policy
from bootcourse.research.results import Results
from bootcourse.road.state import EGO, LANE, TRAP_1, X
from bootcourse.scenario import ACTION_NAMES, DEFAULT
from tools.course.known import rule_drives, shipped_runs, shipped_teachers


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


@cache
def agreement_at_5() -> np.ndarray:
    """The same at 5 s for each clone of the study that ships."""
    return np.array([clone_agrees(seed, 5) for seed in range(len(shipped_runs("bc")))])


def taught_by_dagger() -> Results:
    """The ten DAgger agents that the rule taught, of the experiment on teachers."""
    return shipped_teachers()["rule", "dagger"]


@cache
def erring(error: float, seconds: float) -> float:
    """The share of the lesson's 200 drives in which a rule that errs has had an accident by then."""
    rng = np.random.default_rng(0)
    drives = drive_episodes(stochastic_rule_policy(DEFAULT, rng, 1 - error), held_out_seeds(2, 200))
    ended = np.where(drives.accident > 0, drives.distance / drives.speed, np.inf)
    return float(np.mean(ended <= seconds))
