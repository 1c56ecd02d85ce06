"""What the numbers and claims in this lesson's text are computed from, beside tools/course/known.py."""

from functools import cache

import numpy as np
from bootcourse.course.lessons import registry
from bootcourse.course.lessons.your_teacher import example_teachers, taught_agents
from bootcourse.course.lessons.your_teacher.driven_out import OUT, drive_out
from bootcourse.learn.teachers import toward
from bootcourse.road.state import EGO, LANE
from bootcourse.statistics import ESCAPES
from scipy import stats


@cache
def teacher_exam(name: str):
    """How one of the example teachers drives on the exam's roads."""
    return example_teachers.examine(getattr(example_teachers, name)).episodes


@cache
def dense_escapes(name: str) -> float:
    """The share of the roads with a dense left lane on which an example teacher gets out unharmed."""
    rule = getattr(example_teachers, name)
    roads = registry()["watchful_rule"].all_arguments
    return float(np.mean([drive_out(rule, cars, scenario) == OUT for cars, scenario in roads]))


@cache
def students(teacher: str) -> dict:
    """What ships of the ten students of an example teacher, or of the ten that learned "alone"."""
    return taught_agents.reference()[teacher]


def student_escapes(teacher: str) -> int:
    """How many of these ten escape."""
    return int((students(teacher)["success"] >= ESCAPES).sum())


def teacher_tests() -> dict:
    """Holm's adjusted p-values against the ten that learned alone: {(teacher, score): p}."""
    names = list(taught_agents.TEACHERS)
    pairs = [(name, score) for name in names for score in ("success", "returns")]
    p = [stats.mannwhitneyu(students(name)[score], students("alone")[score]).pvalue for name, score in pairs]
    return dict(zip(pairs, taught_agents.holm(p), strict=True))


@cache
def two_situations(slow: float):
    """How a rule of two situations drives there: 12 m/s on the free lane, elsewhere slow (m/s) and one lane left."""

    def rule(cars, scenario):
        lane = int(cars[EGO, LANE])
        return toward(cars, 12.0 if lane == 0 else slow, max(0, lane - 1), scenario)

    return example_teachers.examine(rule).episodes
