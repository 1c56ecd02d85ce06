"""What the numbers and claims in this lesson's text are computed from, beside tools/course/known.py."""

from functools import cache

import numpy as np
from scipy import stats

from bootcourse.statistics import ESCAPES, Estimate, interval, iqm, power, rate
from tools.course.known import escaped, escapers, fisher, of, shipped_experiment


def p_changed(method: str) -> float:
    """Fisher's p of a method's agents that escape: the study's against those with the KL in the actor only."""
    return fisher(escaped(method), escapers(shipped_experiment("ablations")["KL in the actor only"], method))


def in_actor_only() -> Estimate:
    """The share of agents with the soft constraint that escape if the KL is in the actor's loss only."""
    agents = shipped_experiment("ablations")["KL in the actor only"].of("soft")
    return rate(agents.scores("success") >= ESCAPES)


def enough(first: float, second: float, wanted: float = 0.8) -> int:
    """The fewest agents of each method with this power, at these true rates."""
    return next(n for n in range(2, 100) if power(first, second, n) >= wanted)


def most_false() -> float:
    """How often Fisher's test of ten against ten errs at most, over all rates that both groups may share."""
    shown = np.array([[fisher(k, j) < 0.05 for j in range(11)] for k in range(11)])
    counts = [stats.binom(10, rate).pmf(np.arange(11)) for rate in np.linspace(0, 1, 501)]
    return float(max(count @ shown @ count for count in counts))


@cache
def power_of_boschloo(first: float, second: float) -> float:
    """How often ten agents against ten, which escape at these true rates, differ by Boschloo's exact test."""
    shown = np.zeros((11, 11), dtype=bool)
    for k in range(11):
        for j in range(k + 1):
            p = stats.boschloo_exact([[k, 10 - k], [j, 10 - j]]).pvalue
            shown[k, j] = shown[j, k] = p < 0.05
    one, other = (stats.binom(10, rate).pmf(np.arange(11)) for rate in (first, second))
    return float(one @ shown @ other)


@cache
def covered(studies: int = 3000) -> float:
    """How often the bootstrap interval of ten holds the true mean, if 7 of 10 agents earn 127 and 3 of 10 earn 9.

    With standard deviations of 2 and 30, near those of our bootstrapped agents.
    """
    rng, held = np.random.default_rng(0), 0
    for _ in range(studies):
        few, many = rng.normal(9, 30, 10), rng.normal(127, 2, 10)
        scores = np.where(rng.random(10) < 0.7, many, few)
        low, high = np.percentile(scores[rng.integers(0, 10, (1000, 10))].mean(1), [2.5, 97.5])
        held += low <= 0.7 * 127 + 0.3 * 9 <= high
    return held / studies


def nearest_to_iqm(method: str) -> float:
    """How far the interquartile mean of a method's returns is from the agent nearest to it."""
    returns = of(method).scores("returns")
    return float(np.abs(returns - iqm(returns)).min())


def half_interval(method: str) -> float:
    """Half the length of the 95 % interval of a method's mean return."""
    _, low, high = interval(of(method).scores("returns"), np.mean)
    return (high - low) / 2


def accidents_of(method: str, escape: bool) -> float:
    """In how many % of their drives the agents of a method that escape, or those that do not, have an accident."""
    escapes = of(method).scores("success") >= ESCAPES
    return float(100 * of(method).scores("accident")[escapes == escape].mean())
