"""What the numbers and claims in this lesson's text are computed from, beside tools/course/known.py."""

import numpy as np

from bootcourse.statistics import ESCAPES, Estimate, interval, power, rate
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


def half_interval(method: str) -> float:
    """Half the length of the 95 % interval of a method's mean return."""
    _, low, high = interval(of(method).scores("returns"), np.mean)
    return (high - low) / 2
