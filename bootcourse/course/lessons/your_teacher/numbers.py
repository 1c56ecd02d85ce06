"""What the numbers and claims in this lesson's text are computed from, beside tools/course/known.py."""

from collections import Counter
from functools import cache

import numpy as np

from bootcourse.course.lessons import registry
from bootcourse.course.lessons.your_teacher import crashes, example_teachers, figures, free_lane, taught_agents  # noqa: F401 (crashes: for the claims)
from bootcourse.course.lessons.your_teacher.crashes import lanes_of
from bootcourse.course.lessons.your_teacher.driven_out import OUT, drive_out  # noqa: F401 (the text names it)
from bootcourse.course.lessons.your_teacher.exercises import without_a_look
from bootcourse.course.lessons.your_teacher.taught_agents import demonstrated
from bootcourse.episodes.record import record
from bootcourse.learn.demonstrations import FIRST_SEED
from bootcourse.learn.settings import settings_for
from bootcourse.learn.teachers import teacher_policy
from bootcourse.research.experiments.teacher_worth import TAUGHT  # noqa: F401 (the text names it)
from bootcourse.research.teachers import TEACHERS as STUDIED
from bootcourse.road.state import EGO, SPEED, TRAFFIC, Accident
from bootcourse.statistics import ESCAPES, holm
from tools.course.known import discounted, shipped_experiment, shipped_teachers, speed_reward

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


def crash_returns(kind: str) -> np.ndarray:
    """What the ten agents of one kind of the experiment `crashes` earn."""
    return shipped_experiment("crashes")[kind].scores("returns")


def crash_escapes(kind: str) -> int:
    """How many of them escape."""
    return int((shipped_experiment("crashes")[kind].scores("success") >= ESCAPES).sum())


AGAINST = {"no-labels": "all", "no-bonus": "all", "cut": "all", "lane": "cut", "lane-no-bonus": "no-bonus"}


def crash_p(kind: str) -> float:
    """The rank test's p of one kind's success against that of `AGAINST`, after Holm for the lesson's five."""
    agents = shipped_experiment("crashes")
    pairs = [[agents[one].scores("success") for one in pair] for pair in AGAINST.items()]
    return float(holm([taught_agents.p_value(*pair) for pair in pairs])[[*AGAINST].index(kind)])


def racer_long() -> tuple[np.ndarray, np.ndarray]:
    """What the racer's ten students of a long training earn: (those that escape, the others)."""
    long = students(taught_agents.RACER_LONG)
    escapes = long["success"] >= ESCAPES
    return long["returns"][escapes], long["returns"][~escapes]


def student_p(one: str, other: str, score: str) -> float:
    """The rank test's p of a score of the students of two teachers."""
    return taught_agents.p_value(students(one)[score], students(other)[score])


def long_p() -> float:
    """The same of the success of the two racers' students after a long training."""
    return student_p(taught_agents.RACER_LONG, taught_agents.SLOWER_LONG, "success")


def brief_and_long(brief: str, long: str) -> str:
    """Four cells of a table: how many students escape and what they earn, after a short and after a long training."""
    cells = [(student_escapes(name), round(float(students(name)["returns"].mean()))) for name in (brief, long)]
    return " | ".join(str(cell) for pair in cells for cell in pair)


def pays(*speeds: float) -> str:
    """Cells of a table: what a second at each of these steady speeds (m/s) pays."""
    return " | ".join(f"{speed_reward(speed):.2f}" for speed in speeds)


def signed(worth: float) -> str:
    """ "+2.6", with a true minus sign."""
    return f"{worth:+.1f}".replace("-", "−")


def crash_accidents(kind: str) -> float:
    """The share of roads on which the agents of one kind of the experiment `crashes` crash."""
    return float(shipped_experiment("crashes")[kind].scores("accident").mean())


def own_return(teacher: str) -> str:
    """What a teacher earns on the exam's roads: an example teacher, or one of the study's."""
    rule = STUDIED[teacher].rule if teacher in STUDIED else getattr(example_teachers, teacher)
    earns = example_teachers.examine(rule).episodes.returns.mean()
    return f"{earns:.0f}".replace("-", "−")


@cache
def speeds_in_lane(teacher: str) -> tuple[np.ndarray, int]:
    """The ego's speeds in the free lane on a teacher's first drives, in m/s; how many drives."""
    roads = [FIRST_SEED + number for number in range(40)]
    rule = None if teacher in STUDIED else getattr(example_teachers, teacher)
    drives = record(teacher_policy(rule), roads) if rule else demonstrated(teacher)
    speeds = [drive.cars[: len(drive.actions), EGO, SPEED][lanes_of(drive) == 0] for drive in drives]
    return np.concatenate(speeds), len(drives)


def median_in_lane(teacher: str) -> float:
    """Their median."""
    return float(np.median(speeds_in_lane(teacher)[0]))


def seconds_that_pay(teacher: str) -> float:
    """The seconds of a drive, on average, at 12.5 to 16 m/s in the free lane."""
    speeds, drives = speeds_in_lane(teacher)
    return float(((speeds > 12.5) & (speeds < 16)).sum() / drives)


def from_the_lane(teacher: str, bonus: float, at_end: float | None = None) -> float:
    """What a teacher's drives that reach the free lane are worth from there on, with a bonus in each second.

    at_end: the bonus of a drive's last second, the accident's; None for the same one.
    """
    gamma, worths = settings_for("bootstrapped").gamma, []
    for drive in demonstrated(teacher):
        free = lanes_of(drive) == 0
        if free.any():
            paid = drive.rewards + bonus
            paid[-1] += 0 if at_end is None else at_end - bonus
            rest = paid[free.argmax() :]
            worths.append(gamma ** np.arange(len(rest)) @ rest)
    return float(np.mean(worths))


@cache
def whole(teacher: str) -> float:
    """What the drives that one of the study's teachers demonstrates are worth on average."""
    return float(np.mean([discounted(drive, settings_for("bootstrapped").gamma) for drive in demonstrated(teacher)]))


def ranked() -> list[str]:
    """The six teachers that the lesson shows, the one whose drives are worth the least first."""
    return sorted(figures.SIX, key=whole)


def in_free_lane(teacher: str) -> float:
    """The share of the drives of one of the study's teachers that reach the free lane."""
    return free_lane.shown(teacher)[0]


def escape_of(teachers: list[str]) -> int:
    """How many of ten bootstrapped students each of these teachers escape, in the experiment `teachers`, together."""
    return sum(worth()[teacher, "bootstrapped"].escapers("bootstrapped") for teacher in teachers)


def taught_returns(teacher: str) -> float:
    """What the ten bootstrapped students of one of these teachers earn on average."""
    return worth()[teacher, "bootstrapped"].scores("returns").mean()


def worth() -> dict:
    """{(teacher, method): ten agents} of the experiment `teachers`."""
    return shipped_teachers()
