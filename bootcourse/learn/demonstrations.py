"""Demonstrations: what the rule drove, as transitions for the replay (Section IV-B)."""

from collections.abc import Sequence

import numpy as np
import torch
from gymnasium.vector import AutoresetMode
from torch import Tensor

from bootcourse.episodes.rollout import Rollout
from bootcourse.errors import BootcourseError
from bootcourse.learn.replay_buffer import ReplayBuffer, encode_transitions
from bootcourse.policies import Policy, rule_policy
from bootcourse.road.vector_env import TrapVectorEnv
from bootcourse.rule import rule
from bootcourse.scenario import DEFAULT, Scenario

FIRST_SEED = 2**34  # of the demonstrations' roads; training and held-out roads have other seeds


def collect(episodes: int = 200, scenario: Scenario = DEFAULT, driver: Policy | None = None) -> Tensor:
    """Rows for a `ReplayBuffer` from `episodes` episodes: (transitions, row).

    The demonstrator executes the rule's own action unless another driver is given. (The paper runs
    the 0.9-stochastic rule, and says that every demonstration escapes: at one decision a second its
    random steering knocks the car off the road, so the two cannot both be. Both can be had here.)
    """
    driver = driver or rule_policy(scenario)
    env = TrapVectorEnv(episodes, scenario, AutoresetMode.DISABLED)
    states, _ = env.reset(seed=FIRST_SEED)
    rule_actions = rule(env.cars, scenario).actions
    awake = np.ones(episodes, dtype=bool)
    rows = []
    while awake.any():
        actions = driver(states, env.cars).actions
        next_states, rewards, terminated, truncated, _ = env.step(actions)
        next_rule_actions = rule(env.cars, scenario).actions
        rows.append(
            encode_transitions(states, next_states, actions, rewards, terminated, rule_actions, next_rule_actions)[
                awake
            ]
        )
        awake &= ~(terminated | truncated)
        states, rule_actions = next_states, next_rule_actions
    return torch.cat(rows)


def demonstration_rows(rollouts: Sequence[Rollout]) -> Tensor:
    """Rows for a `ReplayBuffer`, (transitions, row): one for each decision of the drives, in their order.

    A drive that ended without an accident was not terminated: its last state still has a future.
    Raises BootcourseError for no drive, or drives of different scenarios.
    """
    if not rollouts:
        raise BootcourseError("There is no demonstration: drive one first.")
    if any(rollout.scenario != rollouts[0].scenario for rollout in rollouts):
        raise BootcourseError("These demonstrations are of different scenarios: keep those of one.")
    return torch.cat([_rows(rollout) for rollout in rollouts])


def _rows(rollout: Rollout) -> Tensor:
    decisions, steps = len(rollout.actions), rollout.scenario.clock.steps
    at = np.minimum(np.arange(decisions + 1) * steps, len(rollout.states) - 1)
    mu = rule(np.ascontiguousarray(rollout.states[at]), rollout.scenario).actions
    terminated = np.zeros(decisions)
    terminated[-1] = rollout.accident != 0
    seen = rollout.observations
    return encode_transitions(seen[:-1], seen[1:], rollout.actions, rollout.rewards, terminated, mu[:-1], mu[1:])


def bootstrap_with(training, rollouts: Sequence[Rollout]):
    """Let a training that has not begun learn from these demonstrations instead of the rule's. Returns it.

    The KL still pulls towards the rule. Raises BootcourseError if the training has begun, uses no
    demonstrations, or is of another scenario.
    """
    rows = demonstration_rows(rollouts)
    if training.decisions:
        raise BootcourseError("This training has begun already: give a new one its demonstrations.")
    if not any(settings.needs_demonstrations for settings in training.settings):
        raise BootcourseError(f"Method '{training.settings[0].method}' uses no demonstrations: choose one that does.")
    if rollouts[0].scenario != training.scenario:
        raise BootcourseError("These demonstrations are of another scenario than this training: train on theirs.")
    shared = training.settings[0]
    training.replay = ReplayBuffer(training.n_agents, shared.buffer_size, training.scenario.observation_size, rows)
    return training
