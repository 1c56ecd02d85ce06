"""What the numbers and claims in this lesson's text are computed from, beside tools/course/known.py."""

from functools import cache
from itertools import combinations

import numpy as np

from bootcourse.course.lessons.other_ways import figures
from bootcourse.course.lessons.other_ways.figures import after_seconds  # noqa: F401 (for the expressions)
from bootcourse.course.lessons.other_ways.measures import worth_at_most  # noqa: F401 (for the expressions)
from bootcourse.course.lessons.your_teacher.taught_agents import p_value
from bootcourse.episodes.evaluate import held_out_seeds
from bootcourse.episodes.record import record
from bootcourse.episodes.words import overtaken
from bootcourse.learn.settings import settings_for
from bootcourse.policies import rule_policy
from bootcourse.research import equal_decisions
from bootcourse.research.beyond import WINDOW  # noqa: F401 (for the expressions)
from bootcourse.research.equal_decisions import BUDGETS, by_method, tried
from bootcourse.research.results import Results
from bootcourse.scenario import DEFAULT
from bootcourse.statistics import ESCAPES, Estimate, holm, interval
from tools.course.known import shipped_experiment

FIRST, SECOND, _ = BUDGETS
TAUGHT = tuple(figures.TAKES)  # the methods with a teacher


@cache
def compared() -> dict[str, Results]:
    """{method: its agents} of the comparison at equal decisions."""
    return by_method(shipped_experiment("beyond"))


def later(method: str) -> Results:
    """The agents of a method in this comparison."""
    return compared()[method]


def at(method: str, measure: str, budget: int = FIRST) -> np.ndarray:
    """Each agent's mean return, success or accidents after so many decisions, or its seconds until then: (agents,)."""
    return equal_decisions.at(later(method), measure, budget)


def accidents_in(method: str) -> float:
    """How many of the drives of these agents end in an accident after the first budget, in %."""
    return 100 * float(at(method, "accident").mean())


def escape(method: str) -> int:
    """How many agents escape after the first budget."""
    return int((at(method, "success") >= ESCAPES).sum())


@cache
def rule_ahead_by(seconds: float) -> float:
    """On what share of 200 held-out roads the rule is ahead of trap 1 by then, and stays ahead."""
    times = [overtaken(drive) for drive in record(rule_policy(DEFAULT), held_out_seeds(1, 200), label="rule")]
    return float(np.mean([time is not None and time <= seconds for time in times]))


def score_at(method: str, budget: int = FIRST) -> Estimate:
    """The interquartile mean of these agents' returns, with its interval."""
    return interval(at(method, "returns", budget))


def middle(method: str, budget: int = FIRST) -> float:
    """The interquartile mean of these agents' returns."""
    return score_at(method, budget).value


@cache
def pairs(budget: int) -> dict[tuple[str, str], float]:
    """{a pair of the methods with a teacher: p of the rank test of their returns, after Holm}."""
    of = list(combinations([method for method in compared() if method in TAUGHT], 2))
    p = [p_value(*(at(method, "returns", budget) for method in pair)) for pair in of]
    return {pair: float(each) for pair, each in zip(of, holm(p), strict=True)}


def at_edge() -> set[str]:
    """The methods with a teacher whose best setting of the search is its first or its last."""
    places = {method: np.argmax(list(search(method).values())) for method in TAUGHT}
    return {method for method, place in places.items() if place != 1}


def lowest() -> str:
    """The method with a teacher that earns the least after the first budget."""
    return min(TAUGHT, key=lambda method: at(method, "returns").mean())


def search(method: str) -> dict[str, float]:
    """{what was tried: mean return} of the search."""
    return tried(shipped_experiment("beyond-search")[method])


def drives_before(method: str) -> int:
    """How many drives of the rule these agents have before they begin: demonstrations, or what a clone learns from."""
    settings = settings_for(method, **equal_decisions.COMMON[method])
    return settings.demonstration_episodes if settings.needs_demonstrations else 0


def decisions_per_update(method: str) -> float:
    """After how many decisions of their own these agents make an update, on average."""
    agent = later(method).agents[0]
    if "epochs" in agent:
        return agent["batch"] / agent["epochs"]
    return agent["envs_per_agent"] / agent["updates"]


def decisions_in_seconds(*methods: str) -> int:
    """How many decisions an agent makes in equal seconds of a core, in training: the median, to a thousand."""
    seconds = np.concatenate([at(method, "seconds") for method in methods])
    return int(round(np.median(equal_decisions.SECONDS * FIRST / seconds), -3))
