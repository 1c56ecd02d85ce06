"""What the numbers and claims in this lesson's text are computed from, beside tools/course/known.py."""

from functools import cache

import numpy as np

from bootcourse.course.lessons.the_trap.driving import all_plans, on_road
from bootcourse.course.lessons.the_trap.figures import RIGHT_FIRST
from bootcourse.episodes.evaluate import drive_episodes, held_out_seeds
from bootcourse.episodes.record import record
from bootcourse.policies import plan_policy
from tools.course.known import shipped_results


def balanced() -> np.ndarray:
    """Which of all plans steer left as often as right, (6561,) bool."""
    return (all_plans() == 3).sum(axis=1) == (all_plans() == 5).sum(axis=1)


@cache
def getting_out(road: int) -> int:
    """How many of all plans get out unhurt on a road."""
    return int(on_road(road)(all_plans()).sum())


@cache
def blind_plan():
    """The plan that looks at nothing on the study's 1,000 held-out roads: its episodes."""
    return drive_episodes(plan_policy([*RIGHT_FIRST, ("accelerate straight", 5)]), held_out_seeds(1, 1000))


@cache
def on_ten():
    """That plan on road 10."""
    return record(plan_policy([*RIGHT_FIRST, ("accelerate straight", 5)]), [10])[0]


def near_staying() -> int:
    """How many of plain SAC's agents neither succeed nor crash in more than a tenth of their drives."""
    agents = shipped_results().of("sac")
    return int(((agents.scores("success") < 0.1) & (agents.scores("accident") < 0.1)).sum())
