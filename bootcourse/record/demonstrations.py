"""Any drives as demonstrations: yours, an agent's, the rule's. A `Rollout` knows all that a `Replay` asks for.

`bootcourse.learn.demonstrations` lets the rule drive its own; here are those that somebody else drove.
"""

from collections.abc import Sequence

import numpy as np
import torch
from torch import Tensor

from bootcourse.errors import BootcourseError
from bootcourse.learn.replay import Replay, pack
from bootcourse.learn.train import Training
from bootcourse.record.rollout import Rollout
from bootcourse.rule import rule


def demonstration_rows(rollouts: Sequence[Rollout]) -> Tensor:
    """Rows for a `Replay`, (transitions, row): one for each decision of the drives, in their order.

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
    return pack(seen[:-1], seen[1:], rollout.actions, rollout.rewards, terminated, mu[:-1], mu[1:])


def bootstrap_with(training: Training, rollouts: Sequence[Rollout]) -> Training:
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
    training.replay = Replay(training.n_agents, shared.capacity, training.scenario.observation_size, rows)
    return training
