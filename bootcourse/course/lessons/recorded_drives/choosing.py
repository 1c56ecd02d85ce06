"""Choosing a driver without a simulator: what a policy is worth, estimated from recorded drives alone."""

from copy import deepcopy

import numpy as np
import torch

from bootcourse.episodes.record import record
from bootcourse.learn.demonstrations import collect
from bootcourse.learn.replay_buffer import Batch, decode_transitions
from bootcourse.learn.textbook import minimise, mlp
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


def fitted_q(policy: Policy, data: Batch, gamma: float, updates: int = 2000, batch: int = 64, seed: int = 0):
    """Q of a given policy by fitted Q evaluation (Le et al., arXiv 1903.08738): Q(s, a) = r + γ Q(s', π(s')).

    A network that gives Q, (n, 9), of states (n, observation). Nothing is driven.
    """
    torch.manual_seed(seed)
    rng, network = np.random.default_rng(seed), mlp(data.states.shape[1], N_ACTIONS, (64, 64))
    slow, optimiser = deepcopy(network), torch.optim.Adam(network.parameters(), lr=1e-3)
    next_actions = actions_of(policy, data.next_states)
    for _ in range(updates):
        i = torch.from_numpy(rng.integers(len(data.actions), size=batch))
        with torch.no_grad():
            next_q = slow(data.next_states[i]).gather(1, next_actions[i, None])[:, 0]
            target = data.rewards[i] + gamma * (1 - data.terminated[i]) * next_q
        loss = (network(data.states[i]).gather(1, data.actions[i, None])[:, 0] - target).square().mean()
        minimise(optimiser, loss)
        with torch.no_grad():
            for average, parameter in zip(slow.parameters(), network.parameters(), strict=True):
                average.lerp_(parameter, 0.01)
    return network


def estimate(policy: Policy, data: Batch, starts: torch.Tensor, gamma: float) -> float:
    """What the driver is worth from these first states, (n, observation), on average, by the recorded drives alone."""
    network = fitted_q(policy, data, gamma)
    with torch.no_grad():
        return float(network(starts).gather(1, actions_of(policy, starts)[:, None]).mean())


def worth(policy: Policy, roads, gamma: float) -> tuple[float, float]:
    """What it is worth from the start and what it earns, on roads that it drives: (discounted, return), means."""
    drives = record(policy, roads)
    discounted = [gamma ** np.arange(len(drive.rewards)) @ drive.rewards for drive in drives]
    return float(np.mean(discounted)), float(np.mean([drive.rewards.sum() for drive in drives]))
