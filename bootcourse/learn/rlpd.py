"""RLPD, reinforcement learning with prior data (Ball et al., arXiv 2302.02948): demonstrations in every batch.

Their Algorithm 1 with discrete SAC. Half of each batch are demonstrations, from the first update to the last. They have
no bonus, and nothing else pulls towards the demonstrator. Three things keep the critics from overestimating actions
that are not in the data: layer normalisation, which bounds a critic's values by its last weights; an ensemble of
critics; and a target with the smallest value of a few of them, drawn anew for each update (REDQ, Chen et al., arXiv
2101.05982). The actor maximises the ensemble's mean. Several updates follow each decision.

Where we differ: the actor and the temperature take a step at every update, not at the last one after each decision; the
normalisation has no gain and offset of its own to learn.
"""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
import torch
import torch.nn.functional as F
from torch import Tensor

from bootcourse.errors import whole
from bootcourse.learn.learner import SACLearner
from bootcourse.learn.replay_buffer import Batch
from bootcourse.learn.settings import Settings, shared
from bootcourse.scenario import N_ACTIONS


@dataclass(frozen=True)
class RLPDSettings(Settings):
    """The settings of RLPD, whose authors have 10 critics and make 20 updates for each decision."""

    critics: int = shared(5, low=1)  # § in the ensemble
    target_critics: int = shared(2, low=1)  # ‡ of them, drawn for each update, the smallest counts; authors' code

    def __post_init__(self):
        super().__post_init__()
        whole(self.target_critics, "target_critics", self.critics)


def normalised_mlp(parameters: Sequence[Tensor], x: Tensor) -> Tensor:
    """`mlp` with each hidden layer's outputs normalised before the ReLU: (n, batch, inputs) -> (n, batch, outputs)."""
    for weight, bias in zip(parameters[:-2:2], parameters[1:-2:2], strict=True):
        hidden = torch.baddbmm(bias, x, weight)
        x = F.layer_norm(hidden, hidden.shape[-1:]).relu()
    return torch.baddbmm(parameters[-1], x, parameters[-2])


def smallest_of(q: Tensor, chosen: Tensor) -> Tensor:
    """The smallest value of the chosen critics, (agents, batch, actions).

    q (critics, agents, batch, actions); chosen (agents, k): the numbers of each agent's critics.
    """
    return q[chosen.T, torch.arange(q.shape[1])].amin(0)


class RLPDLearner(SACLearner):
    """SAC of several agents with ensembles of normalised critics. "pair" means the whole ensemble here."""

    settings: list[RLPDSettings]
    critic_network = staticmethod(normalised_mlp)

    def __init__(self, settings: Sequence[RLPDSettings], observation_size: int, n_actions: int = N_ACTIONS):
        super().__init__(settings, observation_size, n_actions)
        self.updates_made = torch.zeros((), dtype=torch.int64)

    @staticmethod
    def n_critics(settings: RLPDSettings) -> int:
        """The size of the ensemble."""
        return settings.critics

    @staticmethod
    def one_q(q: Tensor) -> Tensor:
        """The mean of the critics, which the actor maximises: (critics, agents, batch, 9) -> (agents, batch, 9)."""
        return q.mean(0)

    def target_q(self, states: Tensor) -> Tensor:
        """The smallest value of the target critics that this update draws: (agents, batch, 9)."""
        return smallest_of(self.q_pair(self.target_critics, states), self.drawn_critics())

    def drawn_critics(self) -> Tensor:
        """The critics in the present update's target, (agents, target_critics): by seed and update, so that a resumed
        training draws the same."""
        shared, update = self.settings[0], int(self.updates_made)
        rngs = [np.random.default_rng([s.seed, 2, update]) for s in self.settings]
        draws = [rng.choice(shared.critics, shared.target_critics, replace=False) for rng in rngs]
        return torch.from_numpy(np.stack(draws))

    def update(self, batch: Batch) -> dict[str, Tensor]:
        """One gradient step of all agents. Returns `losses`, each (agents,)."""
        terms = super().update(batch)
        self.updates_made += 1
        return terms

    def tensors(self) -> dict[str, list[Tensor]]:
        """SAC's tensors, and the number of updates."""
        return super().tensors() | {"updates_made": [self.updates_made]}
