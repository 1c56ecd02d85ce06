"""Conservative Q-learning (Kumar et al., arXiv 2006.04779): it lowers the value of actions that are not in the data.

`cql` is the usual form for discrete actions (their Section 3.4, d3rlpy, Tianshou): double Q-learning with the
conservative term CQL(H). It trains no actor; its policy is softmax(Q/α) with a small fixed α, almost greedy.

`cql_sac` adds the same term to discrete SAC's critics: a `SACLearner` with `cql_weight` above 0. With α decreasing as
in the paper, its actor becomes deterministic before the critics have learned, and the target uses that actor.
"""

from collections.abc import Sequence

import torch
from torch import Tensor

from bootcourse.learn import sac
from bootcourse.learn.learner import SACLearner
from bootcourse.learn.replay_buffer import Batch
from bootcourse.learn.settings import Settings
from bootcourse.scenario import N_ACTIONS


def greedy_value(q: Tensor, q_next: Tensor) -> Tensor:
    """Double Q-learning's value Q_next(s, argmax_a Q(s,a)) (arXiv 1509.06461): (..., actions) twice -> (...)."""
    return q_next.gather(-1, q.argmax(-1, keepdim=True)).squeeze(-1)


class CQLLearner(SACLearner):
    """Twin critics with the conservative term; the actor is the first critic, divided by α."""

    def __init__(self, settings: Sequence[Settings], observation_size: int, n_actions: int = N_ACTIONS):
        super().__init__(settings, observation_size, n_actions)
        self.copy_critic_to_actor()

    def critic_target(self, batch: Batch) -> Tensor:
        """Double Q-learning's target, without entropy or KL: (agents, batch)."""
        next_q = sac.min_q(self.q_pair(self.target_critics, batch.next_states))  # (agents, batch, 9)
        next_value = greedy_value(self.q_pair(self.critics, batch.next_states)[0], next_q)
        return sac.critic_target(batch.rewards, batch.terminated, next_value, self.gamma)

    def losses(self, batch: Batch) -> dict[str, Tensor]:
        """The critics' squared errors and the weighted conservative term: each (agents,)."""
        with torch.no_grad():
            target = self.critic_target(batch)  # (agents, batch)
        q_pair = self.q_pair(self.critics, batch.states)  # (2, agents, batch, 9)
        error = self.squared_error(q_pair, batch.actions, target)
        conservative = self.cql_weight[:, 0] * self.conservative_loss(q_pair, batch.actions)
        return {"critic_loss": error, "conservative_loss": conservative}

    def update(self, batch: Batch) -> dict[str, Tensor]:
        """One gradient step of the critics, which also sets the actor. Returns `losses`, each (agents,)."""
        terms = super().update(batch)
        self.copy_critic_to_actor()
        return terms

    @torch.no_grad()
    def copy_critic_to_actor(self) -> None:
        """Set the actor to π = softmax(Q₁/α): the first critic's weights, with the last layer divided by α."""
        first = [parameter[: self.agents] for parameter in self.critics]
        alpha = self.log_alpha.exp()[:, None, None]
        for actor, critic in zip(self.actor, [*first[:-2], first[-2] / alpha, first[-1] / alpha], strict=True):
            actor.copy_(critic)
