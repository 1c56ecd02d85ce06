"""Behaviour cloning and DAgger: an actor learns the teacher's actions by supervised learning, without rewards.

A clone learns what the demonstrator did in its own states. With DAgger (Ross, Gordon & Bagnell, arXiv 1011.0686) the
actor drives, and the teacher says what it would have done in the states that the actor reaches. There are no critics
and no temperature.
"""

from collections.abc import Sequence

import numpy as np
import torch
from torch import Tensor

from bootcourse.learn import sac
from bootcourse.learn.agent import Agent
from bootcourse.learn.networks import init_mlp, mlp
from bootcourse.learn.protocol import adam, check_shared, generators_of, of_agent, total_loss
from bootcourse.learn.replay_buffer import Batch, ReplayBuffer
from bootcourse.learn.settings import Settings
from bootcourse.scenario import N_ACTIONS


def cloning_loss(log_pi: Tensor, expert_actions: Tensor) -> Tensor:
    """Mean over the batch of -log π(a_E|s), the cross-entropy (Pomerleau 1991).

    log_pi (..., batch, actions), expert_actions (..., batch) -> (...).
    """
    return -log_pi.gather(-1, expert_actions.unsqueeze(-1)).squeeze(-1).mean(-1)


class BCLearner:
    """The actors of several agents. See `Learner` for what each method does."""

    needs_teacher = False
    device = torch.device("cpu")

    def __init__(self, settings: Sequence[Settings], observation_size: int, n_actions: int = N_ACTIONS):
        self.settings, self.agents = check_shared(settings), len(settings)
        shared = self.settings[0]
        self.actor = init_mlp((observation_size, *shared.hidden, n_actions), generators_of(settings))
        self.optimiser = adam((self.actor, shared.actor_lr))

    @staticmethod
    def n_critics(settings: Settings) -> int:
        return 0

    def make_buffer(self, observation_size: int, demonstrations: Tensor | None) -> ReplayBuffer:
        return ReplayBuffer(self.agents, self.settings[0].buffer_size, observation_size, demonstrations, self.device)

    def updates_due(self, replay: ReplayBuffer, decisions: int) -> int:
        return self.settings[0].updates if decisions >= self.settings[0].learning_starts else 0

    def update(self, batch: Batch) -> dict[str, Tensor]:
        """One gradient step of all actors. Returns `losses` before the step, each (agents,)."""
        terms = self.losses(batch)
        self.optimiser.zero_grad()
        total_loss(terms).backward()
        self.optimiser.step()
        return {name: values.detach() for name, values in terms.items()}

    def losses(self, batch: Batch) -> dict[str, Tensor]:
        """The cross-entropy, and the policy's entropy for the curves: each (agents,)."""
        log_pi = sac.log_policy(mlp(self.actor, batch.states))  # (agents, batch, 9)
        return {"actor_loss": cloning_loss(log_pi, self.labels(batch)), "entropy": sac.entropy(log_pi).mean(-1)}

    def labels(self, batch: Batch) -> Tensor:
        """The actions to learn: those that were done, (agents, batch)."""
        return batch.actions

    @torch.no_grad()
    def probabilities(self, states: Tensor) -> Tensor:
        """π(a|s): (agents, batch, observation) -> (agents, batch, actions)."""
        return mlp(self.actor, states).softmax(-1)

    def acting_policy(self, states: Tensor, rule_actions: Tensor, decided: Tensor) -> Tensor:
        return self.probabilities(states)

    def note_episodes(self, ended: np.ndarray, returns: np.ndarray) -> None:
        """Cloning has no use for whole episodes."""

    def coefficients(self) -> dict[str, np.ndarray]:
        return {"alpha": np.zeros(self.agents), "xi": np.zeros(self.agents)}

    @classmethod
    def driving_policy(cls, actor: list[Tensor], critics: list[Tensor], states: Tensor, rule_actions: Tensor) -> Tensor:
        return mlp(actor, states).softmax(-1)

    def agent(self, i: int) -> Agent:
        return Agent(self.settings[i], of_agent(self.actor, i, self.agents), critics=[], alpha=0.0)

    def tensors(self) -> dict[str, list[Tensor]]:
        return {"actor": self.actor}


class DAggerLearner(BCLearner):
    """Half of a batch are the teacher's drives, half the actor's own; all are labelled with the teacher's action μ(s).

    The paper lets the teacher drive a share of the first episodes, too; here its demonstrations stand for them.
    """

    def labels(self, batch: Batch) -> Tensor:
        """The actions to learn: the teacher's, also in states where the actor drove, (agents, batch)."""
        return batch.rule_actions
