"""What the numbers and claims in this lesson's text are computed from, beside tools/course/known.py."""

from functools import cache

import numpy as np
from scipy import stats

from bootcourse.course.lessons import registry
from bootcourse.course.lessons.your_teacher import example_teachers, taught_agents
from bootcourse.course.lessons.your_teacher.driven_out import OUT, drive_out
from bootcourse.episodes.evaluate import drive_episodes, held_out_seeds
from bootcourse.learn.teachers import ahead, teacher_policy, toward
from bootcourse.research import teachers
from bootcourse.research.beyond import lengths
from bootcourse.road.state import EGO, LANE, TRAFFIC, X
from bootcourse.statistics import ESCAPES
from tools.course.known import SETTINGS, shipped_teachers


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


def dense_queues() -> list:
    """Where the cars of the queue are on these roads as they begin, in metres ahead of the ego."""
    return [cars[TRAFFIC:, X] - cars[EGO, X] for cars, _ in registry()["watchful_rule"].all_arguments]


@cache
def students(teacher: str) -> dict:
    """What ships of the ten students of an example teacher, or of the ten that learned "alone"."""
    return taught_agents.reference()[teacher]


def long() -> dict:
    """What ships of ten students of the racer after a long training."""
    return taught_agents.longer()


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


@cache
def one_situation(speed: float):
    """How a rule drives there that aims for one speed (m/s), and for the next lane to the left, everywhere."""

    def rule(cars, scenario):
        return toward(cars, speed, max(0, int(cars[EGO, LANE]) - 1), scenario)

    return example_teachers.examine(rule).episodes


@cache
def looking_left():
    """How a rule drives there that aims left, 1 m/s slower than the car ahead in that lane."""

    def rule(cars, scenario):
        left = max(0, int(cars[EGO, LANE]) - 1)
        return toward(cars, min(ahead(cars, left)[1] - 1.0, 14.0), left, scenario)

    return example_teachers.examine(rule).episodes


def crashed_before(teacher: str) -> float:
    """The smallest share of these students' drives that end in an accident and not ahead of trap 1."""
    return float(np.maximum(0, students(teacher)["accident"] - students(teacher)["success"]).mean())


@cache
def near_rule():
    """How the rule that sees less far drives on the exam's roads."""
    return example_teachers.examine(taught_agents.near_sighted).episodes


def demonstrated_ahead(teacher: str) -> float:
    """How many of its demonstrations end ahead, if they do as often as its other drives."""
    return teachers_success(teacher) * SETTINGS.demonstration_episodes


def worth() -> dict:
    """{(teacher, method): ten agents} of the experiment `teachers`."""
    return shipped_teachers()


def decisions(teacher: str, method: str) -> float:
    """The thousand decisions of the whole training of one of these agents, the mean over ten."""
    return float(np.nansum(lengths(worth()[teacher, method].curves), axis=1, dtype=float).mean()) / 1000


def labels(teacher: str) -> tuple[int, int]:
    """The fewest and the most decisions of a teacher's ten DAgger agents: as many labels they learn from."""
    each = np.nansum(lengths(worth()[teacher, "dagger"].curves), axis=1, dtype=float)
    return int(each.min()), int(each.max())


def budget(method: str) -> str:
    """The same in words, from the teacher with the shortest training to that with the longest: "163 to 188"."""
    each = [decisions(teacher, method) for teacher in ("rule", "random-25", "random-50", "mirrored")]
    digits = 0 if min(each) > 10 else 1
    return f"{min(each):.{digits}f} to {max(each):.{digits}f}"


def teachers_success(teacher: str) -> float:
    """The share of such a teacher's own drives, on 200 of the study's held-out roads, that end ahead."""
    return float(own_drives(teacher).success.mean())


def teachers_accidents(teacher: str) -> float:
    """The share of these drives that end in an accident."""
    return float((own_drives(teacher).accident > 0).mean())


@cache
def own_drives(teacher: str):
    return drive_episodes(teacher_policy(teachers.TEACHERS[teacher].rule), held_out_seeds(1, 200))
