"""What the numbers and claims in this lesson's text are computed from, beside tools/course/known.py."""

import math
from dataclasses import fields
from functools import cache
from itertools import combinations

import numpy as np
from scipy.stats import spearmanr  # noqa: F401 (for the expressions)

from bootcourse.course.lessons.other_ways import figures, measures
from bootcourse.course.lessons.other_ways.figures import hours_before  # noqa: F401 (for the expressions)
from bootcourse.course.lessons.other_ways.measures import (  # noqa: F401 (for the expressions)
    worth_at_most,
    worth_of_rule,
)
from bootcourse.course.lessons.your_teacher.taught_agents import p_value
from bootcourse.episodes.evaluate import drive_episodes, held_out_seeds  # noqa: F401 (for the expressions)
from bootcourse.episodes.record import record
from bootcourse.learn.settings import Settings, settings_for
from bootcourse.methods import METHODS, display_name  # noqa: F401 (for the expressions)
from bootcourse.policies import rule_policy
from bootcourse.research import equal_decisions
from bootcourse.research.equal_decisions import BUDGETS, by_method
from bootcourse.research.experiments.learned_model import partly_random
from bootcourse.research.results import Results
from bootcourse.research.tables import markdown
from bootcourse.road.state import EGO, TRAP_1, X
from bootcourse.scenario import DEFAULT
from bootcourse.statistics import Estimate, holm, interval, iqm
from tools.course.known import idle, shipped_experiment

FIRST, SECOND = BUDGETS[:2]
TAUGHT = tuple(figures.TAKES)  # the methods with a teacher
FIVE_SECONDS = (equal_decisions.SECONDS, measures.SECONDS)  # what a training spends, in each of two counts
ON_ROAD = (FIRST, measures.DECISIONS)
EARLY = 20_000  # decisions of each agent
SHOWS = {  # what shows the free lane to a method
    "ppo_cloned": "its first policy",
    "bootstrapped": "demonstrations, a pull",
    "jsrl": "the first seconds of each episode",
    "rlpd": "demonstrations",
    "ibrl": "demonstrations, the rule's action",
    "sac": "nothing",
    "ppo": "nothing",
}


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


@cache
def rule_is_ahead() -> float:
    """The median of the decisions after which the rule is ahead of trap 1, on 20 roads."""
    cars = [drive.cars for drive in record(rule_policy(DEFAULT), range(20))]
    return float(np.median([(each[:, EGO, X] > each[:, TRAP_1, X]).argmax() for each in cars]))


def middle(method: str) -> float:
    """The interquartile mean of these agents' returns."""
    return iqm(at(method, "returns"))


@cache
def early(method: str) -> np.ndarray:
    """How many of each agent's training drives within its first `EARLY` decisions earn more than staying, (agents,)."""
    curves = later(method).curves
    ended = np.cumsum(np.nan_to_num(curves["decisions"]), axis=1, dtype=float) <= EARLY
    return (ended & (curves["return"] > math.ceil(idle().rewards.sum()))).sum(axis=1)


def early_table() -> str:
    """What shows the free lane to each method, and these numbers of drives, as Markdown."""
    rows = []
    for method, shows in SHOWS.items():
        drives = early(method)
        rows.append([display_name(method), shows, f"{np.median(drives):.0f} ({drives.min()} to {drives.max()})"])
    return markdown(["", "what shows the free lane", "such drives of ten agents: median (least to most)"], rows)


@cache
def pairs(budget: int) -> dict[tuple[str, str], float]:
    """{a pair of the methods with a teacher: p of the rank test of their returns, after Holm}."""
    of = list(combinations([method for method in compared() if method in TAUGHT], 2))
    p = [p_value(*(at(method, "returns", budget) for method in pair)) for pair in of]
    return {pair: float(each) for pair, each in zip(of, holm(p), strict=True)}


def trained_with(method: str) -> Settings:
    """What its agents have in common."""
    return settings_for(method, **equal_decisions.COMMON[method])


def asks(method: str) -> bool:
    """Whether the rule acts in training, or is asked in the states that the agent reaches."""
    return trained_with(method).asks_teacher


def by_hand() -> dict[str, set[str]]:
    """{method with a teacher: settings that it alone has, or has otherwise than IBRL, and that no try changes}."""
    shared, names = {field.name for field in fields(Settings)}, {}
    for method in TAUGHT:
        settings, common = trained_with(method), equal_decisions.COMMON[method]
        own = {field.name for field in fields(settings)} - shared
        own |= {name for name in common if common[name] != getattr(trained_with("ibrl"), name)}
        names[method] = own - set().union(*equal_decisions.TRIES[method])
    return names


def ppo_round() -> tuple[int, int]:
    """After so many decisions an agent of PPO after cloning makes updates, and how many."""
    of = later("ppo_cloned").agents[0]
    decisions = of["envs_per_agent"] * of["horizon"]
    return decisions, of["epochs"] * decisions // of["batch"]


def accident_shares() -> np.ndarray:
    """In how many % of its drives the median agent of each method with a teacher has an accident, (methods,)."""
    return 100 * np.array([np.median(at(method, "accident")) for method in TAUGHT])


def training_scores(spent: float, count: str) -> dict[str, Estimate]:
    """{method with a teacher: the interquartile mean of its returns in training by then}."""
    return {method: interval(measures.in_training(later(method), spent, count)) for method in TAUGHT}


def by_then(method: str, seconds: float) -> float:
    """The interquartile mean of its returns in training after so many seconds of computing."""
    return iqm(measures.in_training(later(method), seconds, measures.SECONDS))


def thousands_made(method: str) -> float:
    """How many thousand decisions its training makes in five seconds of computing."""
    return equal_decisions.SECONDS * FIRST / at(method, "seconds", FIRST).mean() / 1000


def updates_in(method: str) -> int:
    """The updates of a method other than PPO in one round of PPO after cloning."""
    of = later(method).agents[0]
    return ppo_round()[0] * of["updates"] // of["envs_per_agent"]


def below_all_others(method: str, spent: float, count: str) -> bool:
    """Whether rank tests, corrected for all pairs of the five, show that it earns less in training than each other."""
    returns = {one: measures.in_training(later(one), spent, count) for one in TAUGHT}
    of = list(combinations(TAUGHT, 2))
    p = dict(zip(of, holm([p_value(returns[a], returns[b]) for a, b in of]), strict=True))
    scores = training_scores(spent, count)
    differ = all(each < 0.05 for pair, each in p.items() if method in pair)
    return differ and method == min(scores, key=lambda one: scores[one].value)


@cache
def coin_accidents(share: float) -> int:
    """The accidents in 80 drives by the rule with a share of its actions drawn at random."""
    drive = partly_random(rule_policy(DEFAULT), share, np.random.default_rng(0))
    return int((drive_episodes(drive, range(80)).accident > 0).sum())


def share_of_first(method: str, episodes: int = 80) -> float:
    """The decisions of an agent's first episodes, in % of its training until `FIRST`: the median over the agents."""
    decisions = later(method).curves["decisions"][:, :episodes].astype(float).sum(axis=1)
    return float(100 * np.median(decisions) / FIRST)
