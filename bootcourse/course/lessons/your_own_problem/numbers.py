"""What the numbers and claims in this lesson's text are computed from, beside tools/course/known.py."""

from functools import cache

import numpy as np

from bootcourse.course.lessons import registry
from bootcourse.course.lessons.your_own_problem import loops  # noqa: F401 (for the expressions)
from bootcourse.research import elsewhere, elsewhere_claims, equal_decisions  # noqa: F401
from bootcourse.research.computed import experiment
from bootcourse.research.elsewhere import settings_of  # noqa: F401
from bootcourse.research.problems import PROBLEMS  # noqa: F401

TEACHERS = ("good", "random", "systematic")
FOUR = ("cloning", "soft", "demonstrations", "both")
SHOWN = [(p, t) for p in ("mountain-car", "cartpole", "lander") for t in TEACHERS]


@cache
def cells() -> elsewhere_claims.Cells:
    """What ships of the study on other problems."""
    return elsewhere_claims.Cells(experiment("elsewhere"))


def score(problem: str, teacher: str, method: str, measure: str = "success") -> float:
    """The mean over agents of a cell, see `elsewhere_claims.Cells.scores`."""
    return cells().mean(problem, teacher, method, measure)


def percent(problem: str, teacher: str, method: str, measure: str = "success") -> str:
    """The same in %."""
    return f"{100 * score(problem, teacher, method, measure):.0f}"


def by_bonus(teacher: str) -> np.ndarray:
    """The success of both aids on DoorKey with c = 0, 0.03, 0.1, 0.3, 1 and 2, by drawn actions, (6,)."""
    names = [f"both, c = {c}" for c in (0, 0.03, 0.1, 0.3, 1)]
    return np.array([score("doorkey", teacher, name, "drawn_success") for name in (*names, "both")])


def majority_right(right: float, votes: int) -> float:
    """The exercise's solution."""
    return registry()["majority_right"](right, votes)


def drowning_bonus(*arguments: float) -> float:
    """The exercise's solution."""
    return registry()["drowning_bonus"](*arguments)


def pushes(method: str) -> float:
    """The median number of decisions in training on CartPole, with the systematic teacher: each earns 1."""
    return float(np.median(cells().get("cartpole", "systematic", method).curves["return"].sum(axis=1)))
