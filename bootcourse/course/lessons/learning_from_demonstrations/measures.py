"""Measured for the lesson: what a bonus pays, what critics think of demonstrated actions, who finds the way out."""

from collections.abc import Mapping, Sequence
from typing import NamedTuple

import numpy as np

from bootcourse.episodes.evaluate import evaluate
from bootcourse.episodes.rollout import Rollout
from bootcourse.learn.agent import Agent
from bootcourse.learn.settings import settings_for
from bootcourse.panels.bonus import bonus_numbers
from bootcourse.policies import rule_policy
from bootcourse.research.experiment import Computed
from bootcourse.research.results import Results
from bootcourse.scenario import DEFAULT
from bootcourse.statistics import found_after

PAID = ["c", "the rule's drive", "staying behind"]


def paid(by_rule: Rollout, stays: Rollout, bonuses: Sequence[float]) -> list[list[str]]:
    """The discounted returns of both drives with each bonus, rows below `PAID`."""
    seen = {c: bonus_numbers(by_rule, stays, settings_for("bootstrapped", bonus=c)) for c in bonuses}
    return [[f"{c:g}", f"{each.augmented[0]:.2f}", f"{each.trapped[0]:.2f}"] for c, each in seen.items()]


def smallest_bonus(by_rule: Sequence[Rollout], stays: Sequence[Rollout]) -> float:
    """The c above which each of the rule's drives is worth more than the other on its road, in each second."""
    pairs = zip(by_rule, stays, strict=True)
    return max(float(bonus_numbers(*pair, settings_for("bootstrapped")).crossing.max()) for pair in pairs)


class Opinion(NamedTuple):
    """What a critic thinks of the actions, a mean over some states."""

    shown: float  # the Q of the demonstrated action
    best: float  # the largest Q of the others
    mean: float  # the others' mean


def opinions(agents: Sequence[Agent], drives: Sequence[Rollout], seconds: int) -> dict[str, Opinion]:
    """{"c = 2, seed 0": what the agent's critic thinks in the first seconds of these drives}."""
    states = np.concatenate([drive.observations[:seconds] for drive in drives])
    did = np.concatenate([drive.rule_actions[:seconds] for drive in drives])
    named = {f"c = {each.settings.bonus:g}, seed {each.settings.seed}": each.q_values(states) for each in agents}
    return {name: _opinion(q, did) for name, q in named.items()}


def _opinion(q: np.ndarray, did: np.ndarray) -> Opinion:
    """Of the Q of each action, (states, actions), and the number of the demonstrated one, (states,)."""
    shown = np.arange(q.shape[1]) == did[:, None]
    others = q[~shown].reshape(len(q), -1)
    return Opinion(*(float(each.mean()) for each in (q[shown], others.max(axis=1), others)))


def raised(critics: Mapping[str, Opinion]) -> list[float]:
    """By how much the bonus raises the lead over the best other action: of two critics with it and two without."""
    leads = [each.shown - each.best for each in critics.values()]
    return [leads[0] - leads[2], leads[1] - leads[3]]


NAMES = {  # of the methods with the soft constraint
    "bootstrapped": "demonstrations, c = 2",
    "margin_soft": "demonstrations, margin",
    "soft": "no demonstrations",
}
DRIVEN = ["on 200 roads", "success, %", "return"]


def driven(agents: Sequence[Agent]) -> list[list[str]]:
    """How these agents and the rule drive on 200 roads, rows below `DRIVEN`."""
    drivers = [(NAMES[agent.settings.method], agent.as_policy()) for agent in agents]
    rows = []
    for name, driver in [*drivers, ("the rule", rule_policy(DEFAULT))]:
        seen = evaluate(driver, 200, seed=8)
        rows.append([name, f"{100 * seen.success.value:.0f}", f"{seen.returns.value:.0f}"])
    return rows


Kinds = dict[str, tuple[list[Results], list[Results]]]


def kinds(study: Results, changed: Computed, others: Computed) -> Kinds:
    """{demonstrations: (agents with the soft constraint, without it)}: the study's ten first, then the ten others."""
    free = changed["c = 0"]
    return {
        "demonstrations, c = 2": (
            [study.of("bootstrapped"), others["bootstrapped"]],
            [study.of("demos"), others["demos"]],
        ),
        "demonstrations, c = 0": ([free.of("bootstrapped"), others["bootstrapped, c = 0"]], [free.of("demos")]),
        "demonstrations, margin": ([study.of("margin_soft")], [study.of("margin")]),
        "no demonstrations": ([study.of("soft"), others["soft"]], [study.of("sac"), others["sac"]]),
    }


def escape(agents: Sequence[Results]) -> str:
    """How many of these agents escape, "16 of 20"."""
    return f"{sum(each.escapers(each.methods[0]) for each in agents)} of {sum(map(len, agents))}"


def found(agents: Sequence[Results]) -> np.ndarray:
    """The training episodes after which these agents have found the way out, (agents,)."""
    return np.concatenate([found_after(each.curves["success"]) for each in agents])


FOUND = ["", "KL: found after (median; all)", "KL: escape", "KL: return (study; others)"]
FOUND += ["no KL: escape, study", "no KL: escape, others"]


def found_and_escaped(agents: Kinds) -> list[list[str]]:
    """A row for each kind of demonstrations, below `FOUND`: the returns are means of all agents."""
    rows = []
    for name, (soft, free) in agents.items():
        after = found(soft)
        words = f"{np.median(after):.0f}; {after.min()} to {after.max()}"
        alone = [escape([each]) for each in free]
        earn = "; ".join([f"{each.scores('returns').mean():.0f}" for each in soft] + ["–"] * (2 - len(soft)))
        rows.append([name, words, escape(soft), earn, *alone, *["–"] * (2 - len(alone))])
    return rows
