"""What the numbers and claims in this lesson's text are computed from, beside tools/course/known.py."""

from functools import cache

import numpy as np

from bootcourse.course.lessons import registry
from bootcourse.course.lessons.your_own_problem import loops  # noqa: F401 (for the expressions)
from bootcourse.course.lessons.your_own_problem.figures import decisions_of
from bootcourse.research import elsewhere, elsewhere_claims, equal_decisions  # noqa: F401
from bootcourse.research.computed import experiment
from bootcourse.research.elsewhere import settings_of  # noqa: F401
from bootcourse.research.problems import PROBLEMS  # noqa: F401
from bootcourse.statistics import ESCAPES

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


def majority_right(right: float, votes: int) -> float:
    """The exercise's solution."""
    return registry()["majority_right"](right, votes)


def drowning_bonus(*arguments: float) -> float:
    """The exercise's solution."""
    return registry()["drowning_bonus"](*arguments)


def decisions(problem: str, method: str, *teachers: str) -> np.ndarray:
    """How many decisions each agent made in training with any of these teachers: (agents,). MountainCar, CartPole."""
    return np.concatenate([decisions_of(cells(), problem, teacher, method) for teacher in teachers])


def with_aids(problem: str) -> np.ndarray:
    """The same of all agents with the soft constraint, demonstrations or both, with any teacher."""
    return np.concatenate([decisions(problem, method, *TEACHERS) for method in FOUR[1:]])


def ratio_of_aids(teacher: str) -> float:
    """On CartPole, the largest of the three aids' median numbers of decisions over the smallest."""
    medians = [float(np.median(decisions("cartpole", method, teacher))) for method in FOUR[1:]]
    return max(medians) / min(medians)


def decisions_on_doorkey(teacher: str, method: str) -> float:
    """The median number of decisions in training, in thousands: a success pays 1 − 0.9 t / 100, t decisions."""
    curves = cells().get("doorkey", teacher, method).curves
    each = np.where(curves["success"] > 0.5, (1 - curves["return"].astype(float)) / 0.009, 100.0)
    return float(np.median(each.sum(axis=1))) / 1000


def h3(verdict: str) -> int:
    """How many comparisons of the third hypothesis have this verdict."""
    return sum(claim.verdict == verdict for claim in elsewhere_claims.claims_of("H3", cells())[0])


def confirmed_of_h3() -> list[elsewhere_claims.Claim]:
    """The confirmed ones of them."""
    return [claim for claim in elsewhere_claims.claims_of("H3", cells())[0] if claim.verdict == "confirmed"]


def best(problem: str, teacher: str, choose=max) -> str:
    """The one of the four methods with the highest mean return in a row, or with `min` the lowest."""
    return choose(FOUR, key=lambda method: cells().mean(problem, teacher, method))


def plain_with_entropy() -> tuple[int, int]:
    """Of the course's plain SAC agents with η = 0.3: how many escape after 200,000 decisions, of how many."""
    agents = equal_decisions.by_method(experiment("beyond"))["sac"]
    success = equal_decisions.at(agents, "success", equal_decisions.BUDGETS[1])
    return int((success >= ESCAPES).sum()), len(success)
