"""Who can drive: anything that turns what is seen into a `PolicyOutput` for each road.

A driver is a callable: driver(observations (roads, 26), cars (roads, vehicles, 10)) -> PolicyOutput. A
learned agent uses the observations, the rule uses the cars. `bootcourse.learn` adds agents.
"""

import itertools
from collections.abc import Callable, Sequence
from typing import NamedTuple

import numpy as np

from bootcourse.errors import BootcourseError, did_you_mean
from bootcourse.rule import rule, sample_stochastic_rule, stochastic_rule
from bootcourse.scenario import ACTION_NAMES, IDLE, N_ACTIONS, RULE_P, Scenario


class PolicyOutput(NamedTuple):
    """What a driver does on each road, and what it thought, where it thinks in such terms."""

    actions: np.ndarray  # (roads,) int, 0..8
    policy: np.ndarray | None = None  # (roads, 9) probabilities π(a|s)
    q_values: np.ndarray | None = None  # (roads, 9) Q(s, a)


Policy = Callable[[np.ndarray, np.ndarray], PolicyOutput]


def idle_policy(observations: np.ndarray, cars: np.ndarray) -> PolicyOutput:
    """Neither accelerates nor steers."""
    return PolicyOutput(np.full(len(observations), IDLE))


def rule_policy(scenario: Scenario) -> Policy:
    """The rule controller μ."""
    return lambda observations, cars: PolicyOutput(rule(cars, scenario).actions)


def stochastic_rule_policy(scenario: Scenario, rng: np.random.Generator, p: float = RULE_P) -> Policy:
    """The stochastic rule π̃: draws its action."""

    def drive(observations, cars):
        rule_actions = rule(cars, scenario).actions
        return PolicyOutput(sample_stochastic_rule(rule_actions, p, rng), stochastic_rule(rule_actions, p))

    return drive


def random_policy(rng: np.random.Generator) -> Policy:
    """Every action with the same probability."""
    return lambda observations, cars: PolicyOutput(
        rng.integers(N_ACTIONS, size=len(observations)), np.full((len(observations), N_ACTIONS), 1 / N_ACTIONS)
    )


def plan_policy(plan: Sequence[str | tuple[str, int]]) -> Policy:
    """Drives a plan written in words, then idles: ["keep straight", ("accelerate left", 2)].

    Each entry is one of `ACTION_NAMES`, for one decision or as many as you say. A plan drives once.
    Raises BootcourseError for an unknown action.
    """
    actions = []
    for entry in plan:
        name, times = (entry, 1) if isinstance(entry, str) else entry
        if name not in ACTION_NAMES:
            raise BootcourseError(f"Action {did_you_mean(name, ACTION_NAMES)}.")
        actions += [ACTION_NAMES.index(name)] * times
    coming = iter(actions)
    return lambda observations, cars: PolicyOutput(np.full(len(observations), next(coming, IDLE)))


def in_words(actions: Sequence[int]) -> list[tuple[str, int]]:
    """The plan that a sequence of actions is: (name, times), the opposite of `plan_policy`."""
    return [(ACTION_NAMES[action], len(list(run))) for action, run in itertools.groupby(actions)]
