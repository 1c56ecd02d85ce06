"""The loop that drives one episode on each road of an environment; evaluation, recording and demonstrations use it.

The environment is a gymnasium `VectorEnv`, such as `TrapVectorEnv`. Off the trap, observations take the place of the
true state (see place.py).
"""

from collections.abc import Callable, Iterator, Sequence
from typing import NamedTuple

import numpy as np
from gymnasium.spaces import Box, Discrete
from gymnasium.vector import AutoresetMode, SyncVectorEnv, VectorEnv

from bootcourse.episodes.place import place_of
from bootcourse.errors import require
from bootcourse.policies import Policy, PolicyOutput, check_policy
from bootcourse.road.vector_env import TrapVectorEnv
from bootcourse.scenario import DEFAULT, Scenario


class Step(NamedTuple):
    """One decision on all roads; the first axis of each array is the roads."""

    running: np.ndarray  # (roads,) bool: the episode was not over; ignore all other values of roads where it was
    observations: np.ndarray  # (roads, observation), before the decision
    cars: np.ndarray  # (roads, vehicles, 10) the true state before the decision; the observations off the trap
    output: PolicyOutput  # the policy's decision
    rewards: np.ndarray  # (roads,)
    terminated: np.ndarray  # (roads,) bool: the episode ended in an accident or another terminal state
    truncated: np.ndarray  # (roads,) bool: the episode's time is over
    next_observations: np.ndarray  # (roads, observation); of an episode that ended, its last
    next_cars: np.ndarray  # (roads, vehicles, 10), the environment's array, which changes: copy it to keep it
    infos: dict  # the environment's


def steps(policy: Policy, env: VectorEnv, seeds: Sequence[int] | int) -> Iterator[Step]:
    """Drive one episode on each road of `env`, reset with `seeds`; yields each decision until all are over.

    A policy with a method `reset(roads)` is reset first. Raises BootcourseError for what is no policy.
    """
    if (reset := getattr(check_policy(policy), "reset", None)) is not None:
        reset(env.num_envs)
    place = place_of(env)
    observations, _ = env.reset(seed=seeds)  # type: ignore[arg-type]
    running = np.ones(env.num_envs, dtype=bool)
    while running.any():
        cars = place.state(env, observations).copy()
        output = policy(observations, cars)
        seen, rewards, terminated, truncated, infos = env.step(output.actions)
        reached = reached_observations(seen, infos)
        yield Step(
            running, observations, cars, output, rewards, terminated, truncated, reached,
            place.state_reached(env, reached, infos), infos,
        )  # fmt: skip
        running = running & ~(terminated | truncated)
        observations = seen


def reached_observations(observations: np.ndarray, infos: dict) -> np.ndarray:
    """The observations that a step led to, (roads, observation): where autoreset has restarted, the old episode's last.

    observations, infos: as returned by the environment's `step`.
    """
    if "final_obs" not in infos:
        return observations
    reached, ended = observations.copy(), infos["_final_obs"]
    reached[ended] = np.stack(infos["final_obs"][ended])
    return reached


def one_episode_each(n: int, scenario: Scenario | None, make_env: Callable[[int], VectorEnv] | None) -> VectorEnv:
    """What `steps` drives: n roads that stand still when their episode is over; with make_env, its copies instead."""
    if make_env is None:
        return TrapVectorEnv(n, scenario or DEFAULT, AutoresetMode.DISABLED)
    return copies_of(make_env, n)


def copies_of(make_env: Callable[[int], VectorEnv], n: int) -> VectorEnv:
    """make_env(n), with same-step autoreset: an episode that ends is restarted in the same call of `step`.

    `gym.make_vec` makes environments that restart in the next call. A `SyncVectorEnv` is made again. Raises
    BootcourseError if make_env(n) is not a vector environment of n copies, if it cannot restart in the same call, and
    if this library cannot learn with its actions or observations.
    """
    wanted = "give a function of n, such as lambda n: gym.make_vec('MountainCar-v0', n)"
    require(callable(make_env), f"make_env = {make_env!r:.80}: {wanted}.")
    env = make_env(n)
    is_right = isinstance(env, VectorEnv) and env.num_envs == n
    require(is_right, f"make_env({n}) returned {env!r:.80}, no vector environment of {n} copies: {wanted}.")
    name, actions, observations = place_of(env).name, env.single_action_space, env.single_observation_space
    discrete = " gymnasium.wrappers.DiscretizeAction(env, bins=5) makes them of a Box." * isinstance(actions, Box)
    require(
        isinstance(actions, Discrete) and actions.start == 0,
        f"{name} has actions of {actions}: this library learns Discrete(n), from 0.{discrete}",
    )
    is_vector = len(observations.shape or ()) == 1
    require(is_vector, f"{name} shows {observations}: flatten it to a vector, as with FlattenObservation.")
    if type(env) is SyncVectorEnv and env.metadata.get("autoreset_mode") is not AutoresetMode.SAME_STEP:
        env.close()
        env = SyncVectorEnv(env.env_fns, autoreset_mode=AutoresetMode.SAME_STEP)
    require(
        env.metadata.get("autoreset_mode") is AutoresetMode.SAME_STEP,
        f"{name} does not restart an episode in the step that ends it: make it with vectorization_mode='sync'. "
        "(With vectorization_mode='async', add vector_kwargs={'autoreset_mode': 'SameStep'}.)",
    )
    return env
