"""What the numbers and claims in this lesson's text are computed from, beside tools/course/known.py."""

from collections import Counter
from collections.abc import Callable
from functools import cache
from itertools import combinations_with_replacement
from math import factorial, prod

import numpy as np

from bootcourse.course.lessons.how_many_seeds import counts, explorable
from bootcourse.statistics import ESCAPES, Estimate, bracketed, difference, interval, iqm, power, rate  # noqa: F401
from tools.course.known import of, shipped_experiment


def fitting(mean: float, sd: float) -> list[tuple[int, int]]:
    """All (accidents, drives), up to 500 drives, whose rate in % has this mean and standard deviation, as printed."""
    n, k = np.mgrid[2:501, 0:501]
    p = np.where(k <= n, k / n, np.nan)
    sds = 100 * np.sqrt(p * (1 - p) * n / (n - 1))
    fits = (np.abs(100 * p - mean) < 0.005) & (np.abs(sds - sd) <= 0.005)
    return list(zip(k[fits].tolist(), n[fits].tolist(), strict=True))


def enough(first: float, second: float, wanted: float = 0.8) -> int:
    """The fewest agents of each method with this power, at these true rates."""
    return next(n for n in range(2, 100) if power(first, second, n) >= wanted)


def held(method: str, seeds: int) -> float:
    """How often the interval of so many agents would hold the mean of ours, if ours were all the agents there are."""
    returns, share = of(method).scores("returns"), 0.0
    for drawn in combinations_with_replacement(range(len(returns)), seeds):
        orders = factorial(seeds) / prod(map(factorial, Counter(drawn).values()))
        _, low, high = interval(returns[list(drawn)], np.mean)
        share += orders / len(returns) ** seeds * (low <= returns.mean() <= high)
    return share


@cache
def twice() -> list[Estimate]:
    """What the figure without a change shows, the lowest difference first."""
    return counts.drawn_twice(of("bootstrapped").scores("returns"))


@cache
def new(agents: int) -> Estimate:
    """The lesson's ablation with so many new agents of each group."""
    return counts.of_new_agents(shipped_experiment("new-agents"), agents)


def length(agents: int) -> float:
    """How long its interval is, in points."""
    return new(agents).high - new(agents).low


@cache
def fives() -> np.ndarray:
    """How long the intervals of the new agents are, in points, five of each group at a time: (8,), the first first."""
    groups = [100 * shipped_experiment("new-agents")[name].measured["success"] for name in ("changed", "as it is")]
    pairs = zip(*(np.split(each, len(each) // counts.FIVE) for each in groups), strict=True)
    return np.array([effect.high - effect.low for effect in (difference(*pair) for pair in pairs)])


@cache
def ratios(measure: Callable) -> Estimate:
    """Changed over unchanged of all new agents: the ratio of their IQMs, or of their means, with its interval."""
    (changed, same), (over, under) = (
        _new(),
        [measure(each[draws], axis=1) for each, draws in zip(_new(), _draws(), strict=True)],
    )
    return Estimate(measure(changed) / measure(same), *np.quantile(over / under, [0.025, 0.975]))


def ratio(measure: Callable) -> str:
    """It as "1.5 [0.86, 2.85]"."""
    value, low, high = ratios(measure)
    return f"{value:.1f} [{low:.2f}, {high:.2f}]"


def just_below() -> float:
    """The largest success of a bootstrapped agent that does not escape."""
    success = of("bootstrapped").scores("success")
    return float(success[success < ESCAPES].max())


def missing(seeds: int) -> tuple[list[int], int]:
    """Of Round 3's 100 intervals that miss the mean: the places, by length, of those above it; how many are below.

    Those below are counted only if they are longer than half of all.
    """
    low, high, holds = explorable.drawn(seeds)
    place = np.argsort(np.argsort(high - low, kind="stable"))
    below = ~holds & (high < of("bootstrapped").scores("returns").mean())
    return sorted(place[~holds & ~below].tolist()), int((place[below] > 50).sum())


def _draws() -> list[np.ndarray]:
    rng = np.random.default_rng(0)
    return [rng.integers(len(each), size=(counts.RESAMPLES, len(each))) for each in _new()]


def _new() -> list[np.ndarray]:
    """The success (%) of all new agents: changed, and as it is."""
    return [100 * shipped_experiment("new-agents")[group].measured["success"] for group in ("changed", "as it is")]


def percent(escape: int) -> str:
    """The exact interval of so many of ten, as "0.3 to 45"."""
    return " to ".join(
        f"{100 * end:.0f}" if end > 0.01 else f"{100 * end:.1f}" for end in rate(np.arange(10) < escape)[1:]
    )
