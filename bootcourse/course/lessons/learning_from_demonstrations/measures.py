"""Measured for the lesson: who finds the way out, who escapes, whether the action with the largest Q earns more."""

from collections.abc import Sequence
from functools import cache

import numpy as np

from bootcourse.course.shipped import shipped_agents, shipped_experiment, shipped_results
from bootcourse.episodes.lookahead import imagine
from bootcourse.episodes.record import record
from bootcourse.episodes.rollout import Rollout
from bootcourse.learn.agent import Agent
from bootcourse.policies import rule_policy
from bootcourse.research.experiments.clocks import choices
from bootcourse.research.results import Results
from bootcourse.scenario import DEFAULT
from bootcourse.statistics import found_after

Kinds = dict[str, tuple[list[Results], list[Results]]]


@cache
def kinds() -> Kinds:
    """{demonstrations: (agents with the soft constraint, without it)}: the study's ten first, then the ten others."""
    study, others = shipped_results(), shipped_experiment("stress")
    free = shipped_experiment("ablations")["c = 0"]
    return {
        "demonstrations, c = 2": (
            [study.of("bootstrapped"), others["bootstrapped"]],
            [study.of("demos"), others["demos"]],
        ),
        "demonstrations, c = 0": ([free.of("bootstrapped"), others["bootstrapped, c = 0"]], [free.of("demos")]),
        "no demonstrations": ([study.of("soft"), others["soft"]], [study.of("sac"), others["sac"]]),
    }


def escape(agents: Sequence[Results]) -> str:
    """How many of these agents escape, "16 of 20"."""
    return f"{sum(each.escapers(each.methods[0]) for each in agents)} of {sum(map(len, agents))}"


def found(agents: Sequence[Results]) -> np.ndarray:
    """The training episodes after which these agents have found the way out, (agents,)."""
    return np.concatenate([found_after(each.curves["success"]) for each in agents])


def paid_and_not() -> dict[str, Results]:
    """The study's ten agents with both aids, with the bonus and without it."""
    return {name: kinds()[f"demonstrations, {name}"][0][0] for name in ("c = 2", "c = 0")}


ESCAPE = ["agents that escape (study + others)", "with the soft constraint", "without it"]


def escaped() -> list[list[str]]:
    """A row for each kind of demonstrations, below `ESCAPE`: "16 of 20 (7 + 9)"; last the stochastic rule's."""
    by_chance = choices(shipped_experiment("clocks"))["1/4", "π̃"]
    rows = kinds() | {
        "the stochastic rule's demonstrations, c = 2": ([by_chance.of("bootstrapped")], [by_chance.of("demos")])
    }
    return [[name, _all_and_parts(soft), _all_and_parts(free)] for name, (soft, free) in rows.items()]


def _all_and_parts(agents: Sequence[Results]) -> str:
    """How many of these agents escape, and how many in each part."""
    parts = " + ".join(f"{each.escapers(each.methods[0])}" for each in agents)
    return f"**{escape(agents)}** ({parts})" if len(agents) > 1 else f"**{escape(agents)}**"


SECONDS = 20  # of the drive that are looked at
ON = 40  # seconds that an agent drives on from each of them


@cache
def agents() -> list[Agent]:
    """The study's first five agents with demonstrations, the bonus and the soft constraint."""
    return shipped_agents("bootstrapped")


@cache
def demonstrated() -> Rollout:
    """The rule's drive on road 10."""
    return record(rule_policy(DEFAULT), [10], label="rule")[0]


@cache
def ahead() -> tuple[int, int, int]:
    """In how many seconds of the drive, counted for each of the five agents, another action has the largest Q than the
    demonstrated one; in how many of these it earns more; and of how many seconds.

    Each agent drives on by its own policy after either; the rewards are discounted, and those after `ON` s left out.
    """
    cars, did, others, more = demonstrated().cars[:SECONDS], demonstrated().rule_actions[:SECONDS], [], []
    for agent in agents():
        largest = agent.q_values(demonstrated().observations[:SECONDS]).argmax(1)
        both, gamma = np.stack([largest, did], axis=1), agent.settings.gamma
        worth = imagine(cars, both, agent.as_policy(), ON, DEFAULT, gamma=gamma, with_worth=False).values
        others.append(largest != did)
        more.append(worth[:, 0] > worth[:, 1] + 1e-9)
    other = np.concatenate(others)
    return int(other.sum()), int((other & np.concatenate(more)).sum()), len(other)
