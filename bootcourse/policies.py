"""Policies: functions that decide on an action for each road.

policy(observations (roads, 26), cars (roads, vehicles, 10)) -> PolicyOutput. A learned agent uses the observations,
the rule uses the cars, that is the true state. A policy that remembers something has a method `reset(roads)` too,
which the loop in `episodes/driving.py` calls before each episode. `bootcourse.learn` adds agents.
"""

import itertools
from collections.abc import Callable, Sequence
from typing import NamedTuple

import numpy as np

from bootcourse.errors import BootcourseError, did_you_mean
from bootcourse.rule import rule, sample_stochastic_rule, stochastic_rule
from bootcourse.scenario import ACTION_NAMES, IDLE, N_ACTIONS, RULE_P, Scenario


class PolicyOutput(NamedTuple):
    """The action on each road; π and Q where the policy has them."""

    actions: np.ndarray  # (roads,) int, 0..8
    policy: np.ndarray | None = None  # (roads, 9) probabilities π(a|s)
    q_values: np.ndarray | None = None  # (roads, 9) Q(s, a)


Policy = Callable[[np.ndarray, np.ndarray], PolicyOutput]


def idle_policy(observations: np.ndarray, cars: np.ndarray) -> PolicyOutput:
    """Keeps its speed and its steering straight, whatever it sees: action 4 on each road."""
    return PolicyOutput(np.full(len(observations), IDLE))


def rule_policy(scenario: Scenario) -> Policy:
    """The rule controller μ (Section III-D, Algorithm 1) as a policy on roads of a scenario."""
    return lambda observations, cars: PolicyOutput(rule(cars, scenario).actions)


def stochastic_rule_policy(scenario: Scenario, rng: np.random.Generator, p: float = RULE_P) -> Policy:
    """The stochastic rule π̃ (Equation 16) as a policy: it draws each action anew.

    rng: what it draws from. p: the probability of the rule's own action; each other has (1 - p) / 8.
    Raises BootcourseError, when it drives, if p is outside [1/9, 1).
    """

    def drive(observations, cars):
        rule_actions = rule(cars, scenario).actions
        return PolicyOutput(sample_stochastic_rule(rule_actions, p, rng), stochastic_rule(rule_actions, p))

    return drive


def random_policy(rng: np.random.Generator) -> Policy:
    """The policy that draws each action, all nine with the same probability, from `rng`."""
    return lambda observations, cars: PolicyOutput(
        rng.integers(N_ACTIONS, size=len(observations)), np.full((len(observations), N_ACTIONS), 1 / N_ACTIONS)
    )


class PlanPolicy:
    """A policy that takes given actions, one decision after the other, and idles after the last.

    actions: int, 0..8, (decisions,) for every road alike, or (decisions, roads). In a loop of your own, call
    `reset(roads)` before each episode: it begins the plan anew, and raises BootcourseError if `actions` are for
    another number of roads.
    """

    def __init__(self, actions: Sequence[int] | np.ndarray):
        self.actions, self.decision = np.asarray(actions, dtype=np.int64), 0

    def reset(self, roads: int) -> None:
        if self.actions.ndim == 2 and self.actions.shape[1] != roads:
            raise BootcourseError(
                f"There are plans for {self.actions.shape[1]} roads, and {roads} to drive: give a plan for each road, "
                "in the same order."
            )
        self.decision = 0

    def __call__(self, observations: np.ndarray, cars: np.ndarray) -> PolicyOutput:
        now = self.actions[self.decision] if self.decision < len(self.actions) else IDLE
        self.decision += 1
        return PolicyOutput(np.full(len(observations), now))


def plan_policy(plan: Sequence[str | tuple[str, int]]) -> PlanPolicy:
    """Drives a plan written in words, then idles: ["keep straight", ("accelerate left", 2)].

    Each entry is one of `ACTION_NAMES`, for one decision or as many as you say.
    Raises BootcourseError for an unknown action.
    """
    actions = []
    for entry in plan:
        name, times = (entry, 1) if isinstance(entry, str) else entry
        if name not in ACTION_NAMES:
            raise BootcourseError(f"Action {did_you_mean(name, ACTION_NAMES)}.")
        actions += [ACTION_NAMES.index(name)] * times
    return PlanPolicy(actions)


def in_words(actions: Sequence[int]) -> list[tuple[str, int]]:
    """Actions as a plan in words, (name, times): the opposite of `plan_policy`."""
    return [(ACTION_NAMES[action], len(list(run))) for action, run in itertools.groupby(actions)]
