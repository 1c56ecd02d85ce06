"""What the numbers and claims in this lesson's text are computed from, beside tools/course/known.py."""

from functools import cache

from bootcourse.course.lessons import registry
from bootcourse.course.lessons.your_own_problem import loops  # noqa: F401 (for the expressions)
from bootcourse.research import elsewhere_claims
from bootcourse.research.results import experiment


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
