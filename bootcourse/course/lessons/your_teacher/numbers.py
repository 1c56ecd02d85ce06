"""What the numbers and claims in this lesson's text are computed from, beside tools/course/known.py."""

from collections import Counter
from functools import cache

import numpy as np

from bootcourse import statistics
from bootcourse.course.lessons import registry
from bootcourse.course.lessons.your_teacher import crashes, example_teachers, free_lane, taught_agents
from bootcourse.course.lessons.your_teacher.driven_out import OUT, drive_out  # noqa: F401 (the text names it)
from bootcourse.course.lessons.your_teacher.exercises import without_a_look
from bootcourse.course.lessons.your_teacher.taught_agents import demonstrated
from bootcourse.research.experiments.teacher_worth import TAUGHT  # noqa: F401 (the text names it)
from bootcourse.road.state import SPEED, TRAFFIC, Accident
from bootcourse.statistics import ESCAPES, holm
from tools.course.known import shipped_experiment, shipped_teachers

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


def gets_ahead(teacher: str) -> int:
    """How many of them end ahead of trap 1."""
    return sum(bool(drive.success) for drive in demonstrated(teacher))


def crash_returns(kind: str) -> np.ndarray:
    """What the ten agents of one kind of the experiment `crashes` earn."""
    return shipped_experiment("crashes")[kind].scores("returns")


def crash_escapes(kind: str) -> int:
    """How many of them escape."""
    return int((shipped_experiment("crashes")[kind].scores("success") >= ESCAPES).sum())


def crash_shown(kind: str) -> bool:
    """Does a rank test, after Holm for all five, tell their returns from those of the agents that learn from all?

    Of the control, and of the free lane without its accidents: from those of the cut.
    """
    bases = {"as-many": "cut", "lane": "cut"}
    others = {other: bases.get(other, "all") for other in crashes.KINDS if other not in ("all", "accident")}
    p = holm([taught_agents.p_value(crash_returns(other), crash_returns(base)) for other, base in others.items()])
    return bool(p[[*others].index(kind)] < 0.05)


def crash_p(kind: str) -> float:
    """The rank test's p of their success against that of the agents that learn from all."""
    agents = shipped_experiment("crashes")
    return taught_agents.p_value(agents[kind].scores("success"), agents["all"].scores("success"))


def racer_long() -> tuple[np.ndarray, np.ndarray]:
    """What the racer's ten students of a long training earn: (those that escape, the others)."""
    long = students(taught_agents.RACER_LONG)
    escapes = long["success"] >= ESCAPES
    return long["returns"][escapes], long["returns"][~escapes]


def half_random_against_rule(score: str) -> float:
    """The rank test's p of "success" or "returns" of half random's ten students and the rule's."""
    both = (worth()[teacher, "bootstrapped"].scores(score) for teacher in ("random-50", "rule"))
    return taught_agents.p_value(*both)


def repeated_against_rule() -> float:
    """The same of the returns of the agents that learn from all crashing drives, and the rule's students'."""
    return taught_agents.p_value(crash_returns("all"), worth()["rule", "bootstrapped"].scores("returns"))


def lost(teacher: str) -> int:
    """How many of a teacher's ten bootstrapped students lose the way out at least once in their training."""
    return int(statistics.lost(worth()[teacher, "bootstrapped"].curves["success"]).sum())


def in_free_lane(teacher: str) -> float:
    """The share of the drives of one of the study's teachers that reach the free lane."""
    return free_lane.shown(teacher)[0]


def in_it(teacher: str) -> tuple[float, float]:
    """(mean speed in m/s in the free lane, how many decisions there) of those drives that reach it."""
    return free_lane.driven_in_it(teacher)


def escape_of(teachers: list[str]) -> int:
    """How many of ten bootstrapped students each of these teachers escape, in the experiment `teachers`, together."""
    return sum(worth()[teacher, "bootstrapped"].escapers("bootstrapped") for teacher in teachers)


def taught_returns(teacher: str) -> float:
    """What the ten bootstrapped students of one of these teachers earn on average."""
    return worth()[teacher, "bootstrapped"].scores("returns").mean()


def worth() -> dict:
    """{(teacher, method): ten agents} of the experiment `teachers`."""
    return shipped_teachers()
