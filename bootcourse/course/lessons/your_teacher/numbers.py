"""What the numbers and claims in this lesson's text are computed from, beside tools/course/known.py."""

from collections import Counter
from functools import cache

import numpy as np
from scipy import stats

from bootcourse.course.lessons import registry
from bootcourse.course.lessons.your_teacher import example_teachers, taught_agents
from bootcourse.course.lessons.your_teacher.driven_out import BEHIND, OUT, drive_out  # noqa: F401 (the text names them)
from bootcourse.course.lessons.your_teacher.exercises import without_a_look
from bootcourse.episodes.evaluate import drive_episodes, held_out_seeds
from bootcourse.episodes.record import record
from bootcourse.learn.demonstrations import FIRST_SEED
from bootcourse.learn.teachers import teacher_policy, toward
from bootcourse.research import teachers
from bootcourse.research.beyond import lengths
from bootcourse.road.state import EGO, LANE, TRAFFIC, Accident, X
from bootcourse.statistics import ESCAPES
from tools.course.known import SETTINGS, shipped_teachers

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


def crashed_before(teacher: str) -> float:
    """The smallest share of these students' drives that end in an accident and not ahead of trap 1."""
    return float(np.maximum(0, students(teacher)["accident"] - students(teacher)["success"]).mean())


@cache
def near_rule():
    """How the rule that sees less far drives on the exam's roads."""
    return example_teachers.examine(taught_agents.near_sighted).episodes


def first_seeds(teacher: str) -> str:
    """The success of the first three of these students, in %: "95, 100 and 97"."""
    first, second, third = (f"{100 * share:.0f}" for share in students(teacher)["success"][:3])
    return f"{first}, {second} and {third}"


def best_point() -> tuple[int, int, int]:
    """After how many updates the racer's ten students together succeeded most: updates, successes, of how many."""
    escapes, drives = long()["escapes"], 30
    best = escapes.mean(axis=0).argmax()
    return int(long()["updates"][best]), round(drives * escapes[:, best].sum()), drives * len(escapes)


def returns_correlate() -> float:
    """Spearman's rank correlation, over the six teachers, of what each earns and what its students earn on average."""
    own = [example_teachers.examine(rule).episodes.returns.mean() for rule in taught_agents.TEACHERS.values()]
    return float(stats.spearmanr(own, [students(name)["returns"].mean() for name in taught_agents.TEACHERS]).statistic)


@cache
def demonstrated(teacher: str) -> list:
    """The drives that it demonstrates."""
    roads = [FIRST_SEED + number for number in range(SETTINGS.demonstration_episodes)]
    return record(teacher_policy(teachers.TEACHERS[teacher].rule), roads)


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


def labels(teacher: str) -> tuple[int, int]:
    """The fewest and the most decisions of a teacher's ten DAgger agents: as many labels they learn from."""
    each = np.nansum(lengths(worth()[teacher, "dagger"].curves), axis=1, dtype=float)
    return int(each.min()), int(each.max())


def budget(method: str) -> str:
    """The same in words, from the teacher with the shortest training to that with the longest: "163 to 188"."""
    each = [decisions(teacher, method) for teacher in ("rule", "random-25", "random-50", "mirrored")]
    digits = 0 if min(each) > 10 else 1
    return f"{min(each):.{digits}f} to {max(each):.{digits}f}"


def earned(teacher: str, method: str) -> float:
    """What the ten agents of a teacher and a method earn, the mean."""
    return float(worth()[teacher, method].scores("returns").mean())


def half_against_rule(method: str) -> float:
    """The rank test's p-value by return, of the half-random teacher's ten students and the rule's."""
    return taught_agents.p_value(*(worth()[teacher, method].scores("returns") for teacher in ("random-50", "rule")))


def of_ten(method: str) -> str:
    """Two cells of a table: how many escape with two teachers, and the second's share of accidents, in %."""
    half, quarter = (worth()[teacher, method] for teacher in ("random-50", "random-25"))
    accidents = 100 * quarter.episodes("accident").mean()
    return f"{half.escapers(method)} and {quarter.escapers(method)} of ten | {accidents:.0f} %"


@cache
def own_drives(teacher: str):
    """How such a teacher drives itself, on 200 of the study's held-out roads."""
    return drive_episodes(teacher_policy(teachers.TEACHERS[teacher].rule), held_out_seeds(1, 200))
