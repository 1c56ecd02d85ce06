"""Measured for the lesson: who finds the way out, who escapes, how long the bonus holds, what the largest Q earns."""

from collections.abc import Sequence
from functools import cache
from typing import NamedTuple

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
from bootcourse.statistics import found_after, lost

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


ESCAPE = ["agents", "with the soft constraint: find the way", "escape", "without it: find the way", "escape"]


def escaped() -> list[list[str]]:
    """A row for each kind of demonstrations, below `ESCAPE`; last the stochastic rule's.

    Of each group who find the way out in training, and who escape after it: "16 of 20 (7 + 9)".
    """
    by_chance = choices(shipped_experiment("clocks"))["1/4", "π̃"]
    rows = kinds() | {
        "the stochastic rule's demonstrations, c = 2": ([by_chance.of("bootstrapped")], [by_chance.of("demos")])
    }
    return [
        [name, find(soft), _all_and_parts(soft), find(free), _all_and_parts(free)]
        for name, (soft, free) in rows.items()
    ]


def find(agents: Sequence[Results]) -> str:
    """How many of these agents find the way out in training, "12 of 20"."""
    return f"{(found(agents) > 0).sum()} of {sum(map(len, agents))}"


def _all_and_parts(agents: Sequence[Results]) -> str:
    """How many of these agents escape, and how many in each part."""
    parts = " + ".join(f"{each.escapers(each.methods[0])}" for each in agents)
    return f"**{escape(agents)}** ({parts})" if len(agents) > 1 else f"**{escape(agents)}**"


LEASH = ["demonstrations", "return, episodes 500 to 600", "lose the way out by episode 900"]


@cache
def leashes() -> dict[str, Results]:
    """{until when demonstrations are in the batches: the study's ten agents with both aids}; last without the bonus."""
    changed = shipped_experiment("ablations")
    return {
        "until episode 300, c = 2": changed["β over 300 episodes"].of("bootstrapped"),
        "until episode 1,000, c = 2": shipped_results().of("bootstrapped"),
        "for ever, c = 2": changed["β for ever"].of("bootstrapped"),
        "for ever, c = 0": changed["β for ever, c = 0"].of("bootstrapped"),
    }


def held(agents: Results) -> tuple[float, int]:
    """These agents' mean return in the episodes 500 to 600, and how many lose the way out in training."""
    return float(agents.curves["return"][:, 500:600].mean()), int(lost(agents.curves["success"]).sum())


def lost_by(agents: Results, episode: int) -> int:
    """How many of these agents lose the way out by a training episode."""
    return int(lost(agents.curves["success"][:, :episode]).sum())


def leash_rows() -> list[list[str]]:
    """A row for each of `leashes`, below `LEASH`."""
    rows = ((name, held(agents)[0], lost_by(agents, 900), len(agents)) for name, agents in leashes().items())
    return [[name, f"{paid:.0f}", f"{losers} of {count}"] for name, paid, losers, count in rows]


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


class Ahead(NamedTuple):
    """Another action than the demonstrated one has the largest Q: how often, and what it earns."""

    seconds: int  # of the drive, counted for each of the five agents
    others: int  # of these another action has the largest Q
    more: int  # of these it earns more
    at_random: float  # how often any other action than the demonstrated one earns more, a share
    promised: float  # by how much its Q leads that of the demonstrated action, the mean
    paid: float  # how much more it earns, the mean


@cache
def ahead() -> Ahead:
    """What becomes of the action with the largest Q in the drive.

    Each agent drives on by its own policy after each action; the rewards are discounted, those after `ON` s left out.
    """
    cars, did, at = demonstrated().cars[:SECONDS], demonstrated().rule_actions[:SECONDS], np.arange(SECONDS)
    any_other, leads = [], []
    for agent in agents():
        q, gamma = np.asarray(agent.q_values(demonstrated().observations[:SECONDS])), agent.settings.gamma
        each = np.tile(np.arange(q.shape[1]), (SECONDS, 1))
        worth = imagine(cars, each, agent.as_policy(), ON, DEFAULT, gamma=gamma, with_worth=False).values
        ahead_by, earns = (values - values[at, did][:, None] for values in (q, worth))
        any_other.append(earns[each != did[:, None]] > 1e-9)
        largest = q.argmax(1)
        leads.append(np.stack([ahead_by[at, largest], earns[at, largest]], axis=1)[largest != did])
    promised, paid = np.concatenate(leads).T
    seconds, more = SECONDS * len(agents()), int((paid > 1e-9).sum())
    return Ahead(seconds, len(paid), more, np.concatenate(any_other).mean(), promised.mean(), paid.mean())
