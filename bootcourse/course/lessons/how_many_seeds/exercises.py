"""Exercises of the lesson on seeds: power, an interval of a mean, and the difference of two groups."""

import functools

import numpy as np
import scipy

from bootcourse.course.exercise import exercise
from bootcourse.course.values import NUMERIC, plain
from bootcourse.statistics import significant


def power_cases(rng):
    """Equal rates, certain ones, one agent each; then 30 at random, of Fisher's test and of a simpler one."""
    yield 0.3, 0.3, significant(5)
    yield 1.0, 0.0, significant(4)
    yield 0.8, 0.3, significant(10)
    yield 0.8, 0.3, np.array([[False, True], [True, False]])
    yield 0.8, 0.3, np.tri(5, k=-2, dtype=bool)  # a one-sided test: k is the first group's
    for _ in range(30):
        n = rng.integers(3, 9)
        counts = np.arange(n + 1)
        apart = np.abs(counts[:, None] - counts) > rng.integers(1, n)
        yield rng.random(), rng.random(), significant(n) if rng.random() < 0.5 else apart


@exercise(
    "Σ P(k) P(j) over the pairs (k, j) that the test tells apart", minutes=12, difficulty=2, cases=power_cases,
    worked=[
        ((0.5, 0.5, np.array([[False, True], [True, False]])), 0.5),  # 0 against 1, or 1 against 0: 1/4 each
        ((1.0, 0.5, np.array([[False, False, True], [False, False, False], [True, False, False]])), 0.25),
    ],
    hints=(
        "`scipy.stats.binom.pmf(np.arange(n + 1), n, rate)` has the chance of each count 0 to n. n follows from the "
        "table's shape: it has n + 1 rows.",
        "`np.outer(k, j)` has the chance of each pair of counts, in the order of the table. Add up those where the "
        "table says True, in either direction.",
    ),
    mistakes={
        "np.sum(np.outer(k, j)[shown]) -> np.mean(shown)":
            "You count all pairs of counts alike. Weigh each with its chance at these two rates.",
        "np.sum(np.outer(k, j)[shown]) -> np.sum(np.outer(k, j)[~shown])":
            "This is how often the comparison *misses* the difference. The power is one minus it.",
        "return float(shown[round(n * first), round(n * second)])":
            "You look up the two expected counts. The counts vary from study to study: add up over all pairs.",
        "np.outer(k, j) -> np.add.outer(k, j)":
            "You add two chances. The two groups are independent, so the chance of a pair is the product.",
        "k = scipy.stats.binom.pmf(np.arange(n + 1), n, (first + second) / 2); return np.sum(np.outer(k, k)[shown])":
            "You draw both groups at one rate. That is how often the test errs where there is *no* difference.",
    },
)  # fmt: skip
def power(first, second, shown):
    n = len(shown) - 1
    k = scipy.stats.binom.pmf(np.arange(n + 1), n, first)
    j = scipy.stats.binom.pmf(np.arange(n + 1), n, second)
    return np.sum(np.outer(k, j)[shown])


ENDS = np.array([0.025, 0.975])
METHODS = ("linear", "lower", "higher", "nearest", "midpoint", "inverted_cdf", "averaged_inverted_cdf", "hazen",
           "closest_observation", "interpolated_inverted_cdf", "weibull", "median_unbiased",
           "normal_unbiased")  # fmt: skip


def in_numbers(value) -> list[float]:
    """The numbers of a list, a tuple, an array or a tensor; none for all else."""
    given = plain(value)
    if given.kind in ("array", "tensor") and given.array.ndim == 1:
        return given.array.tolist()
    parts = given.parts or ()
    alone = all(part.kind in NUMERIC and part.shape == () for part in parts)
    return [part.array.item() for part in parts] if alone else []


@functools.lru_cache(maxsize=200)
def usual_intervals(values: tuple[float, ...]) -> list[np.ndarray]:
    """The 95 % interval of the values in each usual way, NumPy's own first."""
    in_order, last = np.sort(values), len(values) - 1
    low, high = (ENDS * len(values)).astype(int)
    counted_off = [in_order[[low, high]], in_order[[low, last - low]]]  # in a sorted list
    return [*(np.quantile(in_order, ENDS, method=method) for method in METHODS), *counted_off]


def by_usual_interpolation(answer, values: np.ndarray):
    """An answer that ends with the 95 % interval of `values`: with NumPy's, if it interpolates in another usual way.

    What does not end with such an interval is returned as it is.
    """
    numbers, usual = in_numbers(answer), usual_intervals(tuple(values.tolist()))
    if len(numbers) < 2 or not any(np.allclose(numbers[-2:], each, rtol=1e-4) for each in usual):
        return answer
    return np.array([*numbers[:-2], *usual[0]])


def draw_cases(rng):
    """Two groups, all equal; then 40 at random."""
    for scores in (np.array([0.0] * 8 + [1.0] * 2), np.full(5, 3.0)):
        yield scores, rng.integers(len(scores), size=(200, len(scores)))
    for _ in range(40):
        scores = rng.exponential(30, rng.integers(3, 12)) - 10
        yield scores, rng.integers(len(scores), size=(rng.integers(50, 300), len(scores)))


def interval_of_mean(answer, scores, draws):
    return by_usual_interpolation(answer(scores, draws), scores[draws].mean(axis=1))


@exercise(
    "the percentile bootstrap: Efron (1979); over whole seeds", minutes=7, difficulty=2, cases=draw_cases,
    run=interval_of_mean,
    worked=[
        ((np.array([0.0, 8.0]), np.array([[0, 0], [0, 1], [1, 1]])), np.array([0.2, 7.8])),  # of the means 0, 4, 8
        ((np.array([2.0, 2.0]), np.array([[0, 1], [1, 1]])), np.array([2.0, 2.0])),
    ],
    hints=(
        "`scores[draws]` has a row for each draw: the scores of the agents that it drew.",
        "One mean for each row; then the 2.5th and the 97.5th percentile of all the means.",
    ),
    mistakes={
        "[2.5, 97.5] -> [5, 95]":
            "You leave 5 % on each side: that is a 90 % interval. 95 % leaves 2.5 on each.",
        "[2.5, 97.5] -> [0.025, 0.975]":
            "`np.percentile` takes per cent: 2.5 and 97.5. Shares, 0.025 and 0.975, are for `np.quantile`.",
        ".mean(axis=1) ->":
            "This is the spread of single agents. Average within each draw first: the interval is that of the *mean*.",
        "axis=1 -> axis=0":
            "You average over the draws. Average within each draw, over its agents: axis 1.",
        "return scores.mean() + 1.96 * np.array([-1, 1]) * means.std()":
            "You replace the draws by a normal distribution. Take the percentiles of the means themselves.",
        "scores[draws].mean(axis=1) -> np.median(scores[draws], axis=1)":
            "You took the median of each draw. Here you need the interval of the mean.",
    },
)  # fmt: skip
def bootstrap_interval(scores, draws):
    means = scores[draws].mean(axis=1)
    return np.percentile(means, [2.5, 97.5])


def interval_of_difference(answer, x, y, draws_x, draws_y):
    of_x, of_y = (scipy.stats.trim_mean(drawn, 0.25, axis=1) for drawn in (x[draws_x], y[draws_y]))
    return by_usual_interpolation(answer(x, y, draws_x, draws_y), of_x - of_y)


def group_cases(rng):
    """Equal groups, two clusters, three seeds, one resample; then 30 at random, of different sizes."""
    sizes = [(5, 5), (10, 10), (3, 3), (4, 8), *rng.integers(2, 12, (30, 2))]
    for k, (m, n) in enumerate(sizes):
        x = np.full(m, 100.0) if k == 0 else np.where(rng.random(m) < 0.7, rng.normal(120, 5, m), -10.0)
        y = np.full(n, 100.0) if k == 0 else np.where(rng.random(n) < 0.5, rng.normal(110, 5, n), -10.0)
        resamples = 1 if k == 3 else 200
        yield x, y, rng.integers(m, size=(resamples, m)), rng.integers(n, size=(resamples, n))


@exercise(
    "the percentile bootstrap of IQM(x) - IQM(y), both groups resampled", minutes=15, difficulty=3, cases=group_cases,
    run=interval_of_difference,
    worked=[
        ((np.array([0.0, 8.0]), np.array([1.0, 1.0]), np.array([[0, 0], [0, 1], [1, 1]]), np.array([[0, 1]] * 3)),
         np.array([3.0, -0.8, 6.8])),  # means 0, 4, 8, each less 1
        ((np.array([0.0, 2.0, 4.0, 90.0]), np.zeros(2), np.array([[0, 1, 2, 3]]), np.array([[0, 0]])),
         np.array([3.0, 3.0, 3.0])),  # 2 and 4 are left of the four
    ],
    hints=(
        "`x[draws_x]` has a row for each resample. Write an `iqm` along the last axis: `np.sort(..., axis=-1)`.",
        "One difference for each resample: `iqm(x[draws_x]) - iqm(y[draws_y])`.",
    ),
    mistakes={
        "return np.array([iqm(y) - iqm(x), *np.percentile(-differences, [2.5, 97.5])])":
            "Your sign is turned: the first group less the second.",
        "of_x, of_y = (np.percentile(iqm(drawn), [2.5, 97.5]) for drawn in (x[draws_x], y[draws_y])); "
        "return np.array([iqm(x) - iqm(y), *(of_x - of_y)])":
            "You subtract the ends of two intervals. Subtract in each resample, and take the percentiles of these "
            "differences.",
        "of_x, of_y = (np.percentile(iqm(drawn), [2.5, 97.5]) for drawn in (x[draws_x], y[draws_y])); "
        "return np.array([iqm(x) - iqm(y), *(of_x - of_y[::-1])])":
            "You take the worst case at both ends: that both groups are unlucky in opposite directions is rarer than "
            "5 %. Take the percentiles of the resampled differences.",
        "np.sort(scores, axis=-1)[..., cut : scores.shape[-1] - cut] -> scores":
            "You compare means. Take the interquartile mean, of the groups and of each resample.",
        "iqm(group_x) - iqm(group_y) -> np.sort(x)[draws_x].mean(-1) - np.sort(y)[draws_y].mean(-1)":
            "In the resamples you take the mean. Sort each resample and leave out its own quarters.",
        "[2.5, 97.5] -> [5, 95]":
            "You leave 5 % at each end. Both ends together may miss in 5 % of the cases.",
    },
)  # fmt: skip
def difference_interval(x, y, draws_x, draws_y):
    group_x, group_y = x[draws_x], y[draws_y]  # a row for each resample

    def iqm(scores):  # over the last axis
        cut = scores.shape[-1] // 4
        return np.sort(scores, axis=-1)[..., cut : scores.shape[-1] - cut].mean(axis=-1)

    differences = iqm(group_x) - iqm(group_y)
    return np.array([iqm(x) - iqm(y), *np.percentile(differences, [2.5, 97.5])])
