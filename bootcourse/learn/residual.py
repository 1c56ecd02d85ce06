"""PPO that learns a correction of the stochastic rule: residual policy learning (Silver et al., arXiv 1812.06298).

The network's logits f are added to log π̃, so π(a|s) ∝ π̃(a|s) exp f(s,a). f is 0 at first: the untrained policy is π̃,
and what is learned is where to leave it. The paper adds f to a controller's continuous action instead. An agent needs
its teacher to drive.
"""

from collections.abc import Sequence

import torch
from torch import Tensor

from bootcourse.learn import sac
from bootcourse.learn.bootstrap import log_stochastic_rule
from bootcourse.learn.networks import mlp
from bootcourse.learn.ppo import PPOLearner
from bootcourse.learn.settings import PPOSettings
from bootcourse.scenario import N_ACTIONS


class ResidualLearner(PPOLearner):
    """PPO of several agents whose policies are the stochastic rule with a learned correction."""

    needs_teacher = True

    def __init__(self, settings: Sequence[PPOSettings], observation_size: int, n_actions: int = N_ACTIONS):
        super().__init__(settings, observation_size, n_actions)
        with torch.no_grad():
            torch._foreach_zero_(self.actor[-2:])  # the last layer, so that f = 0

    def log_pi(self, states: Tensor, rule_actions: Tensor) -> Tensor:
        """log π(a|s), the logarithm of softmax(f + log π̃): (agents, batch, actions)."""
        f = mlp(self.actor, states)
        return sac.log_policy(f + log_stochastic_rule(rule_actions, self.rule_p[:, 0], f.shape[-1]))

    @torch.no_grad()
    def driving_policy(self, states: Tensor, rule_actions: Tensor) -> Tensor:
        """π(a|s), with μ(s) in it: (agents, batch, actions)."""
        return self.log_pi(states, rule_actions).exp()
