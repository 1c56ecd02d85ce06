"""The planner: what it finds can be driven, and nobody can exceed its bound."""

import numpy as np
import pytest

from bootcourse.episodes.evaluate import drive_episodes
from bootcourse.episodes.record import record
from bootcourse.errors import BootcourseError
from bootcourse.policies import idle_policy, rule_policy
from bootcourse.research.planner import (
    Search,
    discounted_values,
    expand,
    follow,
    future_worth,
    is_staying_optimal,
    plan,
    plan_episodes,
    select,
)
from bootcourse.road.state import EGO, LANE, SPEED, X
from bootcourse.road.vector_env import TrapVectorEnv
from bootcourse.scenario import DEFAULT, Scenario

SEEDS = [2**33 - 100, 2**33 - 99, 2**33 - 98]


@pytest.fixture(scope="module")
def plans():
    return plan_episodes(SEEDS, search=Search(beam=20))


def start(seed: int = SEEDS[0], scenario: Scenario = DEFAULT) -> np.ndarray:
    env = TrapVectorEnv(1, scenario)
    env.reset(seed=seed)
    return env.cars[0].copy()


def test_a_plan_s_replay_earns_exactly_what_the_search_said(plans):
    for rollout, each in zip(record(follow(plans), SEEDS, DEFAULT, "planner"), plans, strict=True):
        np.testing.assert_array_equal(rollout.actions, each.actions)
        np.testing.assert_array_equal(rollout.rewards, each.rewards)
        assert each.value == pytest.approx(rollout.rewards.sum(), abs=1e-9)
        assert rollout.success == each.success and len(each.actions) == DEFAULT.clock.decisions


def empty_road_return(scenario=DEFAULT) -> float:
    """An upper bound on every return: that of an episode with no other car on the road."""
    return float(np.interp(scenario.ego.speed, *future_worth(scenario, scenario.clock.decisions, 1.0)[-1]))


def test_the_planner_beats_the_rule_by_far_without_an_accident_and_stays_under_the_empty_road(plans):
    assert not drive_episodes(follow(plans), SEEDS).accident.any()
    by_the_rule = drive_episodes(rule_policy(DEFAULT), SEEDS).returns
    stays = plan_episodes(SEEDS, search=Search(beam=20, decisions=25, keep_lane=True))
    for each, rule_return in zip(plans, by_the_rule, strict=True):
        assert 2 * rule_return < each.value <= empty_road_return()
    for rollout, stay, free in zip(record(follow(stays), SEEDS), stays, plans, strict=True):
        assert (rollout.states[: 2 * 25 + 1, EGO, LANE] == 2).all(), "a search that keeps its lane never leaves it"
        assert stay.value < free.rewards[:25].sum()


def test_a_beam_that_holds_everything_finds_the_best_of_all_9_to_the_3():
    cars, (best, roads) = start(), (-np.inf, start()[None])
    totals = np.zeros(1)
    for _ in range(3):
        roads, rewards, accidents = expand(roads, DEFAULT)
        totals = (totals[:, None] + np.where(accidents == 0, rewards, -np.inf)).ravel()
    best = totals.max()
    before = cars.copy()
    assert plan(cars, search=Search(beam=9**3, decisions=3)).value == pytest.approx(best, abs=1e-6)
    np.testing.assert_array_equal(cars, before)


def test_what_an_empty_road_still_pays_counts_the_discount():
    speeds, values = future_worth(DEFAULT, 3, 0.5)[3]
    at_15 = (1.5 + 0.05) / 1.6
    assert np.interp(15.0, speeds, values) == pytest.approx(at_15 * (1 + 0.5 + 0.25), abs=1e-3)


def test_each_lane_and_speed_keeps_a_share_of_the_beam():
    cars = np.zeros((40, 1, 10))
    cars[:, EGO, X] = np.arange(40)
    cars[20:30, EGO, SPEED], cars[30:, EGO, LANE] = 5.0, 2
    chosen = select(cars, -np.arange(40.0), np.ones(40, dtype=bool), beam=12)
    assert sorted(chosen) == [*range(8), 20, 21, 30, 31]
    same = np.zeros((3, 1, 10))  # of two drives in the same cell the better stays, and an accident never
    same[:, EGO, SPEED], same[2, EGO, X] = [10.0, 10.01, 10.0], 10.0
    assert select(same, np.array([1.0, 2.0, 3.0]), np.array([True, True, False]), beam=5).tolist() == [1]


def test_leaving_the_trap_is_worth_more_than_staying_even_at_the_paper_s_discount():
    values = discounted_values(idle_policy, SEEDS, DEFAULT, 0.8)
    np.testing.assert_allclose(values, 0.15625 * (1 - 0.8**150) / 0.2, atol=1e-9)  # a geometric series
    answer = is_staying_optimal(SEEDS, gamma=0.8, beam=20)
    assert answer.idle.value < answer.keep_lane.value < answer.best.value
    assert answer.gain.low > 0 and answer.leaves.value == 1
    assert answer.rule.value < answer.idle.value  # the rule's own detour does not pay at this discount


def test_a_search_that_cannot_be_is_refused():
    for change in ({"beam": 0}, {"gamma": 0.0}, {"gamma": 1.5}, {"decisions": 0}):
        with pytest.raises(BootcourseError, match="give a beam"):
            Search(**change)
    with pytest.raises(BootcourseError, match="between 0 and 1"):
        is_staying_optimal(SEEDS, gamma=1.0)
