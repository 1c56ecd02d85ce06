"""PPO for which accidents cost more: a fixed price, or one that a budget sets; and a mask against risky actions.

The price λ is the Lagrange multiplier of J_C <= d, with J_C the share of episodes that end in an accident and d the
budget: PPO-Lagrangian, with the integral control of λ in Stooke et al. (arXiv 2007.03964). λ rises while there are more
accidents and falls, to 0 at least, while there are fewer. A second value function V_C predicts accidents; the advantage
is A - λ A_C.

A share of the training episodes may begin shortly before an accident: restarts.py. V may be a distributional critic
that looks at the worst returns from a state: quantiles.py.

The mask of risk.py, or the shield of shield.py, limits π's choice where the trained agent drives; neither changes the
training. The risk's classifiers are in the place of the critics, which PPO does not have, so an agent keeps them in its
files.
"""

from collections.abc import Sequence
from typing import NamedTuple

import numpy as np
import torch
from torch import Tensor

from bootcourse.learn import sac
from bootcourse.learn.networks import init_mlp, mlp
from bootcourse.learn.ppo import PPOLearner, RolloutBuffer, agents_first
from bootcourse.learn.quantiles import mean_of_the_worst, quantile_loss
from bootcourse.learn.replay_buffer import Batch, decode_transitions
from bootcourse.learn.risk import accident_within, masked, resolved, risk_loss
from bootcourse.learn.settings import SafeSettings
from bootcourse.learn.shield import needed_braking
from bootcourse.scenario import DEFAULT, N_ACTIONS

WINDOW = 1000  # the last episodes in which accidents are counted: two of each road


def accident_rate(accident: np.ndarray, finished: np.ndarray, least: int, window: int = WINDOW) -> np.ndarray:
    """J_C, the share of each agent's last episodes that ended in an accident, (agents,).

    accident (agents, episodes), the number of an `Accident`; finished (agents,) episodes. NaN before `least` episodes,
    because the first to end are those with an accident; the last rate that is recorded if there are more.
    """
    ends = np.minimum(finished, accident.shape[1])
    last = [its[max(0, n - window) : n] for its, n in zip(accident, ends, strict=True)]
    return np.array([np.mean(each > 0) if len(each) >= least else np.nan for each in last])


def multiplier_step(multiplier: Tensor, rate: Tensor, budget: Tensor, step: Tensor) -> Tensor:
    """λ <- max(0, λ + η (J_C - d)), all (agents, 1); a rate that is NaN changes nothing."""
    return (multiplier + step * torch.nan_to_num(rate - budget)).clamp(min=0)


class SafeMinibatch(NamedTuple):
    """A `Minibatch` and what the accidents teach, each (agents, batch, ...)."""

    states: Tensor
    actions: Tensor
    log_pi: Tensor
    advantages: Tensor  # A - λ A_C
    returns: Tensor
    rule_actions: Tensor
    cost_returns: Tensor  # (agents, batch) what V_C(s) should be
    accident_soon: Tensor  # (agents, batch) 1 for an accident within the next k decisions
    known: Tensor  # (agents, batch) 0 where the horizon hides the answer


class SafeLearner(PPOLearner):
    """PPO of several agents with a cost of accidents. `xi` (agents, 1), for the curves, is the present λ."""

    settings: list[SafeSettings]

    def __init__(self, settings: Sequence[SafeSettings], observation_size: int, n_actions: int = N_ACTIONS):
        super().__init__(settings, observation_size, n_actions)
        for name in ("accident_cost", "accident_budget", "multiplier_step", "risk_limit"):
            setattr(self, name, torch.tensor([[float(getattr(s, name))] for s in settings]))
        self.multiplier = torch.zeros(self.agents, 1)
        shared, generators = self.settings[0], [torch.Generator().manual_seed(s.seed + 2**33) for s in settings]
        self.constrained, self.masks = bool(self.multiplier_step.any()), bool((self.risk_limit < 1).any())
        self.cost_value: list[Tensor] = []
        if self.constrained:
            self.cost_value = init_mlp((observation_size, *shared.hidden, 1), generators)
            self._train(self.cost_value, shared.critic_lr)
        if self.masks:
            sizes = (observation_size, *shared.hidden, n_actions)
            each = [init_mlp(sizes, generators) for _ in range(shared.n_critics)]
            self.critics = [torch.cat(parts) for parts in zip(*each, strict=True)]
            self._train(self.critics, shared.critic_lr)

    def _train(self, network: list[Tensor], rate: float) -> None:
        with torch.no_grad():
            torch._foreach_zero_(network[-2:])  # begin with V_C = 0, or the same risk everywhere
        for parameter in network:
            parameter.requires_grad_()
        self.trained.append((network, rate))
        self.optimiser.add_param_group({"params": network, "lr": rate})

    def note_temperature(self) -> None:
        """Set `xi` to λ."""
        super().note_temperature()
        self.xi = getattr(self, "multiplier", self.xi)

    def rewards(self, taken: Batch) -> Tensor:
        """The road's rewards less the fixed price of an accident: (horizon, agents, roads)."""
        return taken.rewards - self.accident_cost * taken.terminated

    @torch.no_grad()
    def prepare(self, replay: RolloutBuffer) -> None:
        """As PPO's, with λ A_C taken off the advantages, and the labels of the risk."""
        super().prepare(replay)
        taken, columns = decode_transitions(replay.table, replay.observation_size, replay.ended), replay.columns
        accident, cost_returns = taken.terminated, torch.zeros_like(taken.terminated)
        if self.constrained:
            roads = self.settings[0].envs_per_agent
            rate = accident_rate(self.curves.values["accident"], self.curves.finished, roads)
            self.multiplier = self.next_multiplier(torch.from_numpy(rate).float()[:, None].to(self.device))
            costs, next_costs = (self._values(self.cost_value, states) for states in (taken.states, taken.next_states))
            found = self.advantages(accident, costs, next_costs, accident, replay.ended)
            cost_returns = found + costs
            columns = columns._replace(advantages=columns.advantages - self.multiplier * agents_first(found))
        k = self.settings[0].risk_decisions
        labels = accident_within(accident, replay.ended, k), resolved(accident, k)
        replay.columns = SafeMinibatch(*columns, *map(agents_first, (cost_returns, *labels)))

    def next_multiplier(self, rate: Tensor) -> Tensor:
        """λ after a round of decisions, with the present accident rates J_C: (agents, 1) -> (agents, 1)."""
        return multiplier_step(self.multiplier, rate, self.accident_budget, self.multiplier_step)

    def losses(self, batch: SafeMinibatch) -> dict[str, Tensor]:
        """PPO's, the cost values' squared error and the risk's cross-entropy: each (agents,)."""
        terms = super().losses(batch)
        if self.constrained:
            terms["cost_loss"] = sac.critic_loss(mlp(self.cost_value, batch.states)[..., 0], batch.cost_returns) / 2
        if self.masks:
            logits = self.q_pair(self.critics, batch.states)  # (2, agents, batch, 9)
            taken = logits.gather(-1, batch.actions.expand(logits.shape[:-1])[..., None])[..., 0]
            terms["risk_loss"] = risk_loss(taken, batch.accident_soon, batch.known).sum(0)
        return terms

    def value_loss(self, outputs: Tensor, returns: Tensor) -> Tensor:
        """PPO's, or quantile regression if N > 1: (agents, batch, N), (agents, batch) -> (agents,)."""
        return quantile_loss(outputs, returns) if outputs.shape[-1] > 1 else super().value_loss(outputs, returns)

    def state_value(self, outputs: Tensor) -> Tensor:
        """V(s), or V_C(s) of its one output: (..., N) -> (...)."""
        return mean_of_the_worst(outputs, self.settings[0].worst_share)

    def acting_policy(self, states: Tensor, rule_actions: Tensor, decided: Tensor) -> Tensor:
        """π itself, whose decisions PPO learns from: (agents, roads, actions)."""
        return self.probabilities(states)

    @torch.no_grad()
    def driving_policy(self, states: Tensor, rule_actions: Tensor) -> Tensor:
        """π behind the mask and the shield: (agents, batch, actions)."""
        pi = self.probabilities(states)
        if self.masks:
            pi = masked(pi, self.risk(states), self.risk_limit[..., None])
        if self.settings[0].shield:
            pi = masked(pi, needed_braking(states), torch.tensor(DEFAULT.ego.acceleration))
        return pi

    def risk(self, states: Tensor) -> Tensor:
        """The larger of two classifiers' probabilities of an accident: (agents, batch, actions)."""
        return self.q_pair(self.critics, states).sigmoid().amax(0)

    @torch.no_grad()
    def q_values(self, states: Tensor) -> Tensor:
        """Minus the risk: (agents, batch, observation) -> (agents, batch, actions)."""
        return -self.risk(states)

    def tensors(self) -> dict[str, list[Tensor]]:
        """PPO's, V_C and λ."""
        return super().tensors() | {"cost_value": self.cost_value, "multiplier": [self.multiplier]}
