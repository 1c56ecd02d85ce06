"""What the numbers and claims in this lesson's text are computed from, beside tools/course/known.py."""

import numpy as np
from bootcourse.research.tables import bracketed  # noqa: F401 (the text names it)
from bootcourse.statistics import ESCAPES, Estimate, interval, iqm, power, rate
from scipy import stats
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
