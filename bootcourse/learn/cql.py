"""Conservative Q-learning (Kumar et al., arXiv 2006.04779): distrust every action that the data does not hold.

`cql` is the usual form for discrete actions (their Section 3.4, and d3rlpy's and Tianshou's): the
conservative term CQL(H) on top of double Q-learning. It has no actor; its policy is softmax(Q/α)
with α fixed, all but greedy, so that its episodes can be driven, drawn and saved like any other's.

`cql_sac` adds the same term to the critics of discrete SAC and keeps its actor: a `SACLearner` with
`cql_weight` above 0. With α falling as in the paper, that actor settles on one action before the
critics have learned which, and the target follows it.
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
    """Q_next(s, argmax_a Q(s,a)), double Q-learning's value (arXiv 1509.06461): (..., actions) twice -> (...)."""
    return q_next.gather(-1, q.argmax(-1, keepdim=True)).squeeze(-1)


class CQLLearner(SACLearner):
    """Twin critics that learn conservatively; the actor is the first of them, divided by α."""

    def __init__(self, settings: Sequence[Settings], observation_size: int, n_actions: int = N_ACTIONS):
        super().__init__(settings, observation_size, n_actions)
        self._act_greedily()

    def update(self, batch: Batch) -> dict[str, Tensor]:
        """One step on every agent's own batch. Returns what a curve shows, each (agents,)."""
        with torch.no_grad():
            next_q = sac.min_q(self._both(self.target_critics, batch.next_states))
            next_value = greedy_value(self._both(self.critics, batch.next_states)[0], next_q)
            target = sac.critic_target(batch.rewards, batch.terminated, next_value, self.of_agent["gamma"][:, None])
        q_pair = self._both(self.critics, batch.states)
        actions = batch.actions.expand(2, -1, -1)
        error = sac.critic_loss(q_pair.gather(-1, actions.unsqueeze(-1)).squeeze(-1), target).sum(0)
        pessimism = sac.conservative_loss(q_pair, actions).sum(0)
        self.optimiser.zero_grad()
        (error + self.of_agent["cql_weight"] * pessimism).sum().backward()
        self.optimiser.step()
        with torch.no_grad():
            torch._foreach_lerp_(self.target_critics, self.critics, self.settings[0].tau)
        self._act_greedily()
        return {"critic_loss": error.detach(), "conservative_loss": pessimism.detach()}

    @torch.no_grad()
    def _act_greedily(self) -> None:
        """π = softmax(Q₁/α): the first critic's weights, the last layer divided by α."""
        first = [parameter[: self.agents] for parameter in self.critics]
        alpha = self.log_alpha.exp()[:, None, None]
        for mine, its in zip(self.actor, [*first[:-2], first[-2] / alpha, first[-1] / alpha], strict=True):
            mine.copy_(its)
