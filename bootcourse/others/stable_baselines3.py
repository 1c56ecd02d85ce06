"""Stable-Baselines3 on the compiled roads: its vector environment, its demonstrations, its policies as ours.

    from bootcourse.others.stable_baselines3 import TrapVecEnv, as_policy
    model = stable_baselines3.PPO("MlpPolicy", TrapVecEnv(16)).learn(100_000)
    bc.evaluate(as_policy(model))

Stable-Baselines3 is no part of the kit: `pip install 'bootcourse[others]'`.
"""

import numpy as np
import torch
from stable_baselines3.common.base_class import BaseAlgorithm
from stable_baselines3.common.buffers import ReplayBuffer
from stable_baselines3.common.on_policy_algorithm import OnPolicyAlgorithm
from stable_baselines3.common.vec_env import VecEnv

from bootcourse.errors import BootcourseError
from bootcourse.learn.replay_buffer import decode_transitions
from bootcourse.policies import Policy, PolicyOutput
from bootcourse.road.vector_env import TrapVectorEnv
from bootcourse.scenario import DEFAULT, Scenario


class TrapVecEnv(VecEnv):
    """`num_envs` compiled roads, `roads`, as a VecEnv: road i, seeded with `seed`, is `TrapEnv`'s of `seed + i`.

    An episode that ends starts anew in the same step; its last observation is infos[i]["terminal_observation"], and
    infos[i]["TimeLimit.truncated"] says whether its time was over.
    """

    def __init__(self, num_envs: int = 1, scenario: Scenario | str | dict = DEFAULT):
        self.roads = TrapVectorEnv(num_envs, scenario)
        super().__init__(num_envs, self.roads.single_observation_space, self.roads.single_action_space)

    def reset(self) -> np.ndarray:
        """Start an episode on each road, with the seeds of the last call of `seed`, once. Returns (num_envs, 26)."""
        observations, infos = self.roads.reset(seed=self._seeds)
        self.reset_infos = one_by_one(infos, self.num_envs)
        self._reset_seeds()
        return observations

    def step_async(self, actions: np.ndarray) -> None:
        """Note the actions, (num_envs,), for `step_wait`."""
        self._actions = actions

    def step_wait(self):
        """One decision on every road: observations (num_envs, 26), rewards and ends (num_envs,), infos."""
        observations, rewards, terminated, truncated, infos = self.roads.step(self._actions)
        each, done = one_by_one(infos, self.num_envs), terminated | truncated
        if done.any():
            final = one_by_one(infos["final_info"], self.num_envs)
            for i in np.flatnonzero(done):
                last = {"terminal_observation": infos["final_obs"][i], "TimeLimit.truncated": bool(truncated[i])}
                each[i] = final[i] | last
        return observations, rewards.astype(np.float32), done, each

    def close(self) -> None:
        """Nothing has to be closed."""

    def get_attr(self, attr_name: str, indices=None) -> list:
        """An attribute of the roads, once for each of the indices."""
        return [getattr(self.roads, attr_name) for _ in self._get_indices(indices)]

    def set_attr(self, attr_name: str, value, indices=None) -> None:
        """Raises BootcourseError: the roads are one object."""
        raise BootcourseError(f"'{attr_name}' cannot be set for single roads: make a TrapVecEnv of another scenario.")

    def env_method(self, method_name: str, *args, indices=None, **kwargs) -> list:
        """Raises BootcourseError: the roads are one object."""
        raise BootcourseError(f"'{method_name}' cannot be called for single roads: call it on the attribute `roads`.")

    def env_is_wrapped(self, wrapper_class, indices=None) -> list[bool]:
        """No road is wrapped."""
        return [False for _ in self._get_indices(indices)]


def one_by_one(infos: dict, roads: int) -> list[dict]:
    """gymnasium's infos of many roads, {name: (roads,)}, as a dictionary for each road."""
    columns = {name: values.tolist() for name, values in infos.items() if isinstance(values, np.ndarray)}
    columns = {name: values for name, values in columns.items() if not name.startswith("_") and name != "final_obs"}
    return [dict(zip(columns, row, strict=True)) for row in zip(*columns.values(), strict=True)] or [{}] * roads


def as_policy(model: BaseAlgorithm) -> Policy:
    """The model's most probable actions as one of our policies, for `bc.evaluate`, `bc.record`, `bc.board` ..."""
    return lambda observations, cars: PolicyOutput(model.predict(observations, deterministic=True)[0])


def add_demonstrations(buffer: ReplayBuffer, rows: torch.Tensor, bonus: float = 0.0) -> None:
    """Put the rows of `bc.collect`, (transitions, row), into a replay buffer, with `bonus` added to each reward.

    A buffer of n roads takes n transitions at a time; less than n at the end are left out. Raises BootcourseError if
    they do not fit.
    """
    batch = decode_transitions(rows, buffer.observation_space.shape[0], torch.ones(len(rows)))
    whole = len(rows) // buffer.n_envs
    if whole > buffer.buffer_size:
        size = f"{buffer.buffer_size} times {buffer.n_envs} transitions"
        raise BootcourseError(f"{len(rows):,} demonstrated transitions do not fit a buffer of {size}: make it larger.")
    columns = (batch.states, batch.next_states, batch.actions, batch.rewards + bonus, batch.terminated)
    parts = (column[: whole * buffer.n_envs].numpy().reshape(whole, buffer.n_envs, -1) for column in columns)
    for states, next_states, actions, rewards, terminated in zip(*parts, strict=True):
        buffer.add(states, next_states, actions, rewards[:, 0], terminated[:, 0], [{}] * buffer.n_envs)


def clone(model: OnPolicyAlgorithm, rows: torch.Tensor, updates: int = 2_000, batch: int = 256, seed: int = 0) -> None:
    """Behaviour cloning: fit the model's policy to the actions of rows of `bc.collect`, by maximum likelihood.

    updates: gradient steps of the policy's own optimiser, with `batch` transitions each.
    """
    data = decode_transitions(rows, model.observation_space.shape[0], torch.ones(len(rows)))
    generator = torch.Generator().manual_seed(seed)
    for _ in range(updates):
        some = torch.randint(len(rows), (batch,), generator=generator)
        _, log_probability, _ = model.policy.evaluate_actions(data.states[some], data.actions[some])
        model.policy.optimizer.zero_grad()
        (-log_probability.mean()).backward()
        model.policy.optimizer.step()
