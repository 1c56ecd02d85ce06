"""What a policy is worth, estimated from recorded drives alone, and what it is worth on the road."""

from collections.abc import Collection, Sequence
from dataclasses import replace
from functools import cache

import numpy as np
import torch

from bootcourse.course.shipped import shipped_agents
from bootcourse.episodes.driving import one_episode_each, steps
from bootcourse.episodes.evaluate import drive_episodes
from bootcourse.learn.demonstrations import collect
from bootcourse.learn.networks import init_mlp, mlp
from bootcourse.learn.protocol import adam
from bootcourse.learn.replay_buffer import Batch, decode_transitions
from bootcourse.learn.textbook import minimise
from bootcourse.methods import display_name
from bootcourse.policies import Policy, PolicyOutput
from bootcourse.scenario import DEFAULT, N_ACTIONS

METHODS = ("bc", "cql", "gail", "sac", "bootstrapped")
SECONDS = 40  # of a drive: what comes later adds less than 0.01 to its worth at γ = 0.8


def agents(which: int = 0) -> dict[str, Policy]:
    """A trained agent of each of five methods, by the method's name: the first, or another."""
    return {display_name(method): shipped_agents(method)[which].as_policy() for method in METHODS}


@cache
def recorded(drives: int = 200) -> Batch:
    """The rule's drives, as the lesson's three agents learned from them: every field (transitions, ...)."""
    rows = collect(drives)
    return decode_transitions(rows, DEFAULT.observation_size, torch.zeros(len(rows)))


def promised(policy: Policy, states: torch.Tensor) -> float:
    """The Q of what an agent with a critic would do in these states, (n, observation): the mean."""
    decided = policy(states.numpy(), None)
    return float(np.take_along_axis(decided.q_values, np.asarray(decided.actions)[:, None], -1).mean())


@cache
def starts() -> torch.Tensor:
    """What a driver sees first on each of 100 roads, (100, observation)."""
    observations, _ = one_episode_each(100, DEFAULT, None).reset(seed=list(range(100)))
    return torch.from_numpy(observations).float()


def actions_of(policy: Policy, states: torch.Tensor) -> torch.Tensor:
    """What a driver that sees nothing but observations does in these states, (n,)."""
    return torch.from_numpy(np.asarray(policy(states.numpy(), None).actions, dtype=np.int64))


LIKELY = 0.1  # of the highest probability: a clone's actions with at least this share of it are likely


def limited(critic: Policy, clone: Policy, lowest: bool = False) -> Policy:
    """Takes the action with the highest Q, or the lowest, of those that a clone finds likely."""

    def decide(observations: np.ndarray, cars: np.ndarray) -> PolicyOutput:
        q, likely = critic(observations, cars).q_values, likely_actions(clone, observations)
        return PolicyOutput(np.where(likely, -q if lowest else q, -np.inf).argmax(-1))

    return decide


def likely_actions(clone: Policy, observations: np.ndarray) -> np.ndarray:
    """Which actions a clone finds likely, (n, 9) bool."""
    chances = clone(observations, None).policy
    return chances >= LIKELY * chances.max(-1, keepdims=True)


def fastest(clone: Policy) -> Policy:
    """Accelerates where a clone finds that likely, else keeps its speed, else brakes; it needs no Q."""

    def decide(observations: np.ndarray, cars: np.ndarray) -> PolicyOutput:
        chances, likely = clone(observations, cars).policy, likely_actions(clone, observations)
        return PolicyOutput(np.where(likely, np.arange(9) // 3 + chances, -np.inf).argmax(-1))

    return decide


def ranked(critic: Policy, rank: int) -> Policy:
    """Takes the action whose Q is the highest (0), the second (1), ..., the lowest (8)."""
    return lambda observations, cars: PolicyOutput(np.argsort(-critic(observations, cars).q_values)[:, rank])


CHOICES = ["takes the action with", "accidents on 50 roads", "return"]


def choices(critics: Sequence[Policy], clone: Policy, roads: int = 50) -> list[list[str]]:
    """Accidents and mean return of each critic's agent, by how it chooses, and of the clone: the rows of a table."""
    ways = {
        "the highest Q of nine": [ranked(critic, 0) for critic in critics],
        "the second": [ranked(critic, 1) for critic in critics],
        "the lowest": [ranked(critic, 8) for critic in critics],
        "the highest Q of the likely ones": [limited(critic, clone) for critic in critics],
        "the lowest of the likely ones": [limited(critic, clone, lowest=True) for critic in critics],
        "the highest probability: the clone": [clone],
        "no Q: the fastest of the likely ones": [fastest(clone)],
    }
    rows = []
    for name, policies in ways.items():
        driven = [drive_episodes(policy, range(roads)) for policy in policies]
        crashes = " and ".join(f"{(each.accident > 0).sum()}" for each in driven)
        rows.append([name, crashes, " and ".join(f"{each.returns.mean():.0f}" for each in driven)])
    return rows


def overlap(policy: Policy, data: Batch) -> float:
    """The share of the recorded seconds in which the driver would do what was done."""
    return float((actions_of(policy, data.states) == data.actions).float().mean())


def fitted_q(
    policies: Sequence[Policy], data: Batch, gamma: float, seeds: Sequence[int], updates: int = 1000, batch: int = 64
):
    """Q of given policies by fitted Q evaluation (Le et al., arXiv 1903.08738): Q(s, a) = r + γ Q(s', π(s')).

    The parameters of one network for each policy, side by side: see `networks.mlp`. Networks with the same seed begin
    with the same weights and get the same batches. Nothing is driven.
    """
    sizes = (data.states.shape[1], 64, 64, N_ACTIONS)
    q = init_mlp(sizes, [torch.Generator().manual_seed(int(seed)) for seed in seeds])
    slow, optimiser = [parameter.clone() for parameter in q], adam((q, 1e-3))
    chosen = {policy: actions_of(policy, data.next_states) for policy in dict.fromkeys(policies)}
    next_actions = torch.stack([chosen[policy] for policy in policies])  # (networks, transitions)
    draws = [np.random.default_rng(seed).integers(len(data.actions), size=(updates, batch)) for seed in seeds]
    for i in torch.from_numpy(np.stack(draws, axis=1)):  # (networks, batch)
        with torch.no_grad():
            next_q = q_of(slow, data.next_states[i], next_actions.gather(1, i))
            target = data.rewards[i] + gamma * (1 - data.terminated[i]) * next_q
        minimise(optimiser, (q_of(q, data.states[i], data.actions[i]) - target).square().mean(-1).sum())
        with torch.no_grad():
            torch._foreach_lerp_(slow, q, 0.02)
    return q


def q_of(parameters: Sequence[torch.Tensor], states: torch.Tensor, actions: torch.Tensor) -> torch.Tensor:
    """Q(s, a) of each network: its states (networks, n, observation) and actions (networks, n) -> (networks, n)."""
    return mlp(parameters, states).gather(-1, actions.unsqueeze(-1)).squeeze(-1)


def estimates(
    policies: Sequence[Policy], data: Batch, starts: torch.Tensor, gamma: float, seeds: Sequence[int] | None = None
) -> list[float]:
    """What each driver is worth from these first states, (n, observation), on average, by the recorded drives alone.

    A driver that is named twice, with two seeds, is estimated by two fits. Without seeds, each has seed 0.
    """
    chosen = torch.stack([actions_of(policy, starts) for policy in policies])
    q = fitted_q(policies, data, gamma, [0] * len(policies) if seeds is None else seeds)
    return q_of(q, starts.expand(len(policies), *starts.shape), chosen).mean(-1).tolist()


def fits(policies: Collection[Policy], data: Batch, times: int, gamma: float = 0.8) -> np.ndarray:
    """What each driver is worth by so many fits with the seeds 0, 1, ...: the mean of 100 roads, (times, policies)."""
    seeds = np.repeat(range(times), len(policies))
    return np.reshape(estimates([*policies] * times, data, starts(), gamma, seeds), (times, -1))


def each_second(policy: Policy, roads: Sequence[int]) -> np.ndarray:
    """What it earns in each of the first `SECONDS` on roads that it drives, the mean, (seconds,)."""
    short = replace(DEFAULT, clock=replace(DEFAULT.clock, decisions=SECONDS))
    drive = steps(policy, one_episode_each(len(roads), short, None), list(roads))
    earned = [float(np.mean(step.rewards * step.running)) for step in drive]
    return np.array(earned + [0.0] * (SECONDS - len(earned)))  # all may have crashed earlier


def worth(policy: Policy, roads: Sequence[int], gamma: float) -> float:
    """What it earns in the first `SECONDS`, discounted, on roads that it drives: the mean."""
    return float(gamma ** np.arange(SECONDS) @ each_second(policy, roads))


def by_set(values: Sequence[float]) -> np.ndarray:
    """A number of each agent, one set of five after the other, as (sets, agents)."""
    return np.reshape(values, (-1, len(METHODS)))
