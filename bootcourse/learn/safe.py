"""PPO for which accidents cost more: a fixed price, or one that a budget sets; and a mask against risky actions.

The price λ is the Lagrange multiplier of J_C <= d, with J_C the share of episodes that end in an accident and d the
budget: PPO-Lagrangian, with the integral control of λ in Stooke et al. (arXiv 2007.03964). λ rises while there are more
accidents and falls, to 0 at least, while there are fewer. A second value function V_C predicts accidents; the advantage
is A - λ A_C.

The mask of risk.py, or the shield of shield.py, chooses for π where the agent drives. The mask may also be on while it
learns; then PPO learns among the actions that are left (Huang & Ontañón, arXiv 2006.14171). The risk's classifiers are
in the place of the critics, which PPO does not have, so an agent keeps them in its files.
"""

from collections.abc import Sequence
from typing import NamedTuple

import numpy as np
import torch
from torch import Tensor

from bootcourse.learn import sac
from bootcourse.learn.networks import init_mlp, mlp
from bootcourse.learn.ppo import PPOLearner, RolloutBuffer, agents_first
from bootcourse.learn.replay_buffer import Batch, decode_transitions
from bootcourse.learn.risk import accident_within, allowed, masked, resolved, risk_loss
from bootcourse.learn.settings import SafeSettings
from bootcourse.learn.shield import needed_braking
from bootcourse.scenario import DEFAULT, N_ACTIONS

WINDOW = 1000  # the last episodes in which accidents are counted: two of each road


def accident_rate(accident: np.ndarray, finished: np.ndarray, window: int = WINDOW) -> np.ndarray:
    """J_C, the share of each agent's last episodes that ended in an accident, (agents,).

    accident (agents, episodes), the number of an `Accident`; finished (agents,) episodes. NaN before the first one;
    the last rate that is recorded if there were more.
    """
    last = [
        its[max(0, n - window) : n] for its, n in zip(accident, np.minimum(finished, accident.shape[1]), strict=True)
    ]
    return np.array([np.mean(each > 0) if len(each) else np.nan for each in last])


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
    allowed: Tensor  # (agents, batch, actions) bool


class SafeLearner(PPOLearner):
    """PPO of several agents with a cost of accidents. `xi` (agents, 1), for the curves, is the present λ."""

    settings: list[SafeSettings]

    def __init__(self, settings: Sequence[SafeSettings], observation_size: int, n_actions: int = N_ACTIONS):
        super().__init__(settings, observation_size, n_actions)
        for name in ("accident_cost", "accident_budget", "multiplier_step", "risk_limit"):
            setattr(self, name, torch.tensor([[float(getattr(s, name))] for s in settings]))
        self.multiplier = torch.zeros(self.agents, 1)
        self.training_limit = torch.ones(self.agents, 1)  # ε in training: 1 until the mask is on
        shared, generators = self.settings[0], [torch.Generator().manual_seed(s.seed + 2**33) for s in settings]
        self.constrained, self.masks = bool(self.multiplier_step.any()), bool((self.risk_limit < 1).any())
        self.masks_training = self.masks and shared.mask_episodes > 0
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
            rate = torch.from_numpy(accident_rate(self.curves.values["accident"], self.curves.finished)).float()
            self.multiplier = multiplier_step(
                self.multiplier, rate[:, None], self.accident_budget, self.multiplier_step
            )
            costs, next_costs = (self._values(self.cost_value, states) for states in (taken.states, taken.next_states))
            found = self.advantages(accident, costs, next_costs, accident, replay.ended)
            cost_returns = found + costs
            columns = columns._replace(advantages=columns.advantages - self.multiplier * agents_first(found))
        may = torch.ones((*columns.actions.shape, N_ACTIONS), dtype=torch.bool)
        if self.masks_training:
            may = self.allowed(columns.states, self.training_limit)
            may.scatter_(-1, columns.actions[..., None], True)  # rounding aside, it was
            log_pi = masked(self.probabilities(columns.states), may).log()
            columns = columns._replace(log_pi=log_pi.gather(-1, columns.actions[..., None])[..., 0])
            begun = torch.from_numpy(self.curves.finished >= self.settings[0].mask_episodes)[:, None]
            self.training_limit = torch.where(begun, self.risk_limit, 1.0)  # of the decisions to come
        k = self.settings[0].risk_decisions
        labels = accident_within(accident, replay.ended, k), resolved(accident, k)
        more = map(agents_first, (cost_returns, *labels))
        replay.columns = SafeMinibatch(*columns, *more, may)

    def policy_loss(self, log_pi: Tensor, batch: SafeMinibatch) -> Tensor:
        """PPO's, of the actions that the mask allows in training."""
        if self.masks_training:
            log_pi = sac.log_policy(log_pi.masked_fill(~batch.allowed, -1e9))
        return super().policy_loss(log_pi, batch)

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

    @torch.no_grad()
    def acting_policy(self, states: Tensor, rule_actions: Tensor, decided: Tensor) -> Tensor:
        """π, behind the mask after some episodes of training: (agents, roads, actions)."""
        pi = self.probabilities(states)
        return masked(pi, self.allowed(states, self.training_limit)) if self.masks_training else pi

    @torch.no_grad()
    def driving_policy(self, states: Tensor, rule_actions: Tensor) -> Tensor:
        """π behind the mask and the shield: (agents, batch, actions)."""
        pi = self.probabilities(states)
        if self.masks:
            pi = masked(pi, self.allowed(states, self.risk_limit))
        if self.settings[0].shield:
            pi = masked(pi, allowed(needed_braking(states), torch.tensor(DEFAULT.ego.acceleration)))
        return pi

    def allowed(self, states: Tensor, limit: Tensor) -> Tensor:
        """The actions whose risk is at most ε, limit (agents, 1): (agents, batch, actions) bool."""
        return allowed(self.risk(states), limit[..., None])

    def risk(self, states: Tensor) -> Tensor:
        """The larger of two classifiers' probabilities of an accident: (agents, batch, actions)."""
        return self.q_pair(self.critics, states).sigmoid().amax(0)

    @torch.no_grad()
    def q_values(self, states: Tensor) -> Tensor:
        """Minus the risk: (agents, batch, observation) -> (agents, batch, actions)."""
        return -self.risk(states)

    def tensors(self) -> dict[str, list[Tensor]]:
        """PPO's, V_C and λ."""
        return super().tensors() | {"cost_value": self.cost_value, "multiplier": [self.multiplier, self.training_limit]}
