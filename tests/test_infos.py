"""What environments report in `info`, against a slow loop over single ones."""

import gymnasium as gym
import numpy as np
import pytest
from gymnasium.vector import AutoresetMode, SyncVectorEnv

from bootcourse.episodes.evaluate import drive_episodes
from bootcourse.episodes.infos import known_success, reported
from bootcourse.learn.settings import settings_for
from bootcourse.learn.training import Training
from bootcourse.policies import PolicyOutput

NAMES = ("speed", "distance", "is_success", "accident", "nowhere")


class Odd(gym.Env):
    """An episode of 2 to 6 decisions. What it reports is not what another environment would."""

    observation_space, action_space = gym.spaces.Box(0, 100, (2,), np.float32), gym.spaces.Discrete(2)

    def reset(self, *, seed=None, options=None):
        super().reset(seed=seed)
        self.time, self.last = 0, int(self.np_random.integers(2, 7))
        return np.full(2, self.last, np.float32), {"speed": -1.0, "distance": -1.0}

    def step(self, action):
        self.time += 1
        ended = self.time == self.last
        info = {"speed": 10.0, "accident": np.zeros(3)}  # this accident is no number
        info |= {"distance": 10.0 * self.time} if self.time % 2 == 0 else {}
        info |= {"is_success": True} if ended and self.last > 4 else {}
        return np.full(2, self.last, np.float32), 1.0, ended, False, info


def slow(info: dict) -> list[float]:
    return [float(info[name]) if name in info and np.ndim(info[name]) == 0 else np.nan for name in NAMES]


@pytest.mark.parametrize("mode", AutoresetMode)
def test_the_reports_of_many_are_those_of_each_alone(mode):
    alone, together = [Odd() for _ in range(5)], SyncVectorEnv([Odd] * 5, autoreset_mode=mode)
    together.reset(seed=3)
    for number, env in enumerate(alone):
        env.reset(seed=3 + number)
    over, episodes = np.zeros(5, dtype=bool), 0
    for _ in range(40):
        if mode is AutoresetMode.DISABLED and over.any():
            together.reset(options={"reset_mask": over})
        for env in (env for env, is_over in zip(alone, over, strict=True) if is_over):
            env.reset()
        *_, infos = together.step(np.zeros(5, dtype=int))
        decides = ~over | (mode is not AutoresetMode.NEXT_STEP)  # there, the step after an end is a reset alone
        steps = [env.step(0) if decides[number] else None for number, env in enumerate(alone)]
        found = np.stack([reported(name, infos, 5) for name in NAMES], axis=1)
        for number in np.flatnonzero(decides):
            np.testing.assert_array_equal(found[number], slow(steps[number][4]))
        over = np.array([step is not None and step[2] for step in steps])
        episodes += over.sum()
    assert episodes > 30


def test_a_vector_environment_without_masks_reports_for_all_and_objects_count_if_they_are_numbers():
    infos = {"speed": np.array([1, 2]), "distance": np.array([None, 3.0]), "accident": np.array(["a", True], object)}
    assert reported("speed", infos, 2).tolist() == [1.0, 2.0]
    np.testing.assert_array_equal(reported("distance", infos, 2), [np.nan, 3.0])
    np.testing.assert_array_equal(reported("accident", infos, 2), [np.nan, 1.0])


def test_where_one_episode_reports_a_success_those_that_report_nothing_are_none():
    assert known_success(np.array([np.nan, 1.0, np.nan])).tolist() == [0.0, 1.0, 0.0]
    assert np.isnan(known_success(np.array([np.nan, np.nan]))).all()


def make(n):
    return SyncVectorEnv([Odd] * n)


def test_curves_hold_what_each_episode_reported():
    settings = settings_for("sac", envs_per_agent=3, learning_starts=10_000)
    curves = Training([settings], 60, make_env=make).run(progress=False).curves
    lengths = curves["decisions"][0]
    assert set(lengths) == {2, 3, 4, 5, 6}
    np.testing.assert_array_equal(curves["speed"][0], 10.0)
    np.testing.assert_array_equal(curves["success"][0], lengths > 4)
    np.testing.assert_array_equal(curves["distance"][0], np.where(lengths % 2 == 0, 10 * lengths, np.nan))
    assert np.isnan(curves["accident"]).all()


def test_an_evaluation_holds_them_too():
    def wait(observations, cars):
        return PolicyOutput(np.zeros(len(observations), dtype=int))

    episodes = drive_episodes(wait, range(60), make_env=make, together=25)
    assert set(episodes.returns) == {2, 3, 4, 5, 6}
    np.testing.assert_array_equal(episodes.success, episodes.returns > 4)
    even = episodes.returns % 2 == 0
    np.testing.assert_array_equal(episodes.distance, np.where(even, 10 * episodes.returns, np.nan))
