"""Choosing a driver without a simulator: what a policy is worth, estimated from recorded drives alone."""

from collections.abc import Sequence

import numpy as np
import torch

from bootcourse.episodes.record import record
from bootcourse.learn.demonstrations import collect
from bootcourse.learn.networks import init_mlp, mlp
from bootcourse.learn.protocol import adam
from bootcourse.learn.replay_buffer import Batch, decode_transitions
from bootcourse.learn.textbook import minimise
from bootcourse.policies import Policy
from bootcourse.scenario import DEFAULT, N_ACTIONS


def recorded(drives: int = 200) -> Batch:
    """The rule's drives, as the three pupils learned from them: every field (transitions, ...)."""
    rows = collect(drives)
    return decode_transitions(rows, DEFAULT.observation_size, torch.zeros(len(rows)))


def actions_of(policy: Policy, states: torch.Tensor) -> torch.Tensor:
    """What a driver that sees nothing but observations does in these states, (n,)."""
    return torch.from_numpy(np.asarray(policy(states.numpy(), None).actions, dtype=np.int64))


def overlap(policy: Policy, data: Batch) -> float:
    """The share of the recorded seconds in which the driver would do what was done."""
    return float((actions_of(policy, data.states) == data.actions).float().mean())


def fitted_q(
    policies: Sequence[Policy], data: Batch, gamma: float, updates: int = 2000, batch: int = 64, seed: int = 0
):
    """Q of given policies by fitted Q evaluation (Le et al., arXiv 1903.08738): Q(s, a) = r + γ Q(s', π(s')).

    The parameters of one network for each policy, side by side: see `networks.mlp`. Each begins with the same weights
    and gets the same batches. Nothing is driven.
    """
    sizes, rng = (data.states.shape[1], 64, 64, N_ACTIONS), np.random.default_rng(seed)
    q = init_mlp(sizes, [torch.Generator().manual_seed(seed) for _ in policies])
    slow, optimiser = [parameter.clone() for parameter in q], adam((q, 1e-3))
    next_actions = torch.stack([actions_of(policy, data.next_states) for policy in policies])  # (policies, transitions)
    for _ in range(updates):
        i = torch.from_numpy(rng.integers(len(data.actions), size=batch))
        with torch.no_grad():
            next_q = q_of(slow, data.next_states[i], next_actions[:, i])  # (policies, batch)
            target = data.rewards[i] + gamma * (1 - data.terminated[i]) * next_q
        losses = (q_of(q, data.states[i], data.actions[i].expand(len(policies), -1)) - target).square().mean(-1)
        minimise(optimiser, losses.sum())
        with torch.no_grad():
            torch._foreach_lerp_(slow, q, 0.01)
    return q


def q_of(parameters: Sequence[torch.Tensor], states: torch.Tensor, actions: torch.Tensor) -> torch.Tensor:
    """Q(s, a) of each policy's network: states (n, observation), actions (policies, n) -> (policies, n)."""
    q = mlp(parameters, states.expand(len(actions), *states.shape))
    return q.gather(-1, actions.unsqueeze(-1)).squeeze(-1)


def estimates(policies: Sequence[Policy], data: Batch, starts: torch.Tensor, gamma: float) -> list[float]:
    """What each driver is worth from these first states, (n, observation), on average, by the recorded drives alone."""
    chosen = torch.stack([actions_of(policy, starts) for policy in policies])
    return q_of(fitted_q(policies, data, gamma), starts, chosen).mean(-1).tolist()


def worth(policy: Policy, roads, gamma: float) -> tuple[float, float]:
    """What it is worth from the start and what it earns, on roads that it drives: (discounted, return), means."""
    drives = record(policy, roads)
    discounted = [gamma ** np.arange(len(drive.rewards)) @ drive.rewards for drive in drives]
    return float(np.mean(discounted)), float(np.mean([drive.rewards.sum() for drive in drives]))
