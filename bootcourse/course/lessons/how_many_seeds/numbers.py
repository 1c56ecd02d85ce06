"""What the numbers and claims in this lesson's text are computed from, beside tools/course/known.py."""

from collections import Counter
from collections.abc import Callable
from itertools import combinations_with_replacement
from math import factorial, prod

import numpy as np

from bootcourse.course.lessons.how_many_seeds import explorable  # noqa: F401 (for the expressions)
from bootcourse.research.results import Results
from bootcourse.statistics import Estimate, improvement, interval, power, rate, significant  # noqa: F401
from tools.course.known import of


def half_as_wide() -> int:
    """The number of agents, 80 % of which escape, whose exact interval comes closest to half the width of ten's."""

    def width(n: int) -> float:
        _, low, high = rate(np.arange(n) < round(0.8 * n))
        return high - low

    return min(range(2, 61), key=lambda n: abs(width(n) - width(10) / 2))


def enough(first: float, second: float, wanted: float = 0.8) -> int:
    """The fewest agents of each method with this power, at these true rates."""
    return next(n for n in range(2, 100) if power(first, second, n) >= wanted)


def better(agents: Callable[[str], Results]) -> Estimate:
    """In how many per cent of the pairs the bootstrapped agent earns more than the one with the soft constraint."""
    both, soft = (agents(method).scores("returns") for method in ("bootstrapped", "soft"))
    return Estimate(*(100 * each for each in improvement(both, soft)))


def first_three_hold(method: str) -> bool:
    """Does the interval of our first three agents hold the mean return of all ten?"""
    returns = of(method).scores("returns")
    _, low, high = interval(returns[:3], np.mean)
    return bool(low <= returns.mean() <= high)


def held(method: str, seeds: int) -> float:
    """How often the interval of so many agents would hold the mean of ours, if ours were all the agents there are."""
    returns, share = of(method).scores("returns"), 0.0
    for drawn in combinations_with_replacement(range(len(returns)), seeds):
        orders = factorial(seeds) / prod(map(factorial, Counter(drawn).values()))
        _, low, high = interval(returns[list(drawn)], np.mean)
        share += orders / len(returns) ** seeds * (low <= returns.mean() <= high)
    return share
