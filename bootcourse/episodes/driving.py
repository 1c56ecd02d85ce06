"""The one loop that drives episodes: a policy, an environment, one episode on each of its roads.

Evaluation, recording, demonstrations and the planner all read what it yields. The environment is a
gymnasium `VectorEnv`, such as `TrapVectorEnv`; only on the trap is there a true state, `cars`.
"""

from collections.abc import Iterator, Sequence
from typing import NamedTuple

import numpy as np
from gymnasium.vector import VectorEnv

from bootcourse.policies import Policy, PolicyOutput


class Step(NamedTuple):
    """One decision on all roads; each array has the roads first."""

    running: np.ndarray  # (roads,) bool: the episode was not over yet. Of other roads nothing here counts
    observations: np.ndarray  # (roads, observation), before the decision
    cars: np.ndarray | None  # (roads, vehicles, 10) the true state before the decision; None off the trap
    output: PolicyOutput  # what the policy decided
    rewards: np.ndarray  # (roads,)
    terminated: np.ndarray  # (roads,) bool: an accident, or another end that leaves no future
    truncated: np.ndarray  # (roads,) bool: out of time
    next_observations: np.ndarray  # (roads, observation), also of an episode that ended here
    next_cars: np.ndarray | None  # (roads, vehicles, 10), the environment's own array: copy it to keep it
    infos: dict  # as the environment gives them


def steps(policy: Policy, env: VectorEnv, seeds: Sequence[int] | int) -> Iterator[Step]:
    """Drive one episode on each road of `env`, reset with `seeds`; yields each decision until all are over.

    A policy with a method `reset(roads)` is reset first: one that follows a plan begins anew.
    """
    if hasattr(policy, "reset"):
        policy.reset(env.num_envs)
    observations, _ = env.reset(seed=seeds)
    running = np.ones(env.num_envs, dtype=bool)
    while running.any():
        cars = env.cars.copy() if hasattr(env, "cars") else None
        output = policy(observations, cars)
        seen, rewards, terminated, truncated, infos = env.step(output.actions)
        reached = reached_observations(seen, infos)
        yield Step(
            running, observations, cars, output, rewards, terminated, truncated, reached,
            getattr(env, "cars", None), infos,
        )  # fmt: skip
        running = running & ~(terminated | truncated)
        observations = seen


def reached_observations(observations: np.ndarray, infos: dict) -> np.ndarray:
    """What each road shows after a step; where same-step autoreset began an episode anew, the last of the old one."""
    if "final_obs" not in infos:
        return observations
    reached, ended = observations.copy(), infos["_final_obs"]
    reached[ended] = np.stack(infos["final_obs"][ended])
    return reached
