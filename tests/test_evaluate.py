"""Held-out episodes and their intervals."""

import math

import numpy as np
import pytest
from scipy import stats

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
from bootcourse.statistics import (
    all_resamples,
    improvement,
    interval,
    iqm,
    mean,
    median,
    power,
    rate,
    rolling_means,
    significant,
)


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


# Over the agents of a study


@pytest.mark.parametrize(
    ("scores", "middle"), [([100, 0, 1, 2, 3, 4, 5, 6, 7, -50], [1, 2, 3, 4, 5, 6]), ([1.0, 2.0, 6.0], [1.0, 2.0, 6.0])]
)
def test_the_interquartile_mean_is_the_mean_of_the_middle_six_of_ten_and_of_all_three(scores, middle):
    assert iqm(np.array(scores)) == pytest.approx(np.mean(middle))


@pytest.mark.parametrize("scores, mean", [([3.0, 1.0, 4.0], 8 / 3), ([1.0, 4.0, 1.0], 2)], ids=["distinct", "equal"])
def test_resampling_seeds_gives_the_interval_that_brute_force_gives(scores, mean):
    scores = np.array(scores)
    brute = [np.mean([a, b, c]) for a in scores for b in scores for c in scores]  # all 27 resamples
    estimate = interval(scores)
    assert (estimate.low, estimate.high) == pytest.approx(np.percentile(brute, [2.5, 97.5], method="inverted_cdf"))
    assert estimate.value == pytest.approx(mean)


def test_the_interval_of_ten_seeds_is_exact_and_more_are_resampled():
    scores = np.array([7.0, 96, 127, 127, 128, 128, 128, 128, 20, 23])  # as in the default study: some never escape
    for times, ways in (([1] * 10, math.comb(19, 10)), ([1, 1, 2, 4, 1, 1], math.comb(15, 10))):
        rows, probabilities = all_resamples(*times)
        assert len(rows) == ways and probabilities.sum() == pytest.approx(1)
    exact = interval(scores)
    assert exact == interval(scores, seed=1)
    drawn = iqm(scores[np.random.default_rng(0).integers(10, size=(200_000, 10))])
    assert np.mean(drawn < exact.low) < 0.025 + 0.001 and np.mean(drawn <= exact.low) > 0.025 - 0.001
    assert np.mean(drawn > exact.high) < 0.025 + 0.001 and np.mean(drawn >= exact.high) > 0.025 - 0.001
    twelve = [*scores, 100.0, 110.0]
    assert interval(twelve) == interval(twelve, seed=0) != interval(twelve, seed=1)


def test_one_seed_has_no_interval_and_equal_seeds_have_one_of_length_0():
    assert np.isnan(interval(np.array([5.0])).low)
    assert interval(np.full(10, 5.0)) == (5.0, 5.0, 5.0)


def test_the_median_of_ten_lies_between_the_second_and_the_ninth_and_may_be_infinite():
    assert median(np.arange(10.0)) == (4.5, 1.0, 8.0)
    assert median([1.0, 2.0, 3.0, 4.0, 5.0, *[np.inf] * 5]) == (np.inf, 2.0, np.inf)
    coverage = 1 - 2 * stats.binom.cdf([1, 2], 10, 0.5)  # from the second to the ninth, the third to the eighth
    assert coverage[0] > 0.95 > coverage[1] and np.isnan(median(np.arange(5.0)).low)


def test_probability_of_improvement_is_the_mann_whitney_statistic():
    rng = np.random.default_rng(1)
    x, y = rng.integers(0, 5, 7).astype(float), rng.integers(0, 5, 9).astype(float)
    estimate = improvement(x, y)
    assert estimate.value == pytest.approx(stats.mannwhitneyu(x, y).statistic / 63)
    assert 0 <= estimate.low <= estimate.value <= estimate.high <= 1


def test_a_rolling_mean_ends_where_its_agent_ends():
    values = np.array([[1.0, 2, 3, 4], [5, 7, np.nan, np.nan]])
    at, means = rolling_means(values, 2)
    assert at.tolist() == [2, 3, 4] and means[0].tolist() == [1.5, 2.5, 3.5]
    assert means[1][0] == 6 and np.isnan(means[1][1:]).all()
    assert rolling_means(np.full((2, 3), np.nan), 2)[1].shape == (2, 0)


@pytest.mark.parametrize("n", (2, 5, 10))
def test_counts_are_told_apart_as_by_scipy_s_test_of_each_pair(n):
    p = [[stats.fisher_exact([[k, n - k], [j, n - j]]).pvalue for j in range(n + 1)] for k in range(n + 1)]
    assert (significant(n) == (np.array(p) < 0.05)).all()


def test_the_power_is_how_often_simulated_studies_differ():
    rng, shown = np.random.default_rng(0), significant(8)
    simulated = shown[rng.binomial(8, 0.9, 20_000), rng.binomial(8, 0.4, 20_000)].mean()
    assert power(0.9, 0.4, 8) == pytest.approx(simulated, abs=0.01)
