"""Proximal policy optimisation (Schulman et al., arXiv 1707.06347), alone or after cloning the teacher.

On-policy: a few hundred roads are driven for `horizon` decisions, the policy takes `epochs` passes over them in
minibatches, and the decisions are thrown away. Advantages: GAE (arXiv 1506.02438). An episode that ran out of time is
bootstrapped with the value of its last state; an accident is worth nothing afterwards. Where we differ from the paper:
the advantages of each minibatch are given mean 0 and deviation 1, and each network's gradient is clipped to a norm of
0.5. Both are common in implementations; the clipped value loss that some of them have is left out.

Many agents side by side, as in learner.py: the first axis of every parameter is the agents. There are no critics: a
value network V(s) takes their place in training.
"""

from collections.abc import Sequence
from dataclasses import dataclass
from typing import NamedTuple

import numpy as np
import torch
import torch.nn.functional as F
from torch import Tensor

from bootcourse.learn import sac
from bootcourse.learn.networks import init_mlp, mlp
from bootcourse.learn.protocol import Learner, adam, check_shared, generators_of, per_agent, total_loss
from bootcourse.learn.replay_buffer import decode_transitions
from bootcourse.learn.settings import Settings, shared
from bootcourse.scenario import N_ACTIONS


@dataclass(frozen=True)
class PPOSettings(Settings):
    """The settings of PPO, which shares γ, the network and the roads with the other methods. All are our choice §."""

    horizon: int = shared(32, low=1)  # decisions on every road between two rounds of updates
    epochs: int = shared(4, low=1)  # passes over these decisions
    clip: float = shared(0.2, low=0, high=1)  # ε: how far the ratio of new to old probabilities counts
    gae_lambda: float = shared(0.95, low=0, high=1)  # λ of the advantages
    entropy_weight: float = shared(0.01, low=0)  # of the entropy bonus
    anneal_decisions: int | None = shared(None, low=1)  # of each agent, until the learning rates are 0; None: never
    cloning_updates: int = shared(0, low=0)  # before the first drive: clone the teacher; 0 for PPO alone
    label_smoothing: float = shared(0.1, low=0, high=1)  # of the cloned actions

    @property
    def needs_demonstrations(self) -> bool:
        """Whether the agent begins as a clone of the teacher."""
        return self.cloning_updates > 0


def advantages(
    rewards: Tensor, values: Tensor, next_values: Tensor, terminated: Tensor, ended: Tensor, gamma: Tensor, lam: float
) -> Tensor:
    """A_t = δ_t + γ λ (1 - ended_t) A_{t+1} with δ_t = r_t + γ (1 - terminated_t) V(s_{t+1}) - V(s_t).

    All are (horizon, ...); gamma broadcasts against one decision. Generalised advantage estimation, Equation 16 of
    arXiv 1506.02438. ended: terminated or out of time.
    """
    delta = rewards + gamma * (1 - terminated) * next_values - values
    advantage, following = torch.empty_like(delta), torch.zeros_like(delta[0])
    for t in reversed(range(len(delta))):
        advantage[t] = following = delta[t] + gamma * lam * (1 - ended[t]) * following
    return advantage


def clipped_loss(ratio: Tensor, advantage: Tensor, clip: float) -> Tensor:
    """-E[min(ratio A, clip(ratio, 1 - ε, 1 + ε) A)], Equation 7: (..., batch) -> (...). ratio: π(a|s) / π_old(a|s)."""
    return -torch.minimum(ratio * advantage, ratio.clamp(1 - clip, 1 + clip) * advantage).mean(-1)


class Minibatch(NamedTuple):
    """A part of the last decisions, each (agents, batch, ...)."""

    states: Tensor  # (agents, batch, observation)
    actions: Tensor  # (agents, batch) int64
    log_pi: Tensor  # (agents, batch) log π_old(a|s)
    advantages: Tensor  # (agents, batch)
    returns: Tensor  # (agents, batch) what V(s) should be


class RolloutBuffer:
    """The last `horizon` decisions of all agents on all their roads, drawn without replacement.

    table: rows of `encode_transitions`, (horizon, agents, roads, row); ended (horizon, agents, roads).
    """

    def __init__(
        self, agents: int, roads: int, horizon: int, observation_size: int, device: torch.device | None = None
    ):
        self.table = torch.zeros(horizon, agents, roads, 2 * observation_size + 5, dtype=torch.float32, device=device)
        self.ended = torch.zeros(horizon, agents, roads, dtype=torch.float32, device=device)
        self.observation_size, self.filled, self.drawn = observation_size, 0, 0
        self.columns: Minibatch | None = None  # all decisions, each (agents, horizon x roads, ...)
        self.order = np.zeros((agents, horizon * roads), dtype=np.int64)  # in which this epoch draws them

    def add(self, rows: Tensor, ended: np.ndarray) -> None:
        """Store one decision on every road: rows (agents, roads, row), ended (agents, roads) bool."""
        self.filled = 0 if self.full else self.filled
        self.table[self.filled], self.ended[self.filled] = rows, torch.from_numpy(ended).float()
        self.filled += 1

    @property
    def full(self) -> bool:
        return self.filled == len(self.table)

    def sample(self, batch: int, beta: np.ndarray, generators: list[np.random.Generator]) -> Minibatch:
        """The next minibatch; each epoch shuffles anew. beta, the share of demonstrations, has no effect.

        The last minibatch of an epoch is smaller if `batch` does not divide the number of decisions.
        """
        size = self.order.shape[1]
        if self.drawn == 0 or self.drawn >= size:
            self.drawn, self.order = 0, np.stack([generator.permutation(size) for generator in generators])
        chosen = torch.from_numpy(self.order[:, self.drawn : self.drawn + batch])  # (agents, batch)
        self.drawn += batch
        agents = torch.arange(len(self.order))[:, None]
        return Minibatch(*(column[agents, chosen] for column in self.columns))

    def state(self) -> dict[str, np.ndarray]:
        """What a checkpoint keeps: the decisions of an unfinished round."""
        rows = self.table[: self.filled].cpu().numpy()
        return {"own": rows, "ended": self.ended[: self.filled].cpu().numpy(), "demonstrations": rows[:0, 0, 0]}

    def restore(self, state: dict[str, np.ndarray]) -> None:
        """Set a new buffer to a state. Raises RuntimeError if it does not fit."""
        self.filled = len(state["own"])
        self.table[: self.filled] = torch.from_numpy(state["own"])
        self.ended[: self.filled] = torch.from_numpy(state["ended"])


class PPOLearner(Learner):
    """Actors and value networks of several agents."""

    def __init__(self, settings: Sequence[PPOSettings], observation_size: int, n_actions: int = N_ACTIONS):
        self.settings, self.agents = check_shared(settings), len(settings)
        shared, inputs = self.settings[0], (observation_size, *self.settings[0].hidden)
        self.actor = init_mlp((*inputs, n_actions), generators_of(settings))
        self.actor[-2] *= 0.01  # begin with nearly equal probabilities
        self.value = init_mlp((*inputs, 1), generators_of(settings, 2**32))
        self.rates = shared.actor_lr, shared.critic_lr  # of the actor and of the value network
        self.optimiser = adam(*zip((self.actor, self.value), self.rates, strict=True))
        self.gamma = per_agent(settings, "gamma")

    def make_buffer(self, observation_size: int, demonstrations: Tensor | None) -> RolloutBuffer:
        """An empty rollout buffer. With demonstrations, the actors are cloned from them first."""
        shared = self.settings[0]
        if demonstrations is not None:
            self.clone(demonstrations.to(self.device), observation_size)
        return RolloutBuffer(self.agents, shared.envs_per_agent, shared.horizon, observation_size, self.device)

    def clone(self, rows: Tensor, observation_size: int) -> None:
        """Behaviour cloning of the teacher's actions μ(s) in the demonstrations' states, with smoothed labels."""
        shared, generators = self.settings[0], [np.random.default_rng([s.seed, 1]) for s in self.settings]
        demonstrations = decode_transitions(rows, observation_size, torch.zeros(len(rows)))
        optimiser = torch.optim.Adam(self.actor, lr=1e-3, fused=True)
        for _ in range(shared.cloning_updates):
            chosen = torch.from_numpy(np.stack([rng.integers(len(rows), size=512) for rng in generators]))
            logits = mlp(self.actor, demonstrations.states[chosen])  # (agents, 512, 9)
            taught = demonstrations.rule_actions[chosen]  # (agents, 512)
            loss = F.cross_entropy(logits.flatten(0, 1), taught.flatten(), label_smoothing=shared.label_smoothing)
            optimiser.zero_grad()
            (self.agents * loss).backward()
            optimiser.step()

    def updates_due(self, replay: RolloutBuffer, decisions: int) -> int:
        """None until `horizon` decisions are there; then the minibatches of all epochs."""
        if not replay.full:
            return 0
        self.prepare(replay)
        decided = replay.order.shape[1]
        self.anneal(decisions - decided)
        return self.settings[0].epochs * -(-decided // self.settings[0].batch)

    def anneal(self, decisions: int) -> None:
        """Set both learning rates, which fall linearly to 0 if `anneal_decisions` is set; decisions: of each agent."""
        last = self.settings[0].anneal_decisions
        share = 1.0 if last is None else max(1 - decisions / last, 0.0)
        for group, rate in zip(self.optimiser.param_groups, self.rates, strict=True):
            group["lr"] = rate * share

    @torch.no_grad()
    def prepare(self, replay: RolloutBuffer) -> None:
        """Compute the advantages and returns of the stored decisions."""
        decisions = decode_transitions(replay.table, replay.observation_size, replay.ended)
        values, next_values = self.state_values(decisions.states), self.state_values(decisions.next_states)
        advantage = self.advantages(decisions.rewards, values, next_values, decisions.terminated, replay.ended)
        states, actions = agents_first(decisions.states), agents_first(decisions.actions)
        log_pi = sac.log_policy(mlp(self.actor, states)).gather(-1, actions[..., None])[..., 0]
        copies = states.clone(), actions.clone()  # of one agent they are views, which the next drives overwrite
        replay.columns = Minibatch(*copies, log_pi, agents_first(advantage), agents_first(advantage + values))
        replay.drawn = 0

    def state_values(self, states: Tensor) -> Tensor:
        """V(s): (horizon, agents, roads, observation) -> (horizon, agents, roads)."""
        horizon, agents, roads, _ = states.shape
        return mlp(self.value, agents_first(states))[..., 0].view(agents, horizon, roads).transpose(0, 1)

    def advantages(self, *columns: Tensor) -> Tensor:
        """The advantages of decisions, all (horizon, agents, roads); columns as of `advantages`, without γ and λ."""
        return advantages(*columns, self.gamma, self.settings[0].gae_lambda)

    def clipped_loss(self, ratio: Tensor, advantage: Tensor) -> Tensor:
        """Each agent's clipped objective: (agents, batch) -> (agents,)."""
        return clipped_loss(ratio, advantage, self.settings[0].clip)

    def losses(self, batch: Minibatch) -> dict[str, Tensor]:
        """The clipped objective with its entropy bonus, and the values' squared error: each (agents,)."""
        log_pi = sac.log_policy(mlp(self.actor, batch.states))  # (agents, batch, 9)
        policy_loss, entropy = self.policy_loss(log_pi, batch), sac.entropy(log_pi).mean(-1)
        return {
            "actor_loss": policy_loss - self.settings[0].entropy_weight * entropy,
            "value_loss": sac.critic_loss(mlp(self.value, batch.states)[..., 0], batch.returns) / 2,
            "entropy": entropy,
        }

    def policy_loss(self, log_pi: Tensor, batch: Minibatch) -> Tensor:
        """The clipped objective, with advantages of mean 0 and deviation 1: log_pi (agents, batch, 9) -> (agents,)."""
        ratio = (log_pi.gather(-1, batch.actions[..., None])[..., 0] - batch.log_pi).exp()
        advantage = batch.advantages - batch.advantages.mean(-1, keepdim=True)
        deviation = batch.advantages.std(-1, keepdim=True, correction=min(1, advantage.shape[-1] - 1))  # of one, 0
        return self.clipped_loss(ratio, advantage / (deviation + 1e-8))

    def update(self, batch: Minibatch) -> dict[str, Tensor]:
        """One gradient step of all agents on a minibatch, each network's gradient clipped to a norm of 0.5."""
        terms = self.losses(batch)
        self.optimiser.zero_grad()
        total_loss(terms).backward()
        for network in (self.actor, self.value):
            norm = sum(p.grad.square().flatten(1).sum(1) for p in network).sqrt()  # (agents,)
            for parameter in network:
                parameter.grad *= (0.5 / (norm + 1e-6)).clamp(max=1.0)[:, None, None]
        self.optimiser.step()
        return {name: values.detach() for name, values in terms.items()}

    def tensors(self) -> dict[str, list[Tensor]]:
        return {"actor": self.actor, "value": self.value}


def agents_first(column: Tensor) -> Tensor:
    """(horizon, agents, roads, ...) -> (agents, horizon x roads, ...)."""
    return column.transpose(0, 1).flatten(1, 2)
