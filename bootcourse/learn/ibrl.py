"""Two drivers in one: in each state the rule's action or the agent's own, by their values.

IBRL, imitation-bootstrapped RL (Hu et al., arXiv 2311.02198): whichever of the rule's action μ(s) and the agent's own
action a ~ π has the higher value under the smaller of the target critics. The target uses the same choice in s', so a
state is worth what the better of the two earns there. PEX, policy expansion (Zhang et al., arXiv 2302.00935): one of
the two is drawn from the softmax of their values. An agent needs its teacher to drive.

Only a and μ(s) enter the choice, and π has nine actions, so its distribution is a sum that we write out instead of
drawing from it. Where we differ: the papers' imitators are trained networks, ours is the rule; the learner is discrete
SAC, without entropy in the critics' target; PEX bootstraps as it acts, as IBRL's soft variant does, where its paper
learns values by IQL. A trained agent takes the most probable action of this distribution.
"""

from collections.abc import Sequence
from dataclasses import replace

import torch
from torch import Tensor

from bootcourse.learn import sac
from bootcourse.learn.agent import Agent
from bootcourse.learn.learner import SACLearner
from bootcourse.learn.networks import mlp
from bootcourse.learn.replay_buffer import Batch
from bootcourse.learn.settings import PEXSettings
from bootcourse.scenario import N_ACTIONS


def advantage(q: Tensor, rule_actions: Tensor) -> Tensor:
    """Q(s,a) - Q(s,μ(s)): q (..., batch, actions), rule_actions (..., batch) -> (..., batch, actions)."""
    return q - q.gather(-1, rule_actions.unsqueeze(-1))


def expanded_policy(pi: Tensor, own: Tensor, rule_actions: Tensor) -> Tensor:
    """The distribution of the chosen action, (..., batch, actions).

    pi (..., batch, actions): π(a|s). own (..., batch, actions): with which probability the agent's own action is
    taken if it is a. rule_actions (..., batch): μ(s), taken otherwise.
    """
    taken = pi * own
    return taken.scatter_add(-1, rule_actions.unsqueeze(-1), (pi - taken).sum(-1, keepdim=True))


class IBRLLearner(SACLearner):
    """SAC of several agents that act, and bootstrap, with the better of the rule's action and their own."""

    needs_teacher = True

    def own_share(self, advantage: Tensor) -> Tensor:
        """The probability of the agent's own action, by its advantage over the rule's: 1 if that is above 0, else 0."""
        return (advantage > 0).float()

    def choice(self, states: Tensor, rule_actions: Tensor) -> tuple[Tensor, Tensor]:
        """The distribution of the chosen action, and the target critics' Q: each (agents, batch, actions)."""
        q = self.target_q(states)
        pi = mlp(self.actor, states).softmax(-1)
        return expanded_policy(pi, self.own_share(advantage(q, rule_actions)), rule_actions), q

    @torch.no_grad()
    def driving_policy(self, states: Tensor, rule_actions: Tensor) -> Tensor:
        """The chosen action's distribution: (agents, batch, observation), (agents, batch) -> (agents, batch, 9)."""
        return self.choice(states, rule_actions)[0]

    def critic_target(self, batch: Batch) -> Tensor:
        """y = r + γ Σ_a P(a|s') Q(s',a) with the chosen action's distribution P: (agents, batch)."""
        chosen, next_q = self.choice(batch.next_states, batch.next_rule_actions)
        return sac.critic_target(batch.rewards, batch.terminated, (chosen * next_q).sum(-1), self.gamma)

    def agent(self, i: int) -> Agent:
        """A snapshot of agent i, whose critics are the target critics, by which it chooses."""
        critics = [parameter.detach()[i :: self.agents].clone().cpu() for parameter in self.target_critics]
        return replace(super().agent(i), critics=critics)


class PEXLearner(IBRLLearner):
    """The same with a softmax over the two values instead of the higher one."""

    def __init__(self, settings: Sequence[PEXSettings], observation_size: int, n_actions: int = N_ACTIONS):
        super().__init__(settings, observation_size, n_actions)
        self.choice_temperature = torch.tensor([s.choice_temperature for s in settings])[:, None, None]

    def own_share(self, advantage: Tensor) -> Tensor:
        """The own action's part of the softmax over two values: σ((Q(s,a) - Q(s,μ(s))) / temperature)."""
        return (advantage / self.choice_temperature).sigmoid()
