"""The compiled roads against gymnasium's own `SyncVectorEnv` of the reference: the same arrays, in every mode."""

from dataclasses import replace

import gymnasium as gym
import numpy as np
import pytest
from gymnasium.vector import AutoresetMode, VectorEnv
from gymnasium.wrappers import vector as wrappers

import bootcourse  # noqa: F401  registers the road
from bootcourse.errors import BootcourseError
from bootcourse.road.vector_env import TrapVectorEnv
from bootcourse.scenario import DEFAULT, IDLE, Clock

ROADS, STEPS = 3, 45
SHORT = replace(DEFAULT, clock=Clock(decisions=12))
RIGHT = 5


def both(mode: AutoresetMode, **options) -> tuple[VectorEnv, VectorEnv]:
    """gymnasium's environment and ours."""
    made = gym.make_vec(
        "bootcourse:Trap-v0", ROADS, vectorization_mode="sync", vector_kwargs={"autoreset_mode": mode}, **options
    )
    return made, gym.make_vec("bootcourse:Trap-v0", ROADS, autoreset_mode=mode, **options)


def check_same(theirs, ours, where: str) -> None:
    """Observations, rewards, masks and infos agree; the values of roads that a mask leaves out are nobody's."""
    assert type(ours) is type(theirs), where
    if isinstance(theirs, tuple):
        for i, (one, other) in enumerate(zip(theirs, ours, strict=True)):
            check_same(one, other, f"{where}, {i}")
    elif isinstance(theirs, dict):
        assert ours.keys() == theirs.keys(), where
        for name, values in theirs.items():
            valid = slice(None)
            if not name.startswith("_") and not isinstance(values, dict):
                valid = theirs[f"_{name}"]
                values = np.stack(values[valid]) if values.dtype == object else values[valid]
            mine = ours[name] if isinstance(values, dict) else ours[name][valid]
            mine = np.stack(mine) if not isinstance(mine, dict) and mine.dtype == object else mine
            check_same(values, mine, f"{where}, {name}")
    else:
        assert ours.dtype == theirs.dtype and ours.shape == theirs.shape, where
        np.testing.assert_allclose(ours, theirs, rtol=0, atol=1e-6, err_msg=where)  # observations are float32


def drive_both(theirs: VectorEnv, ours: VectorEnv) -> int:
    """Drive both with the same actions, which leave the road now and then. Returns how many episodes ended."""
    rng, ended = np.random.default_rng(5), 0
    check_same(theirs.reset(seed=3), ours.reset(seed=3), "reset")
    done = np.zeros(ROADS, dtype=bool)
    for step in range(STEPS):
        if done.any() and ours.metadata["autoreset_mode"] is AutoresetMode.DISABLED:
            for seed in (None, [7, 8, 9]):
                each = (env.reset(seed=seed, options={"reset_mask": done.copy()}) for env in (theirs, ours))
                check_same(*each, f"reset of some roads before step {step}")
        actions = np.where(rng.random(ROADS) < 0.6, RIGHT, rng.integers(9, size=ROADS))
        one, other = theirs.step(actions), ours.step(actions)
        check_same(one, other, f"step {step}")
        done = one[2] | one[3]
        ended += int(done.sum())
    return ended


@pytest.mark.parametrize("limit", [None, 7, 12, 40])
@pytest.mark.parametrize("mode", AutoresetMode)
def test_every_mode_and_every_limit_are_those_of_gymnasium(mode, limit):
    options = {"scenario": SHORT} | ({"max_episode_steps": limit} if limit else {})
    assert drive_both(*both(mode, **options)) > 10


@pytest.mark.parametrize(
    ("name", "arguments"),
    [
        ("NormalizeObservation", {}),
        ("FlattenObservation", {}),
        ("DtypeObservation", {"dtype": np.float16}),
        ("TransformObservation", {"func": lambda seen: 2 * seen, "observation_space": None}),
        ("RescaleObservation", {"min_obs": -1.0, "max_obs": 1.0}),
        ("NormalizeReward", {}),
        ("ClipReward", {"min_reward": -1.0, "max_reward": 1.0}),
        ("DictInfoToList", {}),
    ],
)
def test_gymnasium_s_vector_wrappers_take_the_compiled_roads(name, arguments):
    theirs, ours = (getattr(wrappers, name)(env, **arguments) for env in both(AutoresetMode.NEXT_STEP, scenario=SHORT))
    assert ours.single_observation_space == theirs.single_observation_space
    if name == "DictInfoToList":  # its infos are lists, with whatever the environments wrote
        ours.reset(seed=0)
        assert [info["speed"] for info in ours.step(np.full(ROADS, IDLE))[4]] == pytest.approx([10.0] * ROADS)
    elif name == "NormalizeObservation":  # it divides by the deviations of three roads, some of them 0
        (one, _), (other, _) = theirs.reset(seed=3), ours.reset(seed=3)
        np.testing.assert_allclose(other, one, rtol=1e-3, atol=1e-3)
        assert ours.step(np.full(ROADS, IDLE))[0].shape == (ROADS, 26)
    else:
        assert drive_both(theirs, ours) > 10


def test_episode_statistics_are_the_same_in_the_mode_that_trainings_use():
    theirs, ours = (wrappers.RecordEpisodeStatistics(env) for env in both(AutoresetMode.SAME_STEP, scenario=SHORT))
    rng = np.random.default_rng(0)
    for env in (theirs, ours):
        env.reset(seed=0)
    for _ in range(STEPS):
        actions = np.where(rng.random(ROADS) < 0.6, RIGHT, rng.integers(9, size=ROADS))
        theirs.step(actions), ours.step(actions)
    assert list(ours.length_queue) == list(theirs.length_queue) and len(ours.length_queue) > 5
    assert list(ours.return_queue) == pytest.approx(list(theirs.return_queue))


def test_a_mask_resets_its_roads_only_and_a_finished_road_rests_until_then():
    env = TrapVectorEnv(3, autoreset_mode="Disabled")
    env.reset(seed=0)
    for _ in range(5):
        env.step(np.full(3, IDLE))
    others = env.cars[[0, 2]].copy()
    observations, infos = env.reset(seed=[9, 9, 9], options={"reset_mask": np.array([False, True, False])})
    assert (env.cars[[0, 2]] == others).all() and env.decisions.tolist() == [5, 0, 5]
    assert (observations[1] == TrapVectorEnv(1).reset(seed=9)[0][0]).all()
    assert infos["_speed"].tolist() == [False, True, False]


def with_mask(mask):
    env = TrapVectorEnv(2)
    env.reset(seed=0)
    env.reset(options={"reset_mask": mask})


MISTAKES = [
    (lambda: with_mask([True, False]), "reset_mask = .*an array of 2 booleans"),
    (lambda: with_mask(np.array([1, 0])), "an array of 2 booleans"),
    (lambda: with_mask(np.zeros(2, dtype=bool)), "at least one of them True"),
    (lambda: with_mask(np.ones(3, dtype=bool)), "an array of 2 booleans"),
    (lambda: TrapVectorEnv(2).reset(options={"reset_mask": np.array([True, False])}), "first reset all roads"),
    (lambda: TrapVectorEnv(2).reset(options={"resetmask": 1}), "'resetmask' is unknown: did you mean 'reset_mask'"),
    (lambda: TrapVectorEnv(2, autoreset_mode="NEXT"), "'NEXT': choose from NextStep, SameStep, Disabled"),
    (lambda: TrapVectorEnv(2, autoreset_mode=5), "autoreset_mode = 5: choose from"),
    (lambda: TrapVectorEnv(2, max_episode_steps=0), "max_episode_steps = 0: give a whole number from 1"),
    (lambda: gym.make_vec("bootcourse:Trap-v0", 2, render_mode="human"), "'human': these roads draw nothing"),
    (lambda: TrapVectorEnv(2).step(np.array([4, 4])), r"call env.reset\(seed=0\) before env.step"),
]


@pytest.mark.parametrize(("mistake", "words"), MISTAKES)
def test_a_mistake_is_one_sentence(mistake, words):
    with pytest.raises(BootcourseError, match=words):
        mistake()
