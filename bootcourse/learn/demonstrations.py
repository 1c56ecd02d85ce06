"""Demonstrations: a teacher's drives (Section IV-B), by name and as rows for a `ReplayBuffer`."""

from collections.abc import Callable, Sequence
from dataclasses import dataclass, fields
from itertools import pairwise
from typing import Any

import numpy as np
import torch
from gymnasium.vector import VectorEnv
from torch import Tensor

from bootcourse.episodes.driving import one_episode_each, steps
from bootcourse.episodes.rollout import Rollout
from bootcourse.errors import BootcourseError, require
from bootcourse.learn.replay_buffer import encode_transitions
from bootcourse.learn.settings import Settings
from bootcourse.learn.teachers import Rule, all_roads, course_rule, teacher_of
from bootcourse.policies import Policy, PolicyOutput, stochastic_policy
from bootcourse.scenario import DEFAULT, N_ACTIONS, Scenario

FIRST_SEED = 2**34  # seed of the first demonstration's road; training and held-out roads have other seeds


@dataclass(frozen=True)
class Demonstrations:
    """Whole drives by name, one after the other. Every array has a row for each of the n transitions."""

    observations: np.ndarray  # (n, observation) float32, s
    actions: np.ndarray  # (n,) int64, a
    rewards: np.ndarray  # (n,) float64, r
    next_observations: np.ndarray  # (n, observation) float32, s'; of a drive's last transition, what it ended with
    terminated: np.ndarray  # (n,) bool: the drive ended here in an accident or another terminal state
    truncated: np.ndarray  # (n,) bool: its time was over here
    rule_actions: np.ndarray  # (n,) int64, the teacher's μ(s); zeros without a teacher
    next_rule_actions: np.ndarray  # (n,) int64, μ(s')
    seeds: tuple[int, ...] = ()  # of each drive's road; () where they are not known

    def __post_init__(self):
        sizes = {field.name: len(getattr(self, field.name)) for field in fields(self) if field.name != "seeds"}
        require(len({*sizes.values()}) == 1, f"These arrays differ in length, {sizes}: give as many of each.")
        require(len(self) > 0 and self.is_end[-1], "The last drive has no end: give whole drives, at least one.")

    def __len__(self) -> int:
        return len(self.actions)

    @property
    def is_end(self) -> np.ndarray:
        """Whether a drive ends with a transition, (n,) bool."""
        return self.terminated | self.truncated

    @property
    def drives(self) -> list[slice]:
        """The transitions of each drive."""
        ends = np.flatnonzero(self.is_end) + 1
        return [slice(int(begin), int(end)) for begin, end in pairwise([0, *ends])]

    def rows(self) -> Tensor:
        """As rows for a `ReplayBuffer`, (n, row): what learners use."""
        return encode_transitions(
            self.observations, self.next_observations, self.actions, self.rewards, self.terminated,
            self.rule_actions, self.next_rule_actions,
        )  # fmt: skip


def demonstrate(
    episodes: int = 200,
    scenario: Scenario | None = DEFAULT,
    policy: Policy | None = None,
    teacher: Rule | None = course_rule,
    make_env: Callable[[int], VectorEnv] | None = None,
    first_seed: int = FIRST_SEED,
) -> Demonstrations:
    """Drive whole episodes: `Demonstrations`, one drive after the other, on the roads first_seed, first_seed + 1 ...

    policy: the driver, by default the teacher; teacher: the rule whose actions are μ(s) and μ(s'), zeros for None.
    make_env: makes a vector environment of n copies, by default the trap; with another, scenario is None.
    The default driver is deterministic. (The paper runs the 0.9-stochastic rule and says that every demonstration
    escapes; at one decision per second both cannot be true, because its random steering takes the car off the road.
    For the stochastic rule give `stochastic_rule_policy`.)
    """
    env, mu = one_episode_each(episodes, scenario, make_env), None
    space: Any = env.single_action_space
    teach = teacher_of(teacher or no_teacher, scenario, int(space.n))

    def follow_teacher(observations, cars):
        return PolicyOutput(teach(cars) if mu is None else mu)  # mu was computed after the last step

    decisions, roads = [], []
    for step in steps(policy or follow_teacher, env, first_seed):
        if mu is None:
            mu = teach(step.cars)
        next_mu = teach(step.next_cars)
        columns = (
            step.observations, step.output.actions, step.rewards, step.next_observations,
            step.terminated, step.truncated, mu, next_mu,
        )  # fmt: skip
        decisions.append([np.asarray(column)[step.running] for column in columns])
        roads.append(np.flatnonzero(step.running))
        mu = next_mu
    by_drive = np.argsort(np.concatenate(roads), kind="stable")
    arrays = (np.concatenate(column)[by_drive] for column in zip(*decisions, strict=True))
    roads_driven = tuple(range(first_seed, first_seed + episodes))
    return Demonstrations(*arrays, seeds=roads_driven)  # type: ignore[misc, arg-type]


def collect(
    episodes: int = 200,
    scenario: Scenario | None = DEFAULT,
    policy: Policy | None = None,
    teacher: Rule | None = course_rule,
    make_env: Callable[[int], VectorEnv] | None = None,
    first_seed: int = FIRST_SEED,
) -> Tensor:
    """What `demonstrate` drives with these arguments, as rows for a `ReplayBuffer`: (transitions, row).

    In the order of the decisions: the first of every drive, then the second of those that go on, and so forth.
    """
    driven = demonstrate(episodes, scenario, policy, teacher, make_env, first_seed)
    decision = np.concatenate([np.arange(drive.stop - drive.start) for drive in driven.drives])
    return driven.rows()[np.argsort(decision, kind="stable")]


@all_roads
def no_teacher(states: np.ndarray, *_) -> np.ndarray:
    """The teacher's actions in the rows if there is no teacher: zeros, which the methods without a teacher ignore."""
    return np.zeros(len(states), dtype=np.int64)


def demonstration_rows(rollouts: Sequence[Rollout], teacher: Rule = course_rule) -> Tensor:
    """Rows for a `ReplayBuffer` from recorded drives: (transitions, row), in their order.

    Only a drive that ended in an accident is terminated. Raises BootcourseError for no drive, or for drives of
    different scenarios.
    """
    if not rollouts:
        raise BootcourseError("There is no demonstration: drive one first.")
    if any(rollout.scenario != rollouts[0].scenario for rollout in rollouts):
        raise BootcourseError("These demonstrations are of different scenarios: keep those of one.")
    return torch.cat([_rows(rollout, teacher) for rollout in rollouts])


def _rows(rollout: Rollout, teacher: Rule) -> Tensor:
    decisions, per_decision = len(rollout.actions), rollout.scenario.clock.steps
    at = np.minimum(np.arange(decisions + 1) * per_decision, len(rollout.states) - 1)
    mu = teacher_of(teacher, rollout.scenario)(np.ascontiguousarray(rollout.states[at]))
    terminated = np.zeros(decisions)
    terminated[-1] = rollout.accident != 0
    seen = rollout.observations
    return encode_transitions(seen[:-1], seen[1:], rollout.actions, rollout.rewards, terminated, mu[:-1], mu[1:])


def demonstrations_for(
    settings: Sequence[Settings],
    given: Sequence[Rollout] | Demonstrations | Tensor | None,
    teacher: Rule | None,
    scenario: Scenario | None = DEFAULT,
    make_env: Callable[[int], VectorEnv] | None = None,
    n_actions: int = N_ACTIONS,
) -> Tensor | None:
    """The rows that agents with these settings train with, (transitions, row); None if no agent needs any.

    given: recorded drives, `Demonstrations` or rows, instead of the teacher's. Raises BootcourseError if no agent uses
    them, if they are of another scenario, and if the teacher is missing.
    """
    shared = settings[0]
    if not any(s.needs_demonstrations for s in settings):
        require(given is None, f"Method '{shared.method}' uses no demonstrations: choose one that does.")
        return None
    if isinstance(given, Demonstrations):
        return given.rows()
    if isinstance(given, Tensor):
        return given
    if given is not None:
        is_here = not given or given[0].scenario == scenario
        require(is_here, "The demonstrations are of another scenario: train with their scenario.")
        return demonstration_rows(given, teacher)
    missing = f"Method '{shared.method}' needs demonstrations of this environment: give them, or teacher=my_rule."
    require(teacher is not None, missing)
    policy = None
    if shared.stochastic_demonstrations:
        require(
            len({s.rule_p for s in settings}) == 1,
            "Agents that train side by side share their demonstrations, so with stochastic_demonstrations "
            "they need the same rule_p: train these apart.",
        )
        decide = teacher_of(teacher, scenario, n_actions)
        policy = stochastic_policy(decide, np.random.default_rng(0), shared.rule_p, n_actions)
    return collect(shared.demonstration_episodes, scenario, policy, teacher, make_env)
