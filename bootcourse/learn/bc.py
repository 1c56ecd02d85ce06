"""Behaviour cloning and DAgger: an actor learns the teacher's actions by supervised learning, without rewards.

A clone learns what the demonstrator did in its own states. With DAgger (Ross, Gordon & Bagnell, arXiv 1011.0686) the
actor drives, and the teacher says what it would have done in the states that the actor reaches. There are no critics
and no temperature.
"""

from collections.abc import Sequence

from torch import Tensor

from bootcourse.learn import sac
from bootcourse.learn.networks import init_mlp, mlp
from bootcourse.learn.protocol import Learner, adam, check_shared, generators_of, total_loss
from bootcourse.learn.replay_buffer import Batch
from bootcourse.learn.settings import Settings
from bootcourse.scenario import N_ACTIONS


def cloning_loss(log_pi: Tensor, expert_actions: Tensor) -> Tensor:
    """Mean over the batch of -log π(a_E|s), the cross-entropy (Pomerleau 1991).

    log_pi (..., batch, actions), expert_actions (..., batch) -> (...).
    """
    return -log_pi.gather(-1, expert_actions.unsqueeze(-1)).squeeze(-1).mean(-1)


class BCLearner(Learner):
    """The actors of several agents."""

    def __init__(self, settings: Sequence[Settings], observation_size: int, n_actions: int = N_ACTIONS):
        self.settings, self.agents = check_shared(settings), len(settings)
        shared = self.settings[0]
        self.actor = init_mlp((observation_size, *shared.hidden, n_actions), generators_of(settings))
        self.optimiser = adam((self.actor, shared.actor_lr))

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


class DAggerLearner(BCLearner):
    """Half of a batch are the teacher's drives, half the actor's own; all are labelled with the teacher's action μ(s).

    The paper lets the teacher drive a share of the first episodes, too; here its demonstrations stand for them.
    """

    def labels(self, batch: Batch) -> Tensor:
        """The actions to learn: the teacher's, also in states where the actor drove, (agents, batch)."""
        return batch.rule_actions
