"""Jump-start RL (Uchendu et al., arXiv 2204.02372): the teacher drives the first h decisions of each training episode.

Their Algorithm 1 with discrete SAC as the learner. The teacher takes the agent to places that it would not reach alone,
and the agent learns what to do from there on. As soon as the combined driver's return is about as good as the best
before, h shrinks by a step, until the agent drives alone. A trained agent drives alone.

Where our curriculum differs: the paper judges h by a moving average over evaluations, which are episodes of their own.
We judge it by the training episodes that began with it, in which the agent's actions are drawn from π. Our mean begins
again after each step, and the agent learns from nothing but these episodes, the teacher's part of them included.
"""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
import torch
import torch.nn.functional as F
from torch import Tensor

from bootcourse.learn.learner import SACLearner
from bootcourse.learn.settings import Settings, shared
from bootcourse.scenario import N_ACTIONS


@dataclass(frozen=True)
class JSRLSettings(Settings):
    """The settings of jump-start RL."""

    guide_decisions: int = shared(60, low=0)  # § h at first: the rule is ahead of trap 1 after a median of 54 s
    stages: int = shared(10, low=1)  # § in how many equal steps h shrinks to 0
    window: int = shared(20, low=1)  # § episodes in the moving average of returns
    tolerance: float = shared(0.05, low=0)  # § β: how far this average may lie below the best, as a share of it


def guide_decisions(stage: int, stages: int, longest: int) -> int:
    """h after `stage` of `stages` steps, from `longest` down to 0 in equal steps."""
    return round(longest * (1 - stage / stages))


def holds(mean: float, best: float, tolerance: float) -> bool:
    """Is a mean return at most a share `tolerance` of |best| below the best so far, which may be this mean itself?"""
    best = max(mean, best)
    return mean >= best - tolerance * abs(best)


class JSRLLearner(SACLearner):
    """SAC of several agents, each with a curriculum of its own."""

    settings: list[JSRLSettings]

    def __init__(self, settings: Sequence[JSRLSettings], observation_size: int, n_actions: int = N_ACTIONS):
        super().__init__(settings, observation_size, n_actions)
        shared, self.n_actions = self.settings[0], n_actions
        self.stage = torch.zeros(self.agents, dtype=torch.int64)
        self.guided = torch.full((self.agents, shared.envs_per_agent), shared.guide_decisions)  # h of each episode
        self.returns = torch.zeros(self.agents, shared.window, dtype=torch.float64)  # the last ones, oldest first
        self.counted = torch.zeros(self.agents, dtype=torch.int64)  # episodes with the present h
        self.best = torch.full((self.agents,), -torch.inf, dtype=torch.float64)  # highest mean of `window` returns

    @torch.no_grad()
    def acting_policy(self, states: Tensor, rule_actions: Tensor, decided: Tensor) -> Tensor:
        """The teacher's action for the first h decisions of an episode, then π(a|s): (agents, roads, actions)."""
        guide = F.one_hot(rule_actions, self.n_actions).float()
        return torch.where((decided < self.guided).unsqueeze(-1), guide, self.probabilities(states))

    def note_episodes(self, ended: np.ndarray, returns: np.ndarray) -> None:
        """Judge the curriculum by each ended episode that began with the present h: both (agents, roads)."""
        for agent, road in np.argwhere(ended):
            if self.guided[agent, road] == self.present_guide(agent):
                self.judge(agent, returns[agent, road])
            self.guided[agent, road] = self.present_guide(agent)

    def present_guide(self, agent: int) -> int:
        """h of the agent's next episode."""
        return guide_decisions(int(self.stage[agent]), self.settings[0].stages, self.settings[0].guide_decisions)

    def judge(self, agent: int, total: float) -> None:
        """Count an episode's return, and take the next step if the mean of the last `window` holds."""
        shared = self.settings[0]
        self.returns[agent] = self.returns[agent].roll(-1)
        self.returns[agent, -1] = total
        self.counted[agent] += 1
        if self.counted[agent] < shared.window:
            return
        if self.stage[agent] < shared.stages and self.shrinks(agent):
            self.stage[agent] += 1
            self.counted[agent] = 0
        self.best[agent] = torch.maximum(self.returns[agent].mean(), self.best[agent])

    def shrinks(self, agent: int) -> bool:
        """Whether the mean of the agent's last `window` returns holds."""
        return holds(float(self.returns[agent].mean()), float(self.best[agent]), self.settings[0].tolerance)

    def tensors(self) -> dict[str, list[Tensor]]:
        """SAC's tensors and the curricula."""
        return super().tensors() | {"curriculum": [self.stage, self.guided, self.returns, self.counted, self.best]}
