"""A trained agent: its networks and its policy."""

from collections.abc import Callable
from dataclasses import dataclass, replace
from functools import partial
from typing import Any

import numpy as np
import torch
from torch import Tensor

from bootcourse.errors import BootcourseError
from bootcourse.learn.settings import Settings
from bootcourse.methods import METHODS
from bootcourse.policies import Policy, PolicyOutput


@dataclass(frozen=True)
class Agent:
    """The weights of one agent, with an agents axis of length 1 (see networks.py)."""

    settings: Settings
    actor: list[Tensor]  # weights and biases, [(1, inputs, outputs), (1, 1, outputs), ...]
    critics: list[Tensor]  # those of the critics, mostly two, [(2, inputs, outputs), (2, 1, outputs), ...]; or none, []
    alpha: float  # the entropy coefficient at the end of the training; 0 for a method without one
    teach: Callable[[np.ndarray], np.ndarray] | None = None  # μ, for a method that drives with it: see `taught_by`
    learner: type | None = None  # the class of its learner, if it is your own; None: that of its method

    @property
    def kind(self) -> type[Any]:
        """The class of its learner, which says how its networks decide."""
        return self.learner or METHODS[self.settings.method].learner_class()

    @property
    def needs_teacher(self) -> bool:
        """Whether the agent needs its teacher to drive."""
        return self.kind.needs_teacher

    def taught_by(self, teach: Callable[[np.ndarray], np.ndarray]) -> "Agent":
        """The agent with a teacher (see `teachers.teacher_of`): cars (roads, vehicles, 10) -> μ(s) (roads,)."""
        return replace(self, teach=teach)

    @torch.no_grad()
    def probabilities(self, observations: np.ndarray, rule_actions: np.ndarray | None = None) -> np.ndarray:
        """π(a|s): (batch, observation) -> (batch, 9). rule_actions μ(s), (batch,), for a method that drives with them.

        Raises BootcourseError for observations of another size, or if μ(s) is missing.
        """
        size, given = self.actor[0].shape[1], np.shape(observations)[-1]
        if size != given:
            there = "the scenario it trained on, or give make_env=, its environment"
            raise BootcourseError(f"This agent observes {size} numbers, not {given}: drive {there}.")
        if rule_actions is None and self.needs_teacher:
            raise BootcourseError(f"Method '{self.settings.method}' decides with its teacher's actions: give them.")
        rule_actions = np.zeros(len(observations)) if rule_actions is None else rule_actions
        states, taught = _tensor(observations, torch.float32), _tensor(rule_actions, torch.int64)
        return self.kind.driving_policy(self.actor, self.critics, states, taught)[0].numpy()

    @torch.no_grad()
    def q_values(self, observations: np.ndarray) -> np.ndarray | None:
        """Q(s,a), mostly the smaller of two critics': (batch, observation) -> (batch, 9); None without critics."""
        states = _tensor(observations, torch.float32)
        return self.kind.q_values(self.critics, states)[0].numpy() if self.critics else None

    def as_policy(self, rng: np.random.Generator | None = None, with_q: bool = False) -> Policy:
        """The agent as a policy: its most probable action or, with an rng, an action drawn from π.

        with_q: whether the policy's outputs contain Q, if the agent has critics. Raises BootcourseError if the agent
        lacks its teacher.
        """
        if self.needs_teacher and self.teach is None:
            raise BootcourseError(f"Method '{self.settings.method}' drives with its teacher: give it by `taught_by`.")
        return partial(self._drive, rng, with_q)

    def _drive(self, rng, with_q: bool, observations: np.ndarray, cars: np.ndarray) -> PolicyOutput:
        pi = self.probabilities(observations, self.teach(cars) if self.needs_teacher else None)
        actions = pi.argmax(-1) if rng is None else sample_actions(pi, rng.random(len(pi)))
        return PolicyOutput(actions, pi, self.q_values(observations) if with_q else None)


def _tensor(values: np.ndarray, kind: torch.dtype) -> Tensor:
    """The values with an agents axis of length 1 in front."""
    return torch.as_tensor(values, dtype=kind)[None]


def sample_actions(pi: np.ndarray, uniforms: np.ndarray) -> np.ndarray:
    """An action from each distribution, by inverse transform sampling: (..., 9), (...) in [0, 1) -> (...)."""
    cumulative = pi.cumsum(-1)
    return (cumulative[..., :-1] <= (uniforms * cumulative[..., -1])[..., None]).sum(-1)
