"""What the numbers and claims in this lesson's text are computed from, beside tools/course/known.py."""

from functools import cache

import numpy as np
from scipy import stats

from bootcourse.statistics import ESCAPES, Estimate, bracketed, improvement, interval, power, rate
from tools.course.known import escaped, escapers, fisher, in_training, of, others, shipped_experiment


def p_changed(method: str) -> float:
    """Fisher's p of a method's agents that escape: the study's against those with the KL in the actor only."""
    return fisher(escaped(method), escapers(shipped_experiment("ablations")["KL in the actor only"], method))


def in_actor_only() -> Estimate:
    """The share of agents with the soft constraint that escape if the KL is in the actor's loss only."""
    agents = shipped_experiment("ablations")["KL in the actor only"].of("soft")
    return rate(agents.scores("success") >= ESCAPES)


def half_as_wide() -> int:
    """The number of agents, 80 % of which escape, whose exact interval comes closest to half the width of ten's."""

    def width(n: int) -> float:
        _, low, high = rate(np.arange(n) < round(0.8 * n))
        return high - low

    return min(range(2, 61), key=lambda n: abs(width(n) - width(10) / 2))


def enough(first: float, second: float, wanted: float = 0.8) -> int:
    """The fewest agents of each method with this power, at these true rates."""
    return next(n for n in range(2, 100) if power(first, second, n) >= wanted)


@cache
def boschloo(first: float, second: float, n: int) -> float:
    """The power of Boschloo's exact test, n agents against n, at these true rates."""
    counts = np.arange(n + 1)
    k, j = (stats.binom.pmf(counts, n, each) for each in (first, second))
    p = {(a, b): stats.boschloo_exact([[a, b], [n - a, n - b]]).pvalue for a in counts for b in range(a)}
    return float(sum(k[a] * j[b] + k[b] * j[a] for (a, b), each in p.items() if each < 0.05))


def enough_by_boschloo(first: float, second: float, least: int = 10) -> int:
    """The fewest agents of each method, at least `least`, with which Boschloo's test has a power of 80 %."""
    return next(n for n in range(least, 100) if boschloo(first, second, n) >= 0.8)


def half_interval(method: str) -> float:
    """Half the length of the 95 % interval of a method's mean return."""
    _, low, high = interval(of(method).scores("returns"), np.mean)
    return (high - low) / 2


def apart(method: str) -> float:
    """By how much the mean return of the ten others differs from that of the study's ten."""
    return abs(float(others(method).scores("returns").mean() - of(method).scores("returns").mean()))


def others_improve() -> str:
    """ "60 [34, 84]": how often one of the ten others with both aids earns more than one with the soft constraint."""
    both, soft = (others(method).scores("returns") for method in ("bootstrapped", "soft"))
    return bracketed(improvement(both, soft), 100)


def succeeding_by_then(least: float) -> tuple[int, int]:
    """How many agents with demonstrations alone succeed in more than this share of the training episodes 1,800 to
    2,000: of the study's ten, of the ten others."""
    theirs = others("demos").curves["success"][:, 1800:2000].mean(axis=1)
    return int((in_training("demos", 1800, 2000) > least).sum()), int((theirs > least).sum())
