"""SAC with one thing made easier: what the other roads do, and that nothing else is different."""

import numpy as np
import pytest

from bootcourse.course.lessons.the_barrier.easier import LATER, LaneKeeper, LaterStart, MidLaneStart, costing
from bootcourse.road.state import EGO, LANE, SPEED, TRAP_1, X, Y
from bootcourse.road.vector_env import TrapVectorEnv

SEEDS = list(range(20))
STAY, LEFT, FASTER = 4, 1, 5  # of the lane keeper's wishes


def driven(env: TrapVectorEnv, action: int, decisions: int) -> TrapVectorEnv:
    env.reset(seed=SEEDS)
    for _ in range(decisions):
        _, _, terminated, _, _ = env.step(np.full(len(SEEDS), action))
        if action == STAY:
            assert not terminated.any()
    return env


def test_the_lane_keeper_keeps_lane_and_speed_and_goes_where_it_is_told():
    env = driven(LaneKeeper(len(SEEDS)), STAY, 20)
    assert (env.cars[:, EGO, LANE] == 2).all() and np.allclose(env.cars[:, EGO, SPEED], 10)
    assert (driven(LaneKeeper(len(SEEDS)), LEFT, 3).cars[:, EGO, LANE] < 2).any()
    assert (driven(LaneKeeper(len(SEEDS)), FASTER, 1).cars[:, EGO, SPEED] > 10.5).all()


def test_a_later_start_is_on_the_free_lane_behind_the_traps_as_fast_as_they_are():
    env = LaterStart(len(SEEDS))
    observations, _ = env.reset(seed=SEEDS)
    ego, trap = env.cars[:, EGO], env.cars[:, TRAP_1]
    assert (ego[:, LANE] == 0).all() and (ego[:, X] < trap[:, X]).all() and np.allclose(ego[:, SPEED], 10)
    assert (env.decisions == LATER).all() and np.array_equal(observations, env.observe())


def test_the_plan_leaves_the_car_at_the_road_s_edge_and_mid_lane_is_the_same_start_in_the_middle():
    edge, middle = LaterStart(len(SEEDS)), MidLaneStart(len(SEEDS))
    for env in (edge, middle):
        env.reset(seed=SEEDS)
    assert (edge.cars[:, EGO, Y] < -1.9).all() and (middle.cars[:, EGO, Y] == 0).all()
    assert np.array_equal(edge.cars[:, EGO, X], middle.cars[:, EGO, X])
    steer_left = np.full(len(SEEDS), 3)
    assert edge.step(steer_left)[2].all() and not middle.step(steer_left)[2].any()


def test_an_episode_that_is_over_starts_later_again_and_the_others_go_on():
    env = LaterStart(len(SEEDS))
    env.reset(seed=SEEDS)
    env.decisions[0] = env.scenario.clock.decisions - 1
    before = env.cars[1:, EGO, X].copy()
    _, _, _, truncated, infos = env.step(np.full(len(SEEDS), STAY))
    assert truncated[0] and not truncated[1:].any() and infos["_final_obs"][0]
    assert env.decisions[0] == LATER and (env.decisions[1:] == LATER + 1).all()
    assert env.cars[0, EGO, LANE] == 0 and np.allclose(env.cars[1:, EGO, X] - before, 10, atol=0.5)


@pytest.mark.parametrize("price", [0.0, 1.0])
def test_an_accident_with_another_price_ends_the_drive_as_ever_and_pays_it(price):
    cheap, costly = costing(price)(len(SEEDS)), TrapVectorEnv(len(SEEDS))
    for env in (cheap, costly):
        env.reset(seed=SEEDS)
    crashed = np.zeros(len(SEEDS), dtype=bool)
    for _ in range(6):  # seconds of acceleration, towards trap 1
        actions = np.full(len(SEEDS), 7)
        _, rewards, terminated, _, _ = cheap.step(actions)
        _, paid, ended, _, _ = costly.step(actions)
        first = terminated & ~crashed
        assert np.array_equal(first, ended & ~crashed)
        assert (rewards[first] == -price).all() and (paid[first] == -10).all()
        assert np.array_equal(rewards[~first & ~crashed], paid[~first & ~crashed])
        crashed |= terminated
    assert crashed.all()
