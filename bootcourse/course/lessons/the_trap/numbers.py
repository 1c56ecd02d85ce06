"""What the numbers and claims in this lesson's text are computed from, beside tools/course/known.py."""

import itertools
from dataclasses import replace
from functools import cache

import numpy as np

from bootcourse.course.lessons.the_trap import figures
from bootcourse.course.lessons.the_trap.figures import RIGHT_FIRST
from bootcourse.episodes.evaluate import drive_episodes, held_out_seeds
from bootcourse.episodes.record import record
from bootcourse.policies import plan_policy
from bootcourse.scenario import DEFAULT
from tools.course.known import shipped_results

STRAIGHT_BETWEEN = (("keep left", 2), ("keep straight", 2), ("keep right", 2))


@cache
def unhurt(turns: tuple) -> np.ndarray:
    """On which of the lesson's 400 roads a plan gets out unhurt."""
    return figures.d2_and_unhurt([*turns, ("accelerate straight", 5)])[1]


@cache
def unhurt_at(rate: int) -> np.ndarray:
    """On which of 200 held-out roads the first of these plans gets out unhurt, with so many steps a second."""
    scenario = replace(DEFAULT, clock=replace(DEFAULT.clock, simulation_rate=rate))
    drives = drive_episodes(
        plan_policy([*STRAIGHT_BETWEEN, ("accelerate straight", 5)]), held_out_seeds(1, 200), scenario
    )
    return drives.success & (drives.accident == 0)


def balanced() -> np.ndarray:
    """Which of all plans steer left as often as right, (6561,) bool."""
    return (every_plan() == 3).sum(axis=1) == (every_plan() == 5).sum(axis=1)


def every_plan() -> np.ndarray:
    """The plans that steer left (3), straight (4) or right (5) in each of eight seconds: (6561, 8)."""
    return np.array(list(itertools.product((3, 4, 5), repeat=8)))


@cache
def blind_plan():
    """That plan on the study's 1,000 held-out roads: its episodes."""
    return drive_episodes(plan_policy([*RIGHT_FIRST, ("accelerate straight", 5)]), held_out_seeds(1, 1000))


@cache
def on_ten():
    """That plan on road 10."""
    return record(plan_policy([*RIGHT_FIRST, ("accelerate straight", 5)]), [10])[0]


def stayers() -> np.ndarray:
    """The returns of plain SAC's agents that neither succeed nor crash in more than a tenth of their drives."""
    agents = shipped_results().of("sac")
    return agents.scores("returns")[(agents.scores("success") < 0.1) & (agents.scores("accident") < 0.1)]


def near_staying() -> int:
    """How many they are."""
    return len(stayers())
