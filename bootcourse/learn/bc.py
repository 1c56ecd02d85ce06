"""Behaviour cloning: do what the demonstrator did. The simplest of imitators; nothing is rewarded."""

from collections.abc import Sequence

import torch
from torch import Tensor

from bootcourse.learn import sac
from bootcourse.learn.learner import SACLearner
from bootcourse.learn.networks import mlp
from bootcourse.learn.replay_buffer import Batch
from bootcourse.learn.settings import Settings
from bootcourse.scenario import N_ACTIONS


def cloning_loss(log_pi: Tensor, expert_actions: Tensor) -> Tensor:
    """Mean over the batch of -log π(a_E|s), the cross-entropy (Pomerleau 1991).

    log_pi (..., batch, actions), expert_actions (..., batch) -> (...).
    """
    return -log_pi.gather(-1, expert_actions.unsqueeze(-1)).squeeze(-1).mean(-1)


class BCLearner(SACLearner):
    """Actors that are trained to repeat the batch. Nothing is valued, so their critics are zero."""

    def __init__(self, settings: Sequence[Settings], observation_size: int, n_actions: int = N_ACTIONS):
        super().__init__(settings, observation_size, n_actions)
        with torch.no_grad():
            torch._foreach_zero_([*self.critics, *self.target_critics])

    def update(self, batch: Batch) -> dict[str, Tensor]:
        """One step on every agent's own batch. Returns what a curve shows, each (agents,)."""
        log_pi = sac.log_policy(mlp(self.actor, batch.states))
        loss = cloning_loss(log_pi, batch.actions)
        self.optimiser.zero_grad()
        loss.sum().backward()
        self.optimiser.step()
        return {"actor_loss": loss.detach(), "entropy": sac.entropy(log_pi).detach().mean(-1)}
