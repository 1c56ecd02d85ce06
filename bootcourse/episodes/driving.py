"""The loop that drives one episode on each road of an environment; evaluation, recording and demonstrations use it.

The environment is a gymnasium `VectorEnv`, such as `TrapVectorEnv`; only the trap has a true state, `cars`.
"""

from collections.abc import Callable, Iterator, Sequence
from typing import NamedTuple

import numpy as np
from gymnasium.vector import VectorEnv

from bootcourse.errors import naming
from bootcourse.policies import Policy, PolicyOutput


class Step(NamedTuple):
    """One decision on all roads; the first axis of each array is the roads."""

    running: np.ndarray  # (roads,) bool: the episode was not over; ignore all other values of roads where it was
    observations: np.ndarray  # (roads, observation), before the decision
    cars: np.ndarray | None  # (roads, vehicles, 10) the true state before the decision; None off the trap
    output: PolicyOutput  # the policy's decision
    rewards: np.ndarray  # (roads,)
    terminated: np.ndarray  # (roads,) bool: the episode ended in an accident or another terminal state
    truncated: np.ndarray  # (roads,) bool: the episode's time is over
    next_observations: np.ndarray  # (roads, observation); of an episode that ended, its last
    next_cars: np.ndarray | None  # (roads, vehicles, 10), the environment's array, which changes: copy it to keep it
    infos: dict  # the environment's


def steps(policy: Policy, env: VectorEnv, seeds: Sequence[int] | int) -> Iterator[Step]:
    """Drive one episode on each road of `env`, reset with `seeds`; yields each decision until all are over.

    A policy with a method `reset(roads)` is reset first. A rule's RuleFailed names the road's seed and the decision.
    """
    if hasattr(policy, "reset"):
        policy.reset(env.num_envs)
    observations, _ = env.reset(seed=seeds)
    running = np.ones(env.num_envs, dtype=bool)
    while running.any():
        cars = env.cars.copy() if hasattr(env, "cars") else None
        with naming(place(seeds, getattr(env, "decisions", None))):
            output = policy(observations, cars)
        seen, rewards, terminated, truncated, infos = env.step(output.actions)
        reached = reached_observations(seen, infos)
        yield Step(
            running, observations, cars, output, rewards, terminated, truncated, reached,
            getattr(env, "cars", None), infos,
        )  # fmt: skip
        running = running & ~(terminated | truncated)
        observations = seen


def place(seeds: Sequence[int] | int, decisions: np.ndarray) -> Callable[[int], str]:
    """For `errors.naming`: a road's seed, and how many decisions were made on it, (roads,)."""

    def words(road: int) -> str:
        seed = seeds[road] if np.iterable(seeds) else seeds + road
        return f"on the road with seed {seed}, at decision {decisions[road]}"

    return words


def reached_observations(observations: np.ndarray, infos: dict) -> np.ndarray:
    """The observations that a step led to, (roads, observation): where autoreset has restarted, the old episode's last.

    observations, infos: as returned by the environment's `step`.
    """
    if "final_obs" not in infos:
        return observations
    reached, ended = observations.copy(), infos["_final_obs"]
    reached[ended] = np.stack(infos["final_obs"][ended])
    return reached
