"""Computed for the lesson: two groups of an ablation, and comparisons in which nothing was changed."""

from collections.abc import Callable

import numpy as np

from bootcourse.statistics import Estimate, all_resamples, bracketed, iqm

ABLATION = ["success, %", "IQM", "the agents, sorted"]
RESAMPLES = 10_000


def ablation(success: dict[str, np.ndarray], interval_of: Callable) -> tuple[list[list[str]], str]:
    """The rows below `ABLATION` of two groups of agents (success 0 to 1), and their difference as a sentence.

    interval_of: the exercise `difference_interval`, the student's or ours.
    """
    groups = {name: 100 * np.sort(group) for name, group in success.items()}
    rows = [[name, f"{iqm(each):.0f}", ", ".join(f"{one:.0f}" for one in each)] for name, each in groups.items()]
    unchanged, changed = groups.values()
    rng = np.random.default_rng(0)
    draws = [rng.integers(len(each), size=(RESAMPLES, len(each))) for each in (changed, unchanged)]
    effect = Estimate(*map(float, interval_of(changed, unchanged, *draws)))
    says = "leaves out 0" if leaves_out_0(effect) else "contains 0"
    return rows, f"Changed less unchanged: {bracketed(effect)} points. The interval {says}."


def leaves_out_0(effect: Estimate) -> bool:
    return not effect.low <= 0 <= effect.high


def exact_difference(x: np.ndarray, y: np.ndarray) -> Estimate:
    """`statistics.difference` of two small groups, (n,) each, from all their resamples instead of random ones."""
    rows, chances = all_resamples(*[1] * len(x))
    resampled = np.subtract.outer(iqm(x[rows]), iqm(y[rows])).ravel()
    order = np.argsort(resampled)
    upward = np.outer(chances, chances).ravel()[order]
    below, above = (np.searchsorted(np.cumsum(each), 0.025) for each in (upward, upward[::-1]))
    return Estimate(float(iqm(x) - iqm(y)), *map(float, resampled[order[[below, -1 - above]]]))


def random_halves(scores: np.ndarray, times: int = 20) -> list[Estimate]:
    """One half of the scores less the other, split so many times at random, the lowest difference first."""
    rng = np.random.default_rng(0)
    splits = (np.split(rng.permutation(scores), 2) for _ in range(times))
    return sorted(exact_difference(x, y) for x, y in splits)
