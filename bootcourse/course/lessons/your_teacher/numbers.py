"""What the numbers and claims in this lesson's text are computed from, beside tools/course/known.py."""

from collections import Counter
from functools import cache

import numpy as np

from bootcourse.course.lessons import registry
from bootcourse.course.lessons.your_teacher import example_teachers, figures, taught_agents  # noqa: F401
from bootcourse.course.lessons.your_teacher.driven_out import OUT, drive_out  # noqa: F401 (the text names it)
from bootcourse.course.lessons.your_teacher.exercises import without_a_look
from bootcourse.course.lessons.your_teacher.taught_agents import demonstrated
from bootcourse.research.beyond import lengths
from bootcourse.road.state import EGO, LANE, SPEED, TRAFFIC, Accident
from bootcourse.statistics import ESCAPES
from tools.course.known import shipped_teachers

COLLIDES = Accident.COLLISION


@cache
def teacher_exam(name: str):
    """How one of the example teachers drives on the exam's roads."""
    return example_teachers.examine(getattr(example_teachers, name)).episodes


@cache
def dense(name: str) -> Counter:
    """How often a rule's drives on the roads with a dense left lane end how: {a number of `drive_out`: roads}."""
    rule = without_a_look if name == "without_a_look" else getattr(example_teachers, name)
    return Counter(drive_out(rule, cars, scenario) for cars, scenario in registry()["watchful_rule"].all_arguments)


def slowest_in_queues() -> float:
    """The lowest speed of a car in the queues of these roads, in m/s."""
    return min(float(cars[TRAFFIC:, SPEED].min()) for cars, _ in registry()["watchful_rule"].all_arguments)


@cache
def students(teacher: str) -> dict:
    """What ships of the ten students of an example teacher, or of the ten that learned "alone"."""
    return taught_agents.shipped(teacher)


@cache
def verdicts() -> dict:
    """Whether the teachers help, by success and by return."""
    return taught_agents.verdicts(taught_agents.reference())


def student_escapes(teacher: str) -> int:
    """How many of these ten escape."""
    return int((students(teacher)["success"] >= ESCAPES).sum())


@cache
def two_situations(slow: float):
    """How a rule of two situations drives there: 12 m/s on the free lane, elsewhere slow (m/s) and one lane left."""
    return example_teachers.examine(example_teachers.two_speeds(slow, 12.0)).episodes


@cache
def one_situation(speed: float):
    """How a rule drives there that aims for one speed (m/s), and for the next lane to the left, everywhere."""
    return example_teachers.examine(example_teachers.two_speeds(speed, speed)).episodes


def gets_ahead(teacher: str) -> int:
    """How many of them end ahead of trap 1."""
    return sum(bool(drive.success) for drive in demonstrated(teacher))


def reach_free_lane(teacher: str) -> int:
    """How many of them come to the free lane."""
    return sum(bool((drive.states[:, EGO, LANE] == 0).any()) for drive in demonstrated(teacher))


def worth() -> dict:
    """{(teacher, method): ten agents} of the experiment `teachers`."""
    return shipped_teachers()


def decisions(teacher: str, method: str) -> float:
    """The thousand decisions of the whole training of one of these agents, the mean over ten."""
    return float(np.nansum(lengths(worth()[teacher, method].curves), axis=1, dtype=float).mean()) / 1000


def budget() -> str:
    """The same in words, from the shortest of the lesson's four trainings to the longest: "161 to 188"."""
    each = [decisions(*pair) for pair in taught_agents.of_two_learners()]
    return f"{min(each):.0f} to {max(each):.0f}"
