"""What the numbers and claims in this lesson's text are computed from, beside tools/course/known.py."""

from functools import cache

import numpy as np
from bootcourse.episodes.evaluate import held_out_seeds
from bootcourse.episodes.record import record
from bootcourse.episodes.words import overtaken
from bootcourse.policies import rule_policy
from bootcourse.research import equal_decisions
from bootcourse.research.equal_decisions import BUDGETS, by_method, tried
from bootcourse.research.results import Results, found  # noqa: F401
from bootcourse.scenario import DEFAULT
from bootcourse.statistics import ESCAPES, interval, iqm  # noqa: F401
from tools.course.known import shipped_experiment, shipped_teachers

HALF, LAST = BUDGETS


@cache
def compared() -> dict[str, Results]:
    """{method: its agents} of the comparison at equal decisions."""
    return by_method(shipped_experiment("beyond"))


def later(method: str) -> Results:
    """The agents of a method in this comparison."""
    return compared()[method]


def at(method: str, measure: str, budget: int = LAST) -> np.ndarray:
    """Each agent's mean return, success or accidents after so many decisions, or its seconds until then: (agents,)."""
    return later(method).measured[f"{measure}_{budget}"]


def cost(method: str) -> float:
    """Seconds of one core for a decision of these agents, until the last of their budgets."""
    budget = equal_decisions.budgets_of(method)[-1]
    return float(at(method, "seconds", budget).mean()) / budget


def middle(method: str, budget: int = LAST) -> float:
    """The interquartile mean of these agents' returns."""
    return float(iqm(at(method, "returns", budget)))


def escaping(method: str, budget: int = LAST) -> int:
    """How many of these agents escape."""
    return int((at(method, "success", budget) >= ESCAPES).sum())


def search(method: str) -> dict[str, float]:
    """{what was tried: mean return} of the search."""
    return tried(shipped_experiment("beyond-search")[method])


@cache
def rules_overtaking() -> np.ndarray:
    """When the rule is ahead of trap 1, in seconds on each of 100 held-out roads; inf where it is not."""
    drives = record(rule_policy(DEFAULT), held_out_seeds(1, 100))
    return np.array([overtaken(drive) or np.inf for drive in drives])


def rlpd() -> Results:
    """Ten RLPD agents that the rule taught, of the experiment on teachers."""
    return shipped_teachers()["rule", "rlpd"]


def short() -> float:
    """How many decisions the first 50 episodes of such an agent take altogether."""
    return float(rlpd().curves["decisions"][:, :50].sum(axis=1, dtype=float).mean())
