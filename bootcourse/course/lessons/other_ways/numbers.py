"""What the numbers and claims in this lesson's text are computed from, beside tools/course/known.py."""

from functools import cache
from itertools import combinations

import numpy as np

from bootcourse.course.lessons.other_ways import explorable, figures
from bootcourse.course.lessons.other_ways.figures import after_seconds  # noqa: F401 (for the expressions)
from bootcourse.course.lessons.other_ways.measures import worth_at_most  # noqa: F401 (for the expressions)
from bootcourse.course.lessons.your_teacher.taught_agents import p_value
from bootcourse.episodes.evaluate import held_out_seeds
from bootcourse.episodes.record import record
from bootcourse.episodes.words import overtaken
from bootcourse.learn.settings import settings_for
from bootcourse.policies import rule_policy
from bootcourse.research import equal_decisions
from bootcourse.research.beyond import at_budget
from bootcourse.research.equal_decisions import BUDGETS, by_method, tried
from bootcourse.research.results import Results
from bootcourse.scenario import DEFAULT
from bootcourse.statistics import Estimate, holm, interval
from tools.course.known import shipped_experiment

FIRST, SECOND, _ = BUDGETS
TAUGHT = tuple(figures.TAKES)  # the methods with a teacher
QUICK, SLOWER = 0.00005, 0.0001  # seconds that a decision takes beside the computing
APART = {"method", "seed", "bonus"}  # SAC has no demonstrations that a bonus could reward


@cache
def compared() -> dict[str, Results]:
    """{method: its agents} of the comparison at equal decisions."""
    return by_method(shipped_experiment("beyond"))


def later(method: str) -> Results:
    """The agents of a method in this comparison."""
    return compared()[method]


def taught_by(method: str) -> set[str]:
    """The settings of a method's agents that SAC's do not have, or have with another value."""
    agents, plain = later(method).agents[0], later("sac").agents[0]
    return {name for name in agents | plain if agents.get(name) != plain.get(name)} - APART


def at(method: str, measure: str, budget: int = FIRST) -> np.ndarray:
    """Each agent's mean return, success or accidents after so many decisions, or its seconds until then: (agents,)."""
    return equal_decisions.at(later(method), measure, budget)


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


def order(road: float) -> list[str]:
    """The five methods by what they earn in the same time where a decision takes `road` seconds, the best first."""
    returns = explorable.earned(road)
    return sorted(returns, key=returns.get, reverse=True)


def returns_on_the_road(method: str) -> np.ndarray:
    """The return in training of each agent in the time of the picture, where a decision takes a second."""
    decisions = explorable.time_for(1.0) / (1.0 + explorable.learners()[method].seconds)
    return at_budget(later(method).curves, decisions)


def on_the_road(method: str) -> Estimate:
    """Their interquartile mean, with its interval."""
    return interval(returns_on_the_road(method))


def first_may_be_chance() -> bool:
    """Whether a rank test shows no difference between the first and the second on the road."""
    return p_value(*(returns_on_the_road(method) for method in order(1.0)[:2])) > 0.05
