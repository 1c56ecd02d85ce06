"""Behaviour cloning: an actor learns the demonstrator's actions by supervised learning, without rewards."""

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
    """Only the actors learn; all weights of the critics are zero."""

    def __init__(self, settings: Sequence[Settings], observation_size: int, n_actions: int = N_ACTIONS):
        super().__init__(settings, observation_size, n_actions)
        with torch.no_grad():
            torch._foreach_zero_([*self.critics, *self.target_critics])

    def losses(self, batch: Batch) -> dict[str, Tensor]:
        """The cross-entropy, and the policy's entropy for the curves: each (agents,)."""
        log_pi = sac.log_policy(mlp(self.actor, batch.states))  # (agents, batch, 9)
        return {"actor_loss": cloning_loss(log_pi, batch.actions), "entropy": sac.entropy(log_pi).mean(-1)}
