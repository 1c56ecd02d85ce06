"""Two drivers in one: in each state the rule's action or the agent's own, by their values.

IBRL, imitation-bootstrapped RL (Hu et al., arXiv 2311.02198): whichever of the rule's action μ(s) and the agent's own
action a ~ π has the higher value under the smaller of the target critics. The target uses the same choice in s', so a
state is worth what the better of the two earns there. An agent needs its teacher to drive.

Only a and μ(s) enter the choice, and π has nine actions, so its distribution is a sum that we write out instead of
drawing from it. Where we differ: the paper's imitator is a trained network, ours is the rule; the learner is discrete
SAC, without entropy in the critics' target. A trained agent takes the most probable action of this distribution.
"""

from dataclasses import replace

import torch
from torch import Tensor

from bootcourse.learn import sac
from bootcourse.learn.agent import Agent
from bootcourse.learn.learner import SACLearner
from bootcourse.learn.networks import mlp
from bootcourse.learn.protocol import of_agent
from bootcourse.learn.replay_buffer import Batch


def better_of_two(pi: Tensor, q: Tensor, rule_actions: Tensor) -> Tensor:
    """The distribution of the chosen action, (..., batch, actions).

    pi (..., batch, actions): π(a|s). q (..., batch, actions): Q(s,a). rule_actions (..., batch): μ(s). An action
    a ~ π is taken where Q(s,a) > Q(s,μ(s)); elsewhere μ(s) is.
    """
    own = pi * (q > q.gather(-1, rule_actions.unsqueeze(-1)))
    return own.scatter_add(-1, rule_actions.unsqueeze(-1), (pi - own).sum(-1, keepdim=True))


class IBRLLearner(SACLearner):
    """SAC of several agents that act, and bootstrap, with the better of the rule's action and their own."""

    needs_teacher = True

    def choice(self, states: Tensor, rule_actions: Tensor) -> tuple[Tensor, Tensor]:
        """The distribution of the chosen action, and the target critics' Q: each (agents, batch, actions)."""
        q = self.target_q(states)
        return better_of_two(mlp(self.actor, states).softmax(-1), q, rule_actions), q

    @torch.no_grad()
    def acting_policy(self, states: Tensor, rule_actions: Tensor, decided: Tensor) -> Tensor:
        """The chosen action's distribution: (agents, roads, actions)."""
        return self.choice(states, rule_actions)[0]

    @classmethod
    def driving_policy(cls, actor: list[Tensor], critics: list[Tensor], states: Tensor, rule_actions: Tensor) -> Tensor:
        """The chosen action's distribution: (agents, batch, observation), (agents, batch) -> (agents, batch, 9)."""
        return better_of_two(mlp(actor, states).softmax(-1), cls.q_values(critics, states), rule_actions)

    def critic_target(self, batch: Batch) -> Tensor:
        """y = r + γ Σ_a P(a|s') Q(s',a) with the chosen action's distribution P: (agents, batch)."""
        chosen, next_q = self.choice(batch.next_states, batch.next_rule_actions)
        return sac.critic_target(batch.rewards, batch.terminated, (chosen * next_q).sum(-1), self.gamma)

    def agent(self, i: int) -> Agent:
        """A snapshot of agent i, whose critics are the target critics, by which it chooses."""
        return replace(super().agent(i), critics=of_agent(self.target_critics, i, self.agents))
