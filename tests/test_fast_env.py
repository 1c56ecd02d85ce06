"""`bootcourse:FastTrap-v0`: the compiled road for one car, beside the reference on highway-env."""

import copy
import pickle
import warnings

import gymnasium as gym
import numpy as np
import pytest
from gymnasium.utils.env_checker import check_env
from gymnasium.wrappers import TimeAwareObservation

import bootcourse  # noqa: F401  registers the road
from bootcourse.colours import OTHER, TRAP, rgb
from bootcourse.errors import BootcourseError
from bootcourse.scenario import CALIBRATED, IDLE
from tests.agreement import CHAOTIC, DRIVERS, SCENARIOS

BOTH = ("bootcourse:Trap-v0", "bootcourse:FastTrap-v0")


def make(name: str = BOTH[1], **options) -> gym.Env:
    return gym.make(name, **options)


def test_it_passes_gymnasiums_checks():
    with warnings.catch_warnings(record=True) as caught:
        warnings.simplefilter("always")
        check_env(make(render_mode="rgb_array").unwrapped)
    messages = [str(warning.message) for warning in caught]
    assert not [message for message in messages if "space" in message or "render" in message], messages


@pytest.mark.parametrize("name", [name for name in SCENARIOS if name not in CHAOTIC])
def test_it_drives_what_the_reference_drives_in_every_number(name):
    scenario, rng = SCENARIOS[name], np.random.default_rng(1)
    reference, fast = (make(each, scenario=scenario).unwrapped for each in BOTH)
    for turn, driver in enumerate(DRIVERS[:7]):
        seen, also_seen = reference.reset(seed=turn), fast.reset(seed=turn)
        over, decisions = False, 0
        while not over and decisions < 40:
            np.testing.assert_allclose(fast.cars(), reference.cars(), rtol=0, atol=1e-9)
            np.testing.assert_allclose(also_seen[0], seen[0], rtol=0, atol=1e-6)
            assert also_seen[-1] == pytest.approx(seen[-1], abs=1e-9)
            action = int(driver(reference.cars(), scenario, rng))
            seen, also_seen = reference.step(action), fast.step(action)
            assert also_seen[1:4] == (pytest.approx(seen[1], abs=1e-9), *seen[2:4])
            np.testing.assert_allclose(fast.trace[: len(reference.trace)], reference.trace, rtol=0, atol=1e-9)
            over, decisions = seen[2] or seen[3], decisions + 1


@pytest.mark.parametrize("duplicate", [copy.deepcopy, lambda env: pickle.loads(pickle.dumps(env))])
def test_a_copy_in_the_middle_of_a_drive_goes_on_by_itself(duplicate):
    env = make(render_mode="rgb_array")
    env.reset(seed=4)
    env.step(1)
    env.render()
    other = duplicate(env)
    first = [env.step(action)[:2] for action in (0, 0, 2)]
    second = [other.step(action)[:2] for action in (0, 0, 2)]
    for (seen, reward), (also_seen, the_same) in zip(first, second, strict=True):
        assert (seen == also_seen).all() and reward == the_same
    assert (env.reset()[0] == other.reset()[0]).all(), "both draw the same next road"


def test_its_pictures_show_the_ego_and_the_traps_and_move():
    env = make(render_mode="rgb_array")
    env.reset(seed=0)
    first = env.render()
    for _ in range(3):
        env.step(8)
    later = env.render()
    assert first.shape == later.shape == (100, 1000, 3) and first.dtype == np.uint8 and (first != later).any()
    for colour in (TRAP, OTHER.colour):
        assert (np.abs(first.astype(int) - rgb(colour)).sum(axis=2) < 30).any()


@pytest.mark.parametrize("name", BOTH)
def test_the_spec_knows_the_time_limit_the_scenario_and_the_way_back(name):
    env = make(name, scenario=CALIBRATED)
    assert env.spec.max_episode_steps == 150
    assert TimeAwareObservation(env).observation_space.shape == (27,)
    again = gym.make(gym.envs.registration.EnvSpec.from_json(env.spec.to_json()))
    assert again.unwrapped.scenario == CALIBRATED
    assert (again.reset(seed=3)[0] == env.reset(seed=3)[0]).all()


@pytest.mark.parametrize("name", BOTH)
def test_a_shorter_limit_truncates(name):
    env = make(name, max_episode_steps=3)
    env.reset(seed=0)
    assert [env.step(IDLE)[3] for _ in range(3)] == [False, False, True]


@pytest.mark.parametrize("name", BOTH)
@pytest.mark.parametrize(
    ("mistake", "words"),
    [
        (lambda env: env.step(IDLE), r"call env.reset\(seed=0\) before env.step"),
        (lambda env: env.render(), "Nothing is drawn without a render mode"),
        (lambda env: env.reset(seed=-1), "seed = -1: give a whole number"),
        (lambda env: (env.reset(seed=0), env.step(9)), "Action 9 is outside 0..8"),
    ],
)
def test_a_mistake_is_one_sentence(name, mistake, words):
    with pytest.raises(BootcourseError, match=words):
        mistake(make(name).unwrapped)


@pytest.mark.parametrize("name", BOTH)
def test_a_picture_before_the_first_reset_is_refused(name):
    with pytest.raises(BootcourseError, match="before env.render"):
        make(name, render_mode="rgb_array").unwrapped.render()
