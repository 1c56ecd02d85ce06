"""The statistics of a study, against numbers that can be worked out by hand."""

import numpy as np
import pytest
from scipy import stats

from bootcourse.statistics import improvement, interval, iqm, median, power, rolling_means, significant


@pytest.mark.parametrize(
    ("scores", "middle"), [([100, 0, 1, 2, 3, 4, 5, 6, 7, -50], [1, 2, 3, 4, 5, 6]), ([1.0, 2.0, 6.0], [1.0, 2.0, 6.0])]
)
def test_the_interquartile_mean_is_the_mean_of_the_middle_six_of_ten_and_of_all_three(scores, middle):
    assert iqm(np.array(scores)) == pytest.approx(np.mean(middle))


def test_resampling_seeds_gives_the_interval_that_brute_force_gives():
    scores = np.array([3.0, 1.0, 4.0])
    brute = [np.mean([a, b, c]) for a in scores for b in scores for c in scores]  # all 27 resamples
    estimate = interval(scores)
    assert (estimate.low, estimate.high) == pytest.approx(np.percentile(brute, [2.5, 97.5], method="inverted_cdf"))
    assert estimate.value == pytest.approx(8 / 3)


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


def test_the_power_is_how_often_simulated_studies_differ():
    rng, shown = np.random.default_rng(0), significant(8)
    simulated = shown[rng.binomial(8, 0.9, 20_000), rng.binomial(8, 0.4, 20_000)].mean()
    assert power(0.9, 0.4, 8) == pytest.approx(simulated, abs=0.01)
