"""The traffic: when a driver changes lane, and that no car leaves the road or touches another."""

from dataclasses import replace

import gymnasium as gym
import numpy as np
from gymnasium.vector import AutoresetMode

import bootcourse  # noqa: F401  registers the road
from bootcourse.road.constants import constants
from bootcourse.road.state import CRASHED, HEADING, LANE, SPEED, TARGET_LANE, TIMER, TRAFFIC, X, Y
from bootcourse.road.traffic import look_around, sort_by_x
from bootcourse.rule import rule
from bootcourse.scenario import DEFAULT, IDLE, Scenario, Traffic

DRIVER, SLOW_CAR, FOLLOWER = TRAFFIC, TRAFFIC + 1, TRAFFIC + 2


def scene(scenario: Scenario, places: dict[int, tuple]) -> gym.vector.VectorEnv:
    """One road with cars at places {row: (x, lane, speed)}; all others are far away."""
    env = gym.make_vec("bootcourse:Trap-v0", num_envs=1, scenario=scenario, record=True).unwrapped
    env.reset(seed=0)
    cars = env.cars[0]
    cars[1:, X] = 2000.0 + 200.0 * np.arange(len(cars) - 1)
    cars[1:, TIMER] = 0.0
    for row, (x, lane, speed) in places.items():
        cars[row, [X, Y, LANE, TARGET_LANE, SPEED]] = [x, lane * 4.0, lane, lane, speed]
    return env


def wants_to_change(politeness: float, follower_gap: float | None) -> bool:
    """A driver at 10 m/s, 20 m behind a car as fast, in the left of two lanes' worth of traffic.

    Its own gain from the empty lane to its right: 0.5 (1 - 0.4096) + 0.48605 = 0.78125 m/s².
    """
    places = {DRIVER: (500.0, 0, 10.0), SLOW_CAR: (520.0, 0, 10.0)}
    if follower_gap is not None:
        places[FOLLOWER] = (500.0 - follower_gap, 1, 10.0)
    scenario = Scenario(traffic=Traffic(cars=3, politeness=politeness))
    env = scene(scenario, places)
    env.cars[0, DRIVER, TIMER] = 1.5  # it is this driver's moment to think; the others' comes later
    env.step(np.array([IDLE]))
    return env.cars[0, DRIVER, TARGET_LANE] == 1


def test_mobil_changes_into_an_empty_lane_when_the_car_ahead_is_too_close():
    assert wants_to_change(politeness=0.5, follower_gap=None)


def test_mobil_never_changes_when_the_new_follower_would_have_to_brake_too_hard():
    # the follower, 12 m behind: 0.5 (1 - 0.4096 - (25 / 12)²) = -1.875, allowed; 11 m: -2.287, over 2 m/s²
    assert wants_to_change(politeness=0.0, follower_gap=12.0)
    assert not wants_to_change(politeness=0.0, follower_gap=11.0)


def test_a_polite_driver_leaves_the_lane_to_its_follower_and_a_rude_one_takes_it():
    # the follower, 15 m behind, loses 0.5 (25 / 15)² = 1.3889: 0.78125 - 0.5 x 1.3889 = 0.087 < 0.2
    assert not wants_to_change(politeness=0.5, follower_gap=15.0)
    assert wants_to_change(politeness=0.0, follower_gap=15.0)
    # 20 m behind it loses 0.78125, and 0.39 of gain is left
    assert wants_to_change(politeness=0.5, follower_gap=20.0)


def test_the_traps_never_change_lane():
    env = gym.make_vec("bootcourse:Trap-v0", num_envs=64, autoreset_mode=AutoresetMode.DISABLED).unwrapped
    env.reset(seed=0)
    traps = env.cars[:, 1:3, [Y, LANE, HEADING]].copy()
    for _ in range(150):
        env.step(rule(env.cars, DEFAULT).actions)
        assert (env.cars[:, 1:3, [Y, LANE, HEADING]] == traps).all()


def neighbours_by_search(cars: np.ndarray, i: int, lane: int) -> tuple[int, int]:
    """Rows of the nearest car ahead of car i and behind it in a lane, from the definition; -1 for nobody."""
    there = [j for j in range(len(cars)) if j != i and abs(cars[j, Y] - 4.0 * lane) <= 3.0]
    ahead = [j for j in there if cars[j, X] > cars[i, X]]
    behind = [j for j in there if cars[j, X] < cars[i, X]]
    return min(ahead, key=lambda j: cars[j, X], default=-1), max(behind, key=lambda j: cars[j, X], default=-1)


def test_everybody_sees_the_nearest_car_ahead_and_behind_in_every_lane():
    rng, c = np.random.default_rng(0), constants(DEFAULT)
    order, around = np.arange(9), np.zeros((3, 9, 2), dtype=np.int64)
    for _ in range(200):
        cars = np.zeros((9, 10))
        cars[:, X], cars[:, Y] = rng.uniform(0, 200, 9), rng.uniform(-2, 10, 9)  # some between two lanes
        sort_by_x(cars, order)
        look_around(cars, order, around, c)
        expected = [[neighbours_by_search(cars, i, lane) for i in range(9)] for lane in range(3)]
        assert (around == expected).all()


def lost_traffic(scenario: Scenario, episodes: int, seed: int) -> tuple[np.ndarray, np.ndarray]:
    """In which episodes of the rule did a traffic car leave the road, and in which touch another?"""
    env = gym.make_vec(
        "bootcourse:Trap-v0", num_envs=episodes, scenario=scenario, autoreset_mode=AutoresetMode.DISABLED, record=True
    ).unwrapped
    env.reset(seed=seed)
    edge = (scenario.road.lanes - 0.5) * scenario.road.lane_width
    left, touched = np.zeros(episodes, dtype=bool), np.zeros(episodes, dtype=bool)
    while not env.asleep.all():
        awake = ~env.asleep
        env.step(rule(env.cars, scenario).actions)
        y, crashed = env.trace[awake, :, 1:, Y], env.trace[awake, :, 1:, CRASHED]
        left[awake] |= ((y < -scenario.road.lane_width / 2) | (y > edge)).any(axis=(1, 2))
        touched[awake] |= crashed.any(axis=(1, 2))
    return left, touched


def test_no_traffic_car_leaves_the_road_or_touches_another_in_1000_episodes_of_the_rule():
    left, touched = lost_traffic(DEFAULT, episodes=1000, seed=50_000)
    assert not left.any() and not touched.any()


def test_highway_envs_own_steering_gains_lose_traffic_cars_at_2_hz_and_none_at_15_hz_where_it_uses_them():
    unstable = Scenario(traffic=replace(DEFAULT.traffic, tau_heading=0.2, tau_lateral=0.6))
    left, _ = lost_traffic(unstable, episodes=100, seed=0)
    assert left.mean() > 0.1
    crowded = replace(unstable, traffic=replace(unstable.traffic, lead=20.0, headway=20.0))
    _, touched = lost_traffic(crowded, episodes=100, seed=0)
    assert touched.mean() > 0.03
    faster = Scenario(
        clock=replace(DEFAULT.clock, simulation_rate=15),
        traffic=replace(DEFAULT.traffic, tau_heading=0.2, tau_lateral=0.6),
    )
    left, touched = lost_traffic(faster, episodes=50, seed=0)
    assert not left.any() and not touched.any()
