"""PPO with a KL to the stochastic rule that fades as the agent succeeds: kickstarting (arXiv 1803.03835).

The loss is PPO's plus λ KL(π̃ ‖ π). λ falls with the agent's success or with its episodes. QDagger (arXiv 2206.01626)
takes max(1 - G/G_T, 0) instead, from the returns of agent and teacher; we take the share of episodes in which the ego
overtakes, and a start λ₀. The soft constraint of Equation 15 is the other direction, KL(π ‖ π̃). There are no
demonstrations, and the rule is not needed to drive.
"""

import numpy as np
import torch
from torch import Tensor

from bootcourse.learn.bootstrap import demonstration_share, kl_from_rule
from bootcourse.learn.ppo import Minibatch, PPOLearner


def kl_weight_at(success: np.ndarray, start: float) -> np.ndarray:
    """λ = λ₀ max(1 - success, 0): (agents,) -> (agents,).

    success: share of the last episodes in which the ego overtook, 0 to 1; NaN, before the first episode, counts as 0.
    """
    return start * np.maximum(1 - np.nan_to_num(success), 0)


class KickstartLearner(PPOLearner):
    """PPO whose actor loss contains the KL to the stochastic rule; `xi` (agents, 1) is its present weight λ."""

    def note_temperature(self) -> None:
        """Set `xi` to λ, from the curves of the training."""
        super().note_temperature()
        shared = self.settings[0]
        if self.curves is None:  # before the training begins
            weight = np.full(self.agents, shared.kl_weight)
        elif shared.kl_episodes:
            weight = demonstration_share(self.curves.finished, shared.kl_weight, shared.kl_episodes)
        else:
            weight = kl_weight_at(self.curves.recent("success"), shared.kl_weight)
        self.xi = torch.from_numpy(weight).float()[:, None].to(self.device)

    def policy_loss(self, log_pi: Tensor, batch: Minibatch) -> Tensor:
        """The clipped objective plus λ KL(π̃ ‖ π): log_pi (agents, batch, 9) -> (agents,)."""
        kl = kl_from_rule(log_pi, batch.rule_actions, self.rule_p[:, 0])
        return super().policy_loss(log_pi, batch) + self.xi[:, 0] * kl.mean(-1)
