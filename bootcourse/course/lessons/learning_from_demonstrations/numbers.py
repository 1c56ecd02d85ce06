"""What the numbers and claims in this lesson's text are computed from, beside tools/course/known.py."""

from functools import cache

import numpy as np

from bootcourse.course.lessons.learning_from_demonstrations import measures
from bootcourse.course.lessons.learning_from_demonstrations.measures import ahead as ahead
from bootcourse.course.lessons.learning_from_demonstrations.measures import held as held
from bootcourse.course.lessons.learning_from_demonstrations.measures import kinds
from bootcourse.course.lessons.learning_from_demonstrations.measures import leashes as leashes
from bootcourse.course.lessons.learning_from_demonstrations.measures import lost_by as lost_by
from bootcourse.course.lessons.soft_constraint.examples import fast_and_rule, reward_and_kl
from bootcourse.episodes.record import record
from bootcourse.panels.bonus import bonus_numbers
from bootcourse.policies import idle_policy, rule_policy
from bootcourse.research.results import Results
from bootcourse.scenario import DEFAULT
from bootcourse.statistics import lost
from tools.course.known import SETTINGS, by_rule, clocks, idle, others, shipped_results


def _with(name: str) -> tuple[list[Results], list[Results]]:
    """One of `kinds`, by its last word: "c = 2", "c = 0" or "none".

    Or the study's ten with the "margin".
    """
    if name == "margin":
        return [shipped_results().of("margin_soft")], [shipped_results().of("margin")]
    return kinds()["no demonstrations" if name == "none" else f"demonstrations, {name}"]


def in_all(name: str) -> str:
    """ "16 of 20": how many agents with the soft constraint and these demonstrations escape."""
    return measures.escape(_with(name)[0])


def of_the_study(name: str) -> str:
    """How many of the study's ten agents with the soft constraint and these demonstrations escape."""
    return measures.escape(_with(name)[0][:1])


def alone(name: str) -> str:
    """How many agents escape with these demonstrations and without the soft constraint."""
    return measures.escape(_with(name)[1])


def find_alone(name: str) -> str:
    """How many agents find the way out with these demonstrations and without the soft constraint."""
    return measures.find(_with(name)[1])


def found(name: str) -> np.ndarray:
    """The training episodes after which the agents with the soft constraint have found the way out, (agents,)."""
    return measures.found(_with(name)[0])


def median_found(name: str) -> int:
    """The median of `found`, a half rounded up."""
    return int(np.median(found(name)) + 0.5)


def training(name: str, curve: str, first: int, last: int | None, others: bool = False) -> np.ndarray:
    """The mean of the study's ten agents in some training episodes, (agents,), or of the ten others."""
    return _with(name)[0][int(others)].curves[curve][:, first:last].mean(axis=1)


def losing_until(name: str, episode: int) -> int:
    """How many of the twenty agents with the soft constraint have lost the way out by this training episode."""
    return sum(lost_by(each, episode) for each in _with(name)[0])


def paid_for_ever_others() -> Results:
    """The ten others with the soft constraint and demonstrations in all their training."""
    return others("bootstrapped, β for ever")


def losers(agents: Results) -> int:
    """How many of these agents lose the way out at least once in their training."""
    return int(lost(agents.curves["success"]).sum())


def of_the_stochastic_rule(method: str) -> Results:
    """Ten agents of a method whose demonstrations the stochastic rule drove, as in the paper, else as in the study."""
    return clocks()["1/4", "π̃"].of(method)


def updates_ratio() -> int:
    """How many times as many updates for a decision the agents of the setting "2" make as the study's."""
    often, seldom = (
        a["updates"] / a["envs_per_agent"]
        for a in (clocks()["2", "π̃"].of("demos").agents[0], clocks()["1/4", "π̃"].of("demos").agents[0])
    )
    return round(often / seldom)


def fast_pays_more() -> float:
    """How much more a second of the soft constraint's fast agents pays than one of the rule's, on the free road."""
    fast, rule = (reward_and_kl(drives)[0] for drives in fast_and_rule().values())
    return fast - rule


def bonus_needed() -> np.ndarray:
    """The smallest c with which the rest of the rule's drive is worth more than staying behind, in each second."""
    return bonus_numbers(by_rule(), idle(), SETTINGS).crossing


@cache
def needed_on(roads: int = 40, seconds: int = 40) -> np.ndarray:
    """The same on the first roads, in the first seconds: (roads, seconds)."""
    pairs = zip(*(record(driver, range(roads)) for driver in (rule_policy(DEFAULT), idle_policy)), strict=True)
    return np.array([bonus_numbers(*pair, SETTINGS).crossing[:seconds] for pair in pairs])
