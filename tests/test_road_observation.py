"""The observation, held to a second implementation that shares no line with the first."""

import gymnasium as gym
import numpy as np
import pytest
from gymnasium.vector import AutoresetMode

import bootcourse  # noqa: F401  registers the road
from bootcourse.road.observation import names, scales
from bootcourse.road.state import EGO, X, Y
from bootcourse.scenario import DEFAULT
from tests.agreement import DRIVERS, SCENARIOS


def observation_in_numpy(cars: np.ndarray, scenario) -> np.ndarray:
    """(vehicles, 10) -> the numbers of one decision, from the definition in the paper's Section III-C."""
    position, heading, speed = cars[:, [0, 1]], cars[:, 2], cars[:, 3]
    velocity = speed[:, None] * np.stack([np.cos(heading), np.sin(heading)], axis=1)
    centres = np.arange(scenario.road.lanes) * scenario.road.lane_width
    d_e = position[0, 1] - centres[np.argmin(np.abs(position[0, 1] - centres))]
    ego = [1.0, *(position[0] / [1000, 4]), *(velocity[0] / [15, 2]), d_e / 2]
    away = np.linalg.norm(position[1:] - position[0], axis=1)
    order = [1 + i for i in np.argsort(away, kind="stable") if away[i] < scenario.sight.distance]
    rows = np.zeros((scenario.sight.neighbours, 5))
    for row, i in zip(rows, order, strict=False):
        row[:] = [1.0, *((position[i] - position[0]) / [50, 4]), *((velocity[i] - velocity[0]) / [5, 2])]
    return np.concatenate([ego, rows.ravel()])


@pytest.mark.parametrize("name", ["default", "crowded"])
def test_every_observation_is_what_numpy_makes_of_the_cars_and_stays_within_its_bounds(name):
    scenario, rng, seeds = SCENARIOS[name], np.random.default_rng(0), range(16)
    env = gym.make_vec(
        "bootcourse:Trap-v0", num_envs=len(seeds), scenario=scenario, autoreset_mode=AutoresetMode.DISABLED
    ).unwrapped
    space = env.single_observation_space
    observations, _ = env.reset(seed=0)
    while not env.asleep.all():
        expected = np.stack([observation_in_numpy(cars, scenario) for cars in env.cars])
        assert all(space.contains(observation) for observation in observations)
        assert observations[~env.asleep] == pytest.approx(expected[~env.asleep], abs=1e-5)
        actions = [DRIVERS[seed % len(DRIVERS)](env.cars[seed], scenario, rng) for seed in seeds]
        observations, *_ = env.step(np.array(actions))


def test_a_start_has_the_numbers_of_the_paper_in_order():
    observation, _ = gym.make("bootcourse:Trap-v0").reset(seed=0)
    seen = dict(zip(names(DEFAULT), observation * scales(DEFAULT), strict=True))
    ego = [seen[name] for name in ("presence", "x", "y", "v_lon", "v_lat", "d_e")]
    assert ego == pytest.approx([1, 0, 8, 10, 0, 0])
    assert 4.06 <= seen["car 1 dx"] <= 7.43 and seen["car 1 dy"] == -4.0, "trap 2 is the nearest"
    assert 14.80 <= seen["car 2 dx"] <= 16.44 and seen["car 2 dy"] == 0.0, "then trap 1"
    assert seen["car 1 dv_lon"] == seen["car 2 dv_lon"] == 0.0
    assert 1.0 <= seen["car 3 dv_lon"] <= 2.5, "then the traffic, which is faster"


def test_a_car_beyond_200_metres_is_five_zeros():
    env = gym.make_vec("bootcourse:Trap-v0", num_envs=1).unwrapped
    env.reset(seed=0)
    env.cars[0, 1:, X] = [199.9, 200.1, *range(300, 900, 100)]
    env.cars[0, 1:, Y] = env.cars[0, EGO, Y]
    observation = env.observe()[0]
    assert observation[6:8] == pytest.approx([1.0, 199.9 / 50])
    assert (observation[11:] == 0.0).all()
