"""Policies: functions that decide on an action for each road.

policy(observations (roads, 26), cars (roads, vehicles, 10)) -> PolicyOutput. A trained agent uses the observations,
the rule uses the cars, which are the true state (off the trap, the observations again). A policy with internal state
also has a method `reset(roads)`, which `episodes/driving.py` calls before each episode. Those of this library can be
copied and pickled, so that another process drives with them.
"""

import inspect
import itertools
from collections.abc import Callable, Sequence
from functools import partial
from typing import NamedTuple

import numpy as np

from bootcourse.errors import BootcourseError, check_known
from bootcourse.rule import rule, sample_stochastic_rule, stochastic_rule
from bootcourse.scenario import ACTION_NAMES, IDLE, N_ACTIONS, RULE_P, Scenario


class PolicyOutput(NamedTuple):
    """The action on each road; π and Q of policies that have them, None for others."""

    actions: np.ndarray  # (roads,) int, 0..8
    policy: np.ndarray | None = None  # (roads, 9) probabilities π(a|s)
    q_values: np.ndarray | None = None  # (roads, 9) Q(s, a)


Policy = Callable[[np.ndarray, np.ndarray], PolicyOutput]


def check_policy(policy: Policy) -> Policy:
    """The policy itself. Raises BootcourseError for an agent, for a rule, and for what is no function."""
    if hasattr(policy, "as_policy"):
        raise BootcourseError("An agent cannot drive by itself: give its policy, agent.as_policy().")
    try:
        signature = inspect.signature(policy)
        signature.bind(None, None)
        drives = next(iter(signature.parameters)) != "cars"  # the first argument of a rule
    except (TypeError, ValueError):  # no function, or one of other arguments
        drives = False
    if not drives:
        raise BootcourseError(
            f"policy = {policy!r:.80} cannot drive: give a function of (observations, cars), such as agent.as_policy() "
            "or, for a rule, teacher_policy(my_rule)."
        )
    return policy


def idle_policy(observations: np.ndarray, cars: np.ndarray) -> PolicyOutput:
    """The idle policy: 0 m/s², 0 rad (action 4) on each road."""
    return PolicyOutput(np.full(len(observations), IDLE))


def rule_policy(scenario: Scenario) -> Policy:
    """The rule controller μ (Section III-D, Algorithm 1) as a policy for roads of a scenario."""
    return policy_of(partial(_rule_actions, scenario))


def _rule_actions(scenario: Scenario, cars: np.ndarray) -> np.ndarray:
    return rule(cars, scenario).actions


def _decided(decide: Callable[[np.ndarray], np.ndarray], observations: np.ndarray, cars: np.ndarray) -> PolicyOutput:
    return PolicyOutput(decide(cars))


def policy_of(decide: Callable[[np.ndarray], np.ndarray]) -> Policy:
    """A rule for all roads as a policy: decide, cars (roads, vehicles, 10) -> actions (roads,)."""
    return partial(_decided, decide)


def stochastic_rule_policy(scenario: Scenario, rng: np.random.Generator, p: float = RULE_P) -> Policy:
    """The stochastic rule π̃ (Equation 16) as a policy: each action is drawn from π̃ with `rng`.

    p: the probability of the rule's action; each other has (1 - p) / 8. The policy raises BootcourseError, when
    called, if p is outside [1/9, 1).
    """
    return stochastic_policy(partial(_rule_actions, scenario), rng, p)


def stochastic_policy(
    decide: Callable[[np.ndarray], np.ndarray], rng: np.random.Generator, p: float = RULE_P, n_actions: int = N_ACTIONS
) -> Policy:
    """The same for any rule: decide, cars (roads, vehicles, 10) -> actions (roads,)."""
    return partial(_drawn, decide, rng, p, n_actions)


def _drawn(decide, rng, p, n_actions, observations: np.ndarray, cars: np.ndarray) -> PolicyOutput:
    actions = decide(cars)
    drawn = sample_stochastic_rule(actions, p, rng, n_actions)
    return PolicyOutput(drawn, stochastic_rule(actions, p, n_actions))


def random_policy(rng: np.random.Generator, n_actions: int = N_ACTIONS) -> Policy:
    """The uniformly random policy: each of the nine actions has probability 1/9, drawn with `rng`."""
    return partial(_uniform, rng, n_actions)


def _uniform(rng, n_actions, observations: np.ndarray, cars: np.ndarray) -> PolicyOutput:
    shape = len(observations), n_actions
    return PolicyOutput(rng.integers(n_actions, size=len(observations)), np.full(shape, 1 / n_actions))


class PlanPolicy:
    """A policy that takes the given actions in order, one per decision, and idles after the last.

    actions: int, 0..8, (decisions,) for all roads alike or (decisions, roads). In your own loop, call `reset(roads)`
    before each episode.
    """

    def __init__(self, actions: Sequence[int] | np.ndarray):
        self.actions, self.decision = np.asarray(actions, dtype=np.int64), 0

    def reset(self, roads: int) -> None:
        """Restart the plan. Raises BootcourseError if `actions` are for another number of roads."""
        if self.actions.ndim == 2 and self.actions.shape[1] != roads:
            raise BootcourseError(
                f"There are plans for {self.actions.shape[1]} roads, not for {roads}: give one plan for each road, "
                "in the same order."
            )
        self.decision = 0

    def __call__(self, observations: np.ndarray, cars: np.ndarray) -> PolicyOutput:
        now = self.actions[self.decision] if self.decision < len(self.actions) else IDLE
        self.decision += 1
        return PolicyOutput(np.full(len(observations), now))


def plan_policy(plan: Sequence[str | tuple[str, int]]) -> PlanPolicy:
    """A policy from a plan in words, such as ["keep straight", ("accelerate left", 2)]; after it the policy idles.

    Each entry is one of `ACTION_NAMES`, or (name, decisions). Raises BootcourseError for an unknown action.
    """
    actions = []
    for entry in plan:
        name, times = (entry, 1) if isinstance(entry, str) else entry
        check_known("Action", name, ACTION_NAMES)
        actions += [ACTION_NAMES.index(name)] * times
    return PlanPolicy(actions)


def in_words(actions: Sequence[int]) -> list[tuple[str, int]]:
    """Actions (decisions,) as a plan in words, [(name, decisions), ...]: the inverse of `plan_policy`."""
    return [(ACTION_NAMES[action], len(list(run))) for action, run in itertools.groupby(actions)]
