"""Statistics of episodes and of training seeds' scores, with 95 % intervals. Pure functions.

A seed's score is the mean over its held-out episodes. Intervals over seeds resample whole seeds: the scores' spread
already includes that of their episodes, and resampling both levels would count it twice (Davison & Hinkley 1997,
section 3.8). Interquartile mean and probability of improvement as in Agarwal et al. (arXiv 2108.13264), computed with
scipy because rliable, the authors' library, has had no release since 2024.
"""

import warnings
from collections.abc import Sequence
from functools import lru_cache
from itertools import combinations_with_replacement
from typing import NamedTuple

import numpy as np
import scipy

RESAMPLES = 99_999  # with a tenth of them, an end moved by up to 7 with the resampling seed (returns of ten agents)
EXACT = 10  # seeds; up to these, all resamples of one sample are enumerated: 92,378 of ten that differ
ESCAPES = 0.95  # an agent escapes if it succeeds in at least this share of its episodes
IN_A_ROW = 50  # training episodes, of which an agent that has found the way out ends more than half ahead
HAD, LOST = 40, 25  # of these: ahead in so many, later in so few, an agent has lost the way out


class Estimate(NamedTuple):
    """A number with its 95 % interval."""

    value: float
    low: float
    high: float


def number(value: float) -> str:
    """Two decimals, fewer for large numbers, without an exponent."""
    if np.isnan(value):
        return "?"
    return f"{value:.0f}" if abs(value) >= 1000 else f"{value:.1f}" if abs(value) >= 100 else f"{value:.2f}"


def bracketed(estimate: Estimate, scale: float = 1) -> str:
    """ "62 [39, 83]": with the decimals that the interval's length leaves meaningful; one seed has no interval."""
    value, low, high = (scale * part for part in estimate)
    if np.isnan(low):
        return number(value)
    decimals = 0 if high - low >= 10 else 1 if high - low >= 1 else 2
    return f"{value:.{decimals}f} [{low:.{decimals}f}, {high:.{decimals}f}]"


def rate(hits: np.ndarray) -> Estimate:
    """A rate with its exact (Clopper-Pearson) interval: hits (n,) bool."""
    test = scipy.stats.binomtest(int(np.sum(hits)), len(hits))
    low, high = test.proportion_ci(confidence_level=0.95, method="exact")
    return Estimate(test.statistic, float(low), float(high))


def mean(values: np.ndarray) -> Estimate:
    """A mean with Student's t interval: values (n,). One value has no interval: NaN."""
    value = float(np.mean(values))
    if len(values) < 2:
        return Estimate(value, float("nan"), float("nan"))
    half = scipy.stats.t.ppf(0.975, len(values) - 1) * scipy.stats.sem(values)
    return Estimate(value, value - float(half), value + float(half))


def iqm(scores: np.ndarray, axis: int = -1) -> np.ndarray:
    """Interquartile mean along an axis: the mean without the lowest and the highest quarter of the scores.

    A quarter is rounded down: of 10 scores 6 remain, of 3 or fewer all.
    """
    return scipy.stats.trim_mean(scores, 0.25, axis=axis)


def interval(scores: Sequence[float] | np.ndarray, statistic=iqm, seed: int = 0) -> Estimate:
    """A statistic of scores (seeds,) with its 95 % percentile bootstrap interval over seeds.

    Up to `EXACT` seeds it is the exact one, from all possible resamples and their probabilities. With more, RESAMPLES
    are drawn with the generator of `seed`. One seed has no interval: NaN. Equal scores have an interval of length 0,
    which is too short: for rates of agents use `escapes`, whose interval is exact.
    """
    scores = np.asarray(scores, dtype=np.float64)
    if not 1 < len(scores) <= EXACT:
        return _bootstrap((scores,), statistic, seed)
    return _exact(tuple(scores.tolist()), statistic)


@lru_cache(maxsize=1024)
def _exact(each: tuple[float, ...], statistic) -> Estimate:
    """The exact interval, which tables ask for again. Equal scores are one: rates of agents have few ways."""
    distinct, times = np.unique(each, return_counts=True)
    rows, probabilities = all_resamples(*times.tolist())
    resampled = statistic(distinct[rows], axis=-1)
    order = np.argsort(resampled)
    below = np.searchsorted(np.cumsum(probabilities[order]), 0.025)
    above = np.searchsorted(np.cumsum(probabilities[order[::-1]]), 0.025)
    return Estimate(float(statistic(np.array(each), axis=-1)), *map(float, resampled[order[[below, -1 - above]]]))


@lru_cache
def all_resamples(*times: int) -> tuple[np.ndarray, np.ndarray]:
    """All ways to draw n of n scores with replacement, whatever the order: rows (ways, n), probabilities (ways,).

    times: how often each of the distinct scores, to which the rows point, is among the n. A way that draws score i
    k_i times has the probability n! / (k_1! k_2! ...) · Π (times_i / n)^k_i.
    """
    n = sum(times)
    rows = np.array(list(combinations_with_replacement(range(len(times)), n)))
    counts = (rows[:, :, None] == np.arange(len(times))).sum(axis=1)
    return rows, scipy.stats.multinomial.pmf(counts, n, np.array(times) / n)


def median(values: np.ndarray) -> Estimate:
    """A median with its distribution-free interval, from order statistics: values (n,), which may be infinite.

    It covers the median with 95 % or more (David & Nagaraja 2003, section 7.1): for n = 10 it runs from the second
    value to the ninth. Fewer than 6 values have none: NaN.
    """
    limits = scipy.stats.quantile_test(values, p=0.5).confidence_interval(confidence_level=0.95)
    return Estimate(float(np.median(values)), float(limits.low), float(limits.high))


def improvement(x: np.ndarray, y: np.ndarray, seed: int = 0) -> Estimate:
    """P(X > Y): the probability that a random score of x (m,) is above a random score of y (n,); a tie counts half.

    It is the Mann-Whitney statistic U / (m n), with a percentile bootstrap interval over the seeds of both, from
    RESAMPLES that are drawn with the generator of `seed`.
    """
    return _bootstrap((x, y), _wins, seed)


def difference(x: np.ndarray, y: np.ndarray, seed: int = 0) -> Estimate:
    """IQM of x (m,) less IQM of y (n,), with a percentile bootstrap interval over the seeds of both.

    RESAMPLES are drawn with the generator of `seed`. With another an end may move by a hundredth of the interval's
    length.
    """
    return _bootstrap((x, y), _less, seed)


def _less(x: np.ndarray, y: np.ndarray, axis: int = -1) -> np.ndarray:
    return iqm(x, axis) - iqm(y, axis)


def _wins(x: np.ndarray, y: np.ndarray, axis: int = -1) -> np.ndarray:
    """The share of pairs with x > y, ties half: (..., m) and (..., n) -> (...)."""
    x, y = x[..., :, None], y[..., None, :]
    return ((x > y) + 0.5 * (x == y)).mean(axis=(-2, -1))


def _bootstrap(samples: Sequence, statistic, seed: int) -> Estimate:
    """A statistic of some samples, each (seeds,), with its interval over them; a single seed allows none: NaN."""
    samples = [np.asarray(sample, dtype=np.float64) for sample in samples]
    value = float(statistic(*samples, axis=-1))
    if min(map(len, samples)) < 2:
        return Estimate(value, float("nan"), float("nan"))
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", scipy.stats.DegenerateDataWarning)
        resampled = scipy.stats.bootstrap(
            samples, statistic, method="percentile", n_resamples=RESAMPLES, batch=1000, rng=np.random.default_rng(seed)
        )
    return Estimate(value, *map(float, resampled.confidence_interval))


def escapes(success: np.ndarray) -> Estimate:
    """The share of agents that escape, with its exact (Clopper-Pearson) interval: success rates (seeds,)."""
    return rate(np.asarray(success) >= ESCAPES)


def found_after(success: np.ndarray, window: int = IN_A_ROW, least: float | None = None) -> np.ndarray:
    """The training episodes after which each agent has found the way out: (agents,) int, 0 for one that never did.

    It has when at least `least` of the last `window` episodes succeeded, by default more than half. success: (agents,
    episodes), NaN for an episode that was not driven; a window with such an episode does not count.
    """
    if success.shape[1] < window:
        return np.zeros(len(success), dtype=int)
    least = window // 2 + 1 if least is None else least - 1e-9
    reached = _successes(success, window) >= least
    return np.where(reached.any(axis=1), reached.argmax(axis=1) + window, 0)


def found(success: np.ndarray, window: int = IN_A_ROW) -> np.ndarray:
    """Which agents found the way out in their training, (agents,) bool: see `found_after`."""
    return found_after(success, window) > 0


def lost(success: np.ndarray, bar: int = LOST) -> np.ndarray:
    """Which agents lose the way out at least once in their training: success (agents, episodes) -> (agents,) bool.

    After `HAD` of `IN_A_ROW` episodes ahead, `bar` of as many or fewer.
    """
    if success.shape[1] < IN_A_ROW:
        return np.zeros(len(success), dtype=bool)
    ahead = _successes(success, IN_A_ROW)
    return np.any(np.maximum.accumulate(ahead >= HAD, axis=1) & (ahead <= bar), axis=1)


def _successes(success: np.ndarray, window: int) -> np.ndarray:
    """How many episodes of each window succeeded: (agents, episodes) -> (agents, windows)."""
    return np.lib.stride_tricks.sliding_window_view(np.asarray(success, dtype=float), window, axis=1).sum(axis=-1)


def holm(p: Sequence[float]) -> np.ndarray:
    """Holm's adjusted p-values (Holm 1979), in the order of p: (tests,) -> (tests,)."""
    order, m = np.argsort(p), len(p)
    scaled = np.asarray(p)[order] * (m - np.arange(m))
    adjusted = np.empty(m)
    adjusted[order] = np.minimum(np.maximum.accumulate(scaled), 1)
    return adjusted


def fisher(first: int, second: int, of: int = 10, second_of: int | None = None) -> float:
    """Fisher's two-sided p of two counts, such as of agents that escape: the first of `of`, the second of as many or of
    `second_of`.
    """
    of_both = (of, of if second_of is None else second_of)
    return float(scipy.stats.fisher_exact([[n, of - n] for n, of in zip((first, second), of_both, strict=True)]).pvalue)


@lru_cache
def significant(n: int) -> np.ndarray:
    """Whether Fisher's exact test tells k of n from j of n, with a p below 0.05: bool (n + 1, n + 1), by k and j.

    As `scipy.stats.fisher_exact` for each pair, some hundred times as fast: pairs with the same total share the
    hypergeometric chances, and p is the sum of those that are not larger than the pair's own.
    """
    counts = np.arange(n + 1)
    total = counts[:, None] + counts
    chances = scipy.stats.hypergeom.pmf(counts[:, None], 2 * n, total, n)
    p = np.zeros_like(chances)
    for together in range(2 * n + 1):
        chance = chances[total == together]
        p[total == together] = (chance * (chance <= chance[:, None] * (1 + 1e-7))).sum(axis=1)
    return p < 0.05


def power(first: float, second: float, n: int) -> float:
    """How often n agents against n, which escape at these true rates, differ by Fisher's exact test (p below 0.05)."""
    counts = np.arange(n + 1)
    k, j = (scipy.stats.binom.pmf(counts, n, rate) for rate in (first, second))
    return float(np.sum(np.outer(k, j)[significant(n)]))


def band(curves: np.ndarray, seed: int = 0, resamples: int = 1000) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Interquartile mean and 95 % band over seeds: curves (seeds, points) -> middle, low, high, each (points,).

    Each resample draws the same seeds at all points, so the band is as smooth as the curves.
    """
    curves = np.asarray(curves, dtype=np.float64)
    middle = iqm(curves, axis=0)
    if len(curves) < 2:
        return middle, np.full_like(middle, np.nan), np.full_like(middle, np.nan)
    draws = np.random.default_rng(seed).integers(len(curves), size=(resamples, len(curves)))
    low, high = np.percentile(iqm(curves[draws], axis=1), [2.5, 97.5], axis=0)
    return middle, low, high


def rolling_means(values: np.ndarray, window: int, points: int = 80) -> tuple[np.ndarray, np.ndarray]:
    """Means of the last `window` episodes: values (agents, episodes) -> episode numbers (points,), (agents, points).

    The points are evenly spaced up to the last episode of any agent. An agent's means are NaN from its first missing
    episode on. Both arrays are empty if no agent finished an episode.
    """
    values = np.atleast_2d(np.asarray(values, dtype=np.float64))
    episodes = int(np.isfinite(values).sum(axis=1).max(initial=0))
    if not episodes:
        return np.zeros(0, dtype=int), np.zeros((len(values), 0))
    at = np.unique(np.linspace(min(window, episodes), episodes, points).astype(int))
    sums = np.cumsum(np.pad(values, ((0, 0), (1, 0))), axis=1)
    return at, (sums[:, at] - sums[:, np.maximum(at - window, 0)]) / np.minimum(at, window)
