"""Answers to the exercises of the lesson on the ablation."""

import numpy as np
from scipy import optimize, stats

from tests.answers import equivalent, right, wrong

# exact_interval --------------------------------------------------------------------------------------


@right("exact_interval")
def with_binomtest(k, n):
    found = stats.binomtest(k, n).proportion_ci(0.95, method="exact")
    return np.array([found.low, found.high])


@right("exact_interval")
def by_searching(k, n):
    low = optimize.brentq(lambda rate: stats.binom.sf(k - 1, n, rate) - 0.025, 0, 1, xtol=1e-12) if k else 0.0
    high = optimize.brentq(lambda rate: stats.binom.cdf(k, n, rate) - 0.025, 0, 1, xtol=1e-12) if k < n else 1.0
    return np.array([low, high])


@right("exact_interval")
def as_two_numbers(k, n):
    return tuple(with_binomtest(k, n))


@wrong("exact_interval", "not a number (NaN) in this case")
def without_the_low_end(k, n):
    return [stats.beta.ppf(0.025, k, n - k + 1), stats.beta.ppf(0.975, k + 1, n - k) if k < n else 1.0]


@wrong("exact_interval", "5 % at each end")
def ninety(k, n):
    found = stats.binomtest(k, n).proportion_ci(0.90, method="exact")
    return np.array([found.low, found.high])


@wrong("exact_interval", "failures")
def failures(k, n):
    return with_binomtest(n - k, n)


@wrong("exact_interval")
def clipped_normal(k, n):
    p = k / n
    return np.clip(p + 1.96 * np.sqrt(p * (1 - p) / n) * np.array([-1, 1]), 0, 1)


# interquartile_mean ----------------------------------------------------------------------------------


@right("interquartile_mean")
def trimmed(scores):
    return stats.trim_mean(scores, 0.25)


@right("interquartile_mean")
def one_by_one(scores):
    left = sorted(scores)
    for _ in range(len(scores) // 4):
        left = left[1:-1]
    return sum(left) / len(left)


@wrong("interquartile_mean")
def rounded_up(scores):
    cut = min(-(-len(scores) // 4), (len(scores) - 1) // 2)
    return np.sort(scores)[cut : len(scores) - cut].mean()


# bootstrap_interval ----------------------------------------------------------------------------------


@right("bootstrap_interval")
def draw_by_draw(scores, draws):
    means = [np.mean([scores[i] for i in draw]) for draw in draws]
    return np.quantile(means, [0.025, 0.975])


@right("bootstrap_interval")
def as_a_list(scores, draws):
    return np.percentile(scores[draws].mean(axis=1), [2.5, 97.5]).tolist()


@right("bootstrap_interval")
def by_counting(scores, draws):
    counts = np.stack([np.bincount(draw, minlength=len(scores)) for draw in draws])
    return np.percentile(counts @ scores / draws.shape[1], (2.5, 97.5))


@wrong("bootstrap_interval")
def without_draws(scores, draws):
    return np.percentile(scores, [2.5, 97.5])


# chance_of_improvement -------------------------------------------------------------------------------


@right("chance_of_improvement")
def mann_whitney(x, y):
    return stats.mannwhitneyu(x, y, method="asymptotic").statistic / (len(x) * len(y))


@right("chance_of_improvement")
def pair_by_pair(x, y):
    return np.mean([np.sign(a - b) / 2 + 0.5 for a in x for b in y])


@wrong("chance_of_improvement", "both be worse")
def strictly(x, y):
    return np.mean([a > b for a in x for b in y])


@wrong("chance_of_improvement", "both be better")
def at_least(x, y):
    return np.mean([a >= b for a in x for b in y])


@wrong("chance_of_improvement")
def of_the_median(x, y):
    return np.mean(x > np.median(y))


# difference_interval --------------------------------------------------------------------------------

MIDDLE = "[..., cut:scores.shape[-1] - cut]"
equivalent(
    "difference_interval",
    f"np.sort(scores, axis=-1){MIDDLE}  ->  np.sort(scores){MIDDLE}",
    "the default is the last axis",
)


def middle_mean(scores):
    """The interquartile mean of one list."""
    ordered = sorted(scores)
    cut = len(ordered) // 4
    return np.mean(ordered[cut : len(ordered) - cut])


@right("difference_interval")
def in_a_loop(x, y, draws_x, draws_y):
    each = [middle_mean(x[a]) - middle_mean(y[b]) for a, b in zip(draws_x, draws_y, strict=True)]
    return np.array([middle_mean(x) - middle_mean(y), np.percentile(each, 2.5), np.percentile(each, 97.5)])


@right("difference_interval")
def with_scipy(x, y, draws_x, draws_y):
    each = stats.trim_mean(x[draws_x], 0.25, axis=1) - stats.trim_mean(y[draws_y], 0.25, axis=1)
    whole = stats.trim_mean(x, 0.25) - stats.trim_mean(y, 0.25)
    return np.concatenate([[whole], np.quantile(each, [0.025, 0.975])])


@right("difference_interval")
def with_take(x, y, draws_x, draws_y):
    def iqm(rows):
        n = rows.shape[1]
        return np.sort(rows, 1)[:, n // 4 : n - n // 4].mean(1)

    found = iqm(np.take(x, draws_x)) - iqm(np.take(y, draws_y))
    low, high = np.percentile(found, (2.5, 97.5))
    return np.array([(iqm(x[None]) - iqm(y[None]))[0], low, high])


@wrong("difference_interval")
def medians_of_both(x, y, draws_x, draws_y):
    each = np.median(x[draws_x], axis=1) - np.median(y[draws_y], axis=1)
    return np.array([np.median(x) - np.median(y), *np.percentile(each, [2.5, 97.5])])


@wrong("difference_interval")
def without_the_difference(x, y, draws_x, draws_y):
    each = [middle_mean(x[a]) - middle_mean(y[b]) for a, b in zip(draws_x, draws_y, strict=True)]
    return np.percentile(each, [2.5, 97.5])


@wrong("difference_interval")
def draws_swapped(x, y, draws_x, draws_y):
    each = [middle_mean(x[a % len(x)]) - middle_mean(y[b % len(y)]) for a, b in zip(draws_y, draws_x, strict=True)]
    return np.array([middle_mean(x) - middle_mean(y), *np.percentile(each, [2.5, 97.5])])


@wrong("difference_interval")
def mean_of_the_resamples(x, y, draws_x, draws_y):
    each = [middle_mean(x[a]) - middle_mean(y[b]) for a, b in zip(draws_x, draws_y, strict=True)]
    return np.array([np.mean(each), *np.percentile(each, [2.5, 97.5])])


@wrong("difference_interval")
def always_two_cut(x, y, draws_x, draws_y):
    def iqm(rows):
        return np.sort(rows, -1)[..., 2:-2].mean(-1) if rows.shape[-1] > 4 else rows.mean(-1)

    return np.array([iqm(x) - iqm(y), *np.percentile(iqm(x[draws_x]) - iqm(y[draws_y]), [2.5, 97.5])])


@wrong("difference_interval")
def in_per_cent(x, y, draws_x, draws_y):
    return 100 * in_a_loop(x, y, draws_x, draws_y)


@wrong("difference_interval")
def normal_errors(x, y, draws_x, draws_y):
    each = [middle_mean(x[a]) - middle_mean(y[b]) for a, b in zip(draws_x, draws_y, strict=True)]
    return middle_mean(x) - middle_mean(y) + np.array([0, -1.96, 1.96]) * np.std(each)


@wrong("chance_of_improvement")
def over_m_squared(x, y):
    return np.heaviside(x[:, None] - y, 0.5).sum() / len(x) ** 2


@right("chance_of_improvement")
def by_a_rank_test(x, y):
    return stats.mannwhitneyu(x, y).statistic / (len(x) * len(y))


@wrong("bootstrap_interval", "single means at the two ends")
def from_a_sorted_list(scores, draws):
    means = sorted(scores[draw].mean() for draw in draws)
    return means[int(0.025 * len(means))], means[int(0.975 * len(means))]
