"""Held-out episodes and their intervals."""

import numpy as np
import pytest

from bootcourse.episodes.evaluate import (
    BLOCK,
    MAX_SEED,
    drive_episodes,
    held_out_seeds,
    over_seeds,
    summarise,
)
from bootcourse.episodes.record import record
from bootcourse.errors import BootcourseError
from bootcourse.learn.demonstrations import FIRST_SEED as DEMONSTRATIONS
from bootcourse.learn.training import FIRST_SEED as TRAINING
from bootcourse.policies import idle_policy, in_words, plan_policy, random_policy, rule_policy
from bootcourse.scenario import DEFAULT
from bootcourse.statistics import mean, rate


def test_the_ego_that_does_nothing_earns_23_4375_on_every_held_out_road():
    episodes = drive_episodes(idle_policy, held_out_seeds(1, 1000))
    np.testing.assert_allclose(episodes.returns, 23.4375, atol=1e-9)
    np.testing.assert_allclose(episodes.distance, 1500, atol=1e-9)
    assert not episodes.success.any()


def test_an_evaluation_agrees_with_recorded_drives_of_the_same_roads():
    seeds = held_out_seeds(2, 6)
    episodes = drive_episodes(rule_policy(DEFAULT), seeds)
    for i, rollout in enumerate(record(rule_policy(DEFAULT), seeds)):
        assert episodes.returns[i] == pytest.approx(rollout.rewards.sum())
        assert episodes.distance[i] == pytest.approx(rollout.distance)
        assert episodes.success[i] == rollout.success
        assert episodes.speed[i] == pytest.approx(rollout.distance / 150)


def test_the_kinds_of_accident_are_counted_apart():
    episodes = drive_episodes(random_policy(np.random.default_rng(0)), held_out_seeds(1, 300))
    result = summarise(episodes)
    kinds = result.collision.value + result.road_departure.value + result.stoppage.value
    assert kinds == pytest.approx((episodes.accident > 0).mean()) and result.road_departure.value > 0


def test_the_interval_of_20_successes_in_20_is_the_textbook_s():
    estimate = rate(np.ones(20, dtype=bool))
    assert (estimate.value, estimate.high) == (1.0, 1.0) and estimate.low == pytest.approx(0.8316, abs=1e-4)


def test_the_interval_of_a_mean_is_student_s():
    estimate = mean(np.array([1.0, 2.0, 3.0]))
    assert estimate.value == 2 and estimate.high - 2 == pytest.approx(4.302653 * 1 / np.sqrt(3), abs=1e-5)
    assert np.isnan(mean(np.array([1.0])).low)


def test_the_interval_over_seeds_spans_the_seeds_and_holds_their_mean():
    reports = [
        summarise(drive_episodes(driver, held_out_seeds(1, 20))) for driver in (idle_policy, rule_policy(DEFAULT))
    ]
    success = over_seeds(reports)["success"]
    assert (success.value, success.low, success.high) == (0.5, 0.0, 1.0)


def test_no_road_is_ever_both_trained_on_and_tested_on():
    last_tested = held_out_seeds(MAX_SEED, BLOCK)[-1]
    assert last_tested < 2**32 < TRAINING < DEMONSTRATIONS


@pytest.mark.parametrize(("seed", "episodes"), [(-1, 10), (MAX_SEED + 1, 10), (1, 0), (1, BLOCK + 1)])
def test_a_seed_or_number_outside_its_block_is_refused(seed, episodes):
    with pytest.raises(BootcourseError, match="give a whole number"):
        held_out_seeds(seed, episodes)


def test_a_plan_drives_every_episode_from_its_start():
    policy = plan_policy([("keep left", 2), "keep right", ("brake straight", 3)])
    first, second = (record(policy, [0, 3])[1] for _ in range(2))
    assert in_words(second.actions[:6]) == [("keep left", 2), ("keep right", 1), ("brake straight", 3)]
    np.testing.assert_array_equal(first.states, second.states)
    one_by_one, together = (drive_episodes(policy, range(4), together=size).returns for size in (1, 4))
    np.testing.assert_array_equal(one_by_one, together)


def test_a_mistyped_action_is_named_with_the_nearest():
    with pytest.raises(BootcourseError, match="did you mean 'brake left'"):
        plan_policy(["brake lef"])
