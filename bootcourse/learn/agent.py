"""A trained agent: its networks and its policy."""

from dataclasses import dataclass

import numpy as np
import torch
from torch import Tensor

from bootcourse.errors import BootcourseError
from bootcourse.learn import sac
from bootcourse.learn.networks import mlp
from bootcourse.learn.settings import Settings
from bootcourse.policies import Policy, PolicyOutput


@dataclass(frozen=True)
class Agent:
    """The weights of one agent, with an agents axis of length 1 (see networks.py)."""

    settings: Settings
    actor: list[Tensor]  # weights and biases, [(1, inputs, outputs), (1, 1, outputs), ...]
    critics: list[Tensor]  # those of the two critics, [(2, inputs, outputs), (2, 1, outputs), ...]
    alpha: float  # the entropy coefficient at the end of the training

    @torch.no_grad()
    def probabilities(self, observations: np.ndarray) -> np.ndarray:
        """π(a|s): (batch, observation) -> (batch, 9). Raises BootcourseError for observations of another size."""
        size, given = self.actor[0].shape[1], np.shape(observations)[-1]
        if size != given:
            raise BootcourseError(f"This agent observes {size} numbers, not {given}: drive the scenario it trained on.")
        return mlp(self.actor, torch.as_tensor(observations, dtype=torch.float32)[None])[0].softmax(-1).numpy()

    @torch.no_grad()
    def q_values(self, observations: np.ndarray) -> np.ndarray:
        """The smaller of the two critics' Q(s,a): (batch, observation) -> (batch, 9)."""
        states = torch.as_tensor(observations, dtype=torch.float32)[None]
        return sac.min_q(mlp(self.critics, states.repeat(2, 1, 1))).numpy()

    def as_policy(self, rng: np.random.Generator | None = None, with_q: bool = False) -> Policy:
        """The agent as a policy: its most probable action or, with an rng, an action drawn from π.

        with_q: whether the policy's outputs contain Q.
        """

        def drive(observations, cars):
            pi = self.probabilities(observations)
            actions = pi.argmax(-1) if rng is None else sample_actions(pi, rng.random(len(pi)))
            return PolicyOutput(actions, pi, self.q_values(observations) if with_q else None)

        return drive


def sample_actions(pi: np.ndarray, uniforms: np.ndarray) -> np.ndarray:
    """An action from each distribution, by inverse transform sampling: (..., 9), (...) in [0, 1) -> (...)."""
    cumulative = pi.cumsum(-1)
    return (cumulative[..., :-1] <= (uniforms * cumulative[..., -1])[..., None]).sum(-1)
