"""What the numbers and claims in this lesson's text are computed from, beside tools/course/known.py."""

from functools import cache

import numpy as np
from bootcourse.course.lessons import registry
from bootcourse.course.lessons.your_own_problem import loops  # noqa: F401 (for the expressions)
from bootcourse.research import elsewhere, elsewhere_claims  # noqa: F401
from bootcourse.research.elsewhere import settings_of  # noqa: F401
from bootcourse.research.problems import PROBLEMS  # noqa: F401
from bootcourse.research.results import experiment

FOUR = ("cloning", "soft", "demonstrations", "both")
SHOWN = [(p, t) for p in ("mountain-car", "cartpole", "lander") for t in ("good", "random", "systematic")]


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


def majority_right(right: float, votes: int) -> float:
    """The exercise's solution."""
    return registry()["majority_right"](right, votes)


def drowning_bonus(*arguments: float) -> float:
    """The exercise's solution."""
    return registry()["drowning_bonus"](*arguments)


def decisions_on_cartpole(teacher: str, method: str) -> np.ndarray:
    """How many decisions each agent made in training, where each decision pays 1: (agents,)."""
    return np.nansum(cells().get("cartpole", teacher, method).curves["return"], axis=1)


def thousands(teacher: str) -> str:
    """The fewest and the most of them of the agents with the soft constraint, "55,000 to 93,000"."""
    each = decisions_on_cartpole(teacher, "soft")
    return f"{round(each.min(), -3):,.0f} to {round(each.max(), -3):,.0f}"


def h3(verdict: str) -> int:
    """How many comparisons of the third hypothesis have this verdict."""
    return sum(claim.verdict == verdict for claim in elsewhere_claims.claims_of("H3", cells())[0])


def best(problem: str, teacher: str, choose=max) -> str:
    """The one of the four methods with the highest mean return in a row, or with `min` the lowest."""
    return choose(FOUR, key=lambda method: cells().mean(problem, teacher, method))
