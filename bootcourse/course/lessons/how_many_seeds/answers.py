"""Answers to the exercises of the lesson on seeds."""

import numpy as np

from tests.answers import equivalent, right_lines, wrong_lines

right_lines("""power
    pair by pair: n = len(shown) - 1; k, j = stats.binom(n, first), stats.binom(n, second)
        sum(k.pmf(a) * j.pmf(b) for a in range(n + 1) for b in range(n + 1) if shown[a, b])
    as a product of matrices: n = len(shown) - 1; counts = np.arange(n + 1)
        float(stats.binom.pmf(counts, n, first) @ shown @ stats.binom.pmf(counts, n, second))
""")

wrong_lines("""power
    in one direction: solution(first, second, np.tril(shown))
""")

right_lines("""bootstrap_interval
    draw by draw: means = [np.mean([scores[i] for i in draw]) for draw in draws]; np.quantile(means, [0.025, 0.975])
    by counting: counts = np.stack([np.bincount(draw, minlength=len(scores)) for draw in draws])
        np.percentile(counts @ scores / draws.shape[1], (2.5, 97.5))
""")

right_lines("""bootstrap_interval
    counted off in a sorted list: means = sorted(scores[draw].mean() for draw in draws)
        means[int(0.025 * len(means))], means[int(0.975 * len(means))]
    the next mean below: np.quantile(scores[draws].mean(1), [0.025, 0.975], method="lower")
    as other programs do: np.quantile(scores[draws].mean(1), [0.025, 0.975], method="weibull")
    a tensor: torch.tensor(scores)[torch.tensor(draws)].mean(1).quantile(torch.tensor([0.025, 0.975]).double())
""")

wrong_lines("""bootstrap_interval
    two per cent at each end: np.percentile(scores[draws].mean(1), [2, 98])
    mirrored: low, high = np.percentile(scores[draws].mean(1), [2.5, 97.5])
        2 * scores.mean() - high, 2 * scores.mean() - low
    the wrong way round: np.percentile(scores[draws].mean(1), [97.5, 2.5])
    smallest and largest: means = scores[draws].mean(1); (means.min(), means.max())
    an object: object()  # an object
    three numbers: [1.0, 2.0, 3.0]
    texts: ["low", "high"]
    rows of two lengths: [[1.0], [1.0, 2.0]]
""")

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


right_lines("""difference_interval
    in a loop: each = [middle_mean(x[a]) - middle_mean(y[b]) for a, b in zip(draws_x, draws_y, strict=True)]
        np.array([middle_mean(x) - middle_mean(y), np.percentile(each, 2.5), np.percentile(each, 97.5)])
""")


right_lines("""difference_interval
    another interpolation: each = stats.trim_mean(x[draws_x], 0.25, axis=1) - stats.trim_mean(y[draws_y], 0.25, axis=1)
        middle_mean(x) - middle_mean(y), *np.quantile(each, [0.025, 0.975], method="hazen")
""")

wrong_lines("""difference_interval
    the middle of the resamples:
        each = stats.trim_mean(x[draws_x], 0.25, axis=1) - stats.trim_mean(y[draws_y], 0.25, axis=1)
        np.median(each), *np.percentile(each, [2.5, 97.5])
    the difference last:
        each = stats.trim_mean(x[draws_x], 0.25, axis=1) - stats.trim_mean(y[draws_y], 0.25, axis=1)
        *np.percentile(each, [2.5, 97.5]), middle_mean(x) - middle_mean(y)
    medians of both: each = np.median(x[draws_x], axis=1) - np.median(y[draws_y], axis=1)
        np.array([np.median(x) - np.median(y), *np.percentile(each, [2.5, 97.5])])
""")
