"""Demonstrations: a teacher's transitions as rows for a `ReplayBuffer` (Section IV-B)."""

from collections.abc import Callable, Sequence

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


def collect(
    episodes: int = 200,
    scenario: Scenario | None = DEFAULT,
    policy: Policy | None = None,
    teacher: Rule | None = course_rule,
    make_env: Callable[[int], VectorEnv] | None = None,
    first_seed: int = FIRST_SEED,
) -> Tensor:
    """Rows for a `ReplayBuffer` from whole episodes: (transitions, row).

    policy: the driver, by default the teacher; teacher: the rule whose actions are μ(s) and μ(s') in the rows, zeros
    for None. make_env: makes a vector environment of n copies, by default the trap; with another, scenario is None.
    The default driver is deterministic. (The paper runs the 0.9-stochastic rule and says that every demonstration
    escapes; at one decision per second both cannot be true, because its random steering takes the car off the road.
    For the stochastic rule give `stochastic_rule_policy`.)
    """
    env = one_episode_each(episodes, scenario, make_env)
    rows, mu = [], None
    teach = teacher_of(teacher or no_teacher, scenario, int(env.single_action_space.n))

    def follow_teacher(observations, cars):
        return PolicyOutput(teach(cars) if mu is None else mu)  # mu was computed after the last step

    for step in steps(policy or follow_teacher, env, first_seed):
        if mu is None:
            mu = teach(step.cars)
        next_mu = teach(step.next_cars)
        seen = step.observations, step.next_observations
        each = encode_transitions(*seen, step.output.actions, step.rewards, step.terminated, mu, next_mu)
        rows.append(each[step.running])
        mu = next_mu
    return torch.cat(rows)


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
    given: Sequence[Rollout] | Tensor | None,
    teacher: Rule | None,
    scenario: Scenario | None = DEFAULT,
    make_env: Callable[[int], VectorEnv] | None = None,
    n_actions: int = N_ACTIONS,
) -> Tensor | None:
    """The rows that agents with these settings train with, (transitions, row); None if no agent needs any.

    given: recorded drives, or rows, instead of the teacher's. Raises BootcourseError if no agent uses them, if they are
    of another scenario, and if the teacher is missing.
    """
    shared = settings[0]
    if not any(s.needs_demonstrations for s in settings):
        require(given is None, f"Method '{shared.method}' uses no demonstrations: choose one that does.")
        return None
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
