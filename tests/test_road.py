"""`gym.make` and `gym.make_vec`: what gymnasium, other libraries and a user's mistakes may expect of them."""

import warnings
from dataclasses import replace

import gymnasium as gym
import numpy as np
import pytest
from gymnasium.utils.env_checker import check_env
from gymnasium.vector import AutoresetMode, VectorEnv

import bootcourse  # noqa: F401  registers the road
from bootcourse.errors import BootcourseError
from bootcourse.road.state import EGO, LANE, SPEED, TRAP_1, TRAP_2, Accident, X, Y
from bootcourse.road.trap_env import TrapEnv
from bootcourse.scenario import DEFAULT, IDLE, Clock

RIGHT, BRAKE = 5, 1


def make(**options) -> gym.Env:
    return gym.make("bootcourse:Trap-v0", **options)


def make_vec(num_envs: int, **options) -> VectorEnv:
    return gym.make_vec("bootcourse:Trap-v0", num_envs=num_envs, **options)


def drive(env: gym.Env, action: int, seed: int = 0):
    """One episode of one action: (return, last info, decisions)."""
    env.reset(seed=seed)
    total, decisions, over = 0.0, 0, False
    while not over:
        _, reward, terminated, truncated, info = env.step(action)
        total, decisions, over = total + reward, decisions + 1, terminated or truncated
    return total, info, decisions


# TrapEnv


def test_the_road_passes_gymnasiums_checks_without_a_warning_about_our_spaces():
    with warnings.catch_warnings(record=True) as caught:
        warnings.simplefilter("always")
        check_env(make(render_mode="rgb_array").unwrapped)
    messages = [str(warning.message) for warning in caught]
    assert not [message for message in messages if "space" in message or "render" in message], messages


def test_the_ego_that_does_nothing_earns_23_4375_and_drives_1500_metres():
    total, info, decisions = drive(make(), IDLE)
    assert total == pytest.approx(23.4375, abs=1e-9)
    assert [info[name] for name in ("r_v", "r_y", "r_theta", "speed")] == pytest.approx([2 / 15, 1.0, 0.0, 10.0])
    assert info["distance"] == pytest.approx(1500.0, abs=1e-9)
    assert (decisions, info["accident"], info["is_success"]) == (150, Accident.NONE, False)


@pytest.mark.parametrize(
    ("action", "accident"), [(BRAKE, Accident.STOPPAGE), (RIGHT, Accident.ROAD_DEPARTURE), (7, Accident.COLLISION)]
)
def test_each_accident_ends_the_episode_and_costs_10(action, accident):
    env = make()
    env.reset(seed=1)
    over = False
    while not over:
        _, reward, over, truncated, info = env.step(action)
        assert not truncated
    assert info["accident"] == accident
    assert reward == -10.0


def test_the_traps_stand_where_the_scenario_says():
    env, starts = make(), []
    for seed in range(50):
        env.reset(seed=seed)
        starts.append(env.unwrapped.cars())
    starts = np.array(starts)
    assert (starts[:, EGO, [X, Y, SPEED, LANE]] == [0.0, 8.0, 10.0, 2.0]).all()
    d1, d2 = starts[:, TRAP_1, X], starts[:, TRAP_2, X]
    assert 14.80 <= d1.min() < 15.0 and 16.2 < d1.max() <= 16.44
    assert 4.06 <= d2.min() < 4.4 and 7.1 < d2.max() <= 7.43
    assert (starts[:, TRAP_1, Y] == 8.0).all() and (starts[:, TRAP_2, Y] == 4.0).all()
    assert set(starts[:, 3:, LANE].ravel()) == {0.0, 1.0, 2.0}
    assert (starts[:, 3:, SPEED] >= 11.0).all() and (starts[:, 3:, SPEED] <= 12.5).all()
    spacing = np.diff(starts[:, 3:, X], axis=1)
    assert spacing.min() >= 20.0 and spacing.max() <= 60.0


def test_the_same_seed_gives_the_same_episode_and_another_seed_another():
    env = make()
    first, second, third = (env.reset(seed=seed)[0] for seed in (5, 5, 6))
    assert (first == second).all() and (first != third).any()
    env.action_space.seed(3)
    sampled = [env.action_space.sample() for _ in range(5)]
    env.reset(seed=5)
    env.action_space.seed(3)
    env.reset()
    assert [env.action_space.sample() for _ in range(5)] == sampled, "a reset must not forget the space's seed"


def test_rendered_frames_are_not_blank():
    env = make(render_mode="rgb_array")
    env.reset(seed=0)
    first = env.render()
    for _ in range(3):
        env.step(8)
    later = env.render()
    env.close()
    assert first.shape == later.shape and first.dtype == np.uint8 and first.shape[2] == 3
    for colour in ((122, 31, 31), (213, 94, 0)):  # a trap and the ego
        assert (np.abs(first.astype(int) - colour).sum(axis=2) < 30).any()
    assert first.std() > 5 and (first != later).any()


# Under another library


def test_it_trains_unmodified_under_stable_baselines3():
    stable_baselines3 = pytest.importorskip("stable_baselines3")
    short = replace(DEFAULT, clock=Clock(decisions=20))
    env = make(scenario=short)
    agent = stable_baselines3.DQN(
        "MlpPolicy", env, learning_starts=50, batch_size=16, buffer_size=1000, seed=0, policy_kwargs={"net_arch": [16]}
    )
    before = [weights.detach().clone() for weights in agent.policy.parameters()]
    agent.learn(300)
    assert agent.num_timesteps == 300
    assert any((old != new).any() for old, new in zip(before, agent.policy.parameters(), strict=True))
    action, _ = agent.predict(env.reset(seed=0)[0], deterministic=True)
    assert env.action_space.contains(int(action))


# The compiled road as a VectorEnv


def test_make_vec_is_a_true_vector_env_with_a_declared_autoreset_mode():
    env = make_vec(5)
    assert isinstance(env, VectorEnv) and env.num_envs == 5
    assert env.metadata["autoreset_mode"] is AutoresetMode.SAME_STEP
    assert make_vec(5, autoreset_mode=AutoresetMode.DISABLED).metadata["autoreset_mode"] is AutoresetMode.DISABLED
    single = make()
    assert env.single_observation_space == single.observation_space
    assert env.single_action_space == single.action_space
    observations, _ = env.reset(seed=0)
    assert observations.shape == (5, 26) and env.observation_space.contains(observations)
    observations, rewards, terminated, truncated, _ = env.step(env.action_space.sample())
    assert env.observation_space.contains(observations)
    assert rewards.shape == terminated.shape == truncated.shape == (5,)
    assert (rewards.dtype, terminated.dtype, truncated.dtype) == (np.float64, np.bool_, np.bool_)


def test_road_i_drives_what_trap_env_drives_from_seed_plus_i():
    observations, _ = make_vec(4).reset(seed=10)
    again, _ = make_vec(2).reset(seed=[13, 10])
    single = make()
    assert (observations == [single.reset(seed=seed)[0] for seed in range(10, 14)]).all()
    assert (again == observations[[3, 0]]).all()


def test_a_road_that_ends_starts_anew_in_the_same_step_and_reports_how_it_ended():
    env = make_vec(3)
    env.reset(seed=0)
    actions = np.array([IDLE, BRAKE, IDLE])
    for _ in range(9):
        _, _, terminated, truncated, infos = env.step(actions)
        assert not (terminated | truncated).any() and "final_obs" not in infos
    observations, rewards, terminated, truncated, infos = env.step(actions)
    assert terminated.tolist() == [False, True, False] and not truncated.any()
    assert rewards.tolist() == pytest.approx([0.15625, -10.0, 0.15625])
    assert infos["_final_obs"].tolist() == infos["_final_info"].tolist() == [False, True, False]
    assert infos["final_obs"][0] is None and infos["final_obs"][1].shape == (26,)
    assert infos["final_obs"][1][3] * 15 < 1.0, "the last observation shows the stop"
    assert infos["final_info"]["accident"][1] == Accident.STOPPAGE
    assert infos["final_info"]["speed"][1] < 1.0
    assert (infos["accident"] == 0).all() and infos["distance"][1] == 0.0
    assert observations[1][3] * 15 == pytest.approx(10.0), "the new episode starts at 10 m/s"
    assert env.unwrapped.decisions.tolist() == [10, 0, 10]
    assert env.unwrapped.final_cars[1, EGO, SPEED] < 1.0


def test_without_autoreset_a_finished_road_rests_until_all_are_reset():
    env = make_vec(3, autoreset_mode=AutoresetMode.DISABLED)
    env.reset(seed=0)
    actions = np.array([IDLE, BRAKE, IDLE])
    for _ in range(10):
        observations, _, terminated, _, _ = env.step(actions)
    assert terminated.tolist() == [False, True, False]
    stopped = observations[1].copy()
    observations, rewards, terminated, _, infos = env.step(actions)
    assert rewards[1] == 0.0 and (observations[1] == stopped).all() and terminated[1]
    assert infos["_speed"].tolist() == [True, False, True], "a resting road has nothing to say"
    env.reset()
    assert env.step(np.full(3, IDLE))[1] == pytest.approx([0.15625] * 3)


def test_returned_arrays_belong_to_the_caller():
    env = make_vec(2)
    first, _ = env.reset(seed=0)
    unchanged = first.copy()
    second, rewards, _, _, infos = env.step(np.array([IDLE, BRAKE]))
    rewards_before, speeds_before = rewards.copy(), infos["speed"].copy()
    env.step(np.array([BRAKE, BRAKE]))
    assert (first == unchanged).all() and (rewards == rewards_before).all() and (infos["speed"] == speeds_before).all()


MISTAKES = [
    *[(lambda action=action: drive(make().unwrapped, action), "outside 0..8") for action in (9, -1, 4.0)],
    (lambda: make(scenario="defualt"), "'defualt' is unknown: did you mean 'default'"),
    (lambda: make(scenario=3), "scenario = 3: give a Scenario, the name of one, or a dictionary"),
    (lambda: TrapEnv(render_mode="ansi"), "render_mode"),
    (lambda: make_vec(0), "num_envs = 0"),
    (lambda: make_vec(2, scenario="defualt"), "'defualt' is unknown: did you mean 'default'"),
    (lambda: make_vec(2).reset(seed=[1, 2, 3]), "3 seeds for 2 roads"),
    (lambda: make_vec(2).reset(seed=[1, -2]), "seed = -2: give a whole number"),
    (lambda: make_vec(2).step(np.array([4, 9])), "Action 9 is outside 0..8"),
    (lambda: make_vec(2).step(np.array([4.0, 4.0])), "give 2 whole numbers"),
]


@pytest.mark.parametrize(("mistake", "words"), MISTAKES)
def test_a_mistake_is_one_sentence(mistake, words):
    with pytest.raises(BootcourseError) as refusal:
        mistake()
    assert words in str(refusal.value) and "\n" not in str(refusal.value)
