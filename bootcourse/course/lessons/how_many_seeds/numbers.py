"""What the numbers and claims in this lesson's text are computed from, beside tools/course/known.py."""

from collections import Counter
from functools import cache
from itertools import combinations_with_replacement
from math import factorial, prod

import numpy as np

from bootcourse.course.lessons.how_many_seeds import counts, explorable  # noqa: F401 (the text names it)
from bootcourse.statistics import Estimate, holm, interval, iqm, power, rate  # noqa: F401 (the text names some)
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


def others_escape(method: str) -> int:
    """How many of ten others escape, which were trained for twice the study's episodes."""
    return shipped_experiment("stress")[method].escapers(method)


@cache
def errs(agents: int) -> float:
    """At most so often Fisher's test of so many agents against as many finds a difference between equal true rates."""
    return max(power(true, true, agents) for true in np.linspace(0, 0.5, 26))  # alike above


def family(sizes: list[int]) -> float:
    """At most so often at least one of independent tests of so many agents against as many does."""
    return 1 - float(np.prod([1 - errs(agents) for agents in sizes]))


def length(agents: int) -> float:
    """How long its interval is, in points."""
    return new(agents).high - new(agents).low
