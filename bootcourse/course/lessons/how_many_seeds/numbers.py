"""What the numbers and claims in this lesson's text are computed from, beside tools/course/known.py."""

from collections import Counter
from itertools import combinations_with_replacement
from math import factorial, prod

import numpy as np

from bootcourse.statistics import interval, power, rate
from tools.course.known import of, others


def half_as_wide() -> int:
    """The number of agents, 80 % of which escape, whose exact interval comes closest to half the width of ten's."""

    def width(n: int) -> float:
        _, low, high = rate(np.arange(n) < round(0.8 * n))
        return high - low

    return min(range(2, 61), key=lambda n: abs(width(n) - width(10) / 2))


def enough(first: float, second: float, wanted: float = 0.8) -> int:
    """The fewest agents of each method with this power, at these true rates."""
    return next(n for n in range(2, 100) if power(first, second, n) >= wanted)


def half_interval(method: str) -> float:
    """Half the length of the 95 % interval of a method's mean return."""
    _, low, high = interval(of(method).scores("returns"), np.mean)
    return (high - low) / 2


def apart(method: str) -> float:
    """By how much the mean return of the ten others differs from that of the study's ten."""
    return abs(float(others(method).scores("returns").mean() - of(method).scores("returns").mean()))


def held(method: str, seeds: int) -> float:
    """How often the interval of so many agents would hold the mean of ours, if ours were all the agents there are."""
    returns, share = of(method).scores("returns"), 0.0
    for drawn in combinations_with_replacement(range(len(returns)), seeds):
        orders = factorial(seeds) / prod(map(factorial, Counter(drawn).values()))
        _, low, high = interval(returns[list(drawn)], np.mean)
        share += orders / len(returns) ** seeds * (low <= returns.mean() <= high)
    return share
