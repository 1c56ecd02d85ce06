"""What the numbers and claims in this lesson's text are computed from, beside tools/course/known.py."""

from typing import NamedTuple

import numpy as np
from bootcourse.research import clocks as study_clocks
from bootcourse.research import sweep
from bootcourse.research.paper import PRINTED
from bootcourse.research.results import WINDOW, Results  # noqa: F401 (the text names it)
from bootcourse.statistics import ESCAPES, interval, iqm
from scipy import stats
from tools.course.known import clocks, escaped, escapers, fisher, of, shipped_experiment, shipped_results, varied


def ablations() -> dict[str, Results]:
    """The ten agents of each method with one choice of the method changed, by what was changed."""
    return shipped_experiment("ablations")


def p_changed(change: str, method: str) -> float:
    """Fisher's p of a method's agents that escape in the study against those with one choice changed."""
    return fisher(escaped(method), escapers(ablations()[change], method))


def clocks_run_down(updates: str) -> float:
    """The episode in which the soft agents' ξ is down to a tenth, the median of ten."""
    return study_clocks.faded(clocks()[updates, "π̃"].of("soft").curves["xi"])


def clocks_out(updates: str) -> float:
    """The first 50 episodes in a row, by their end, in which a soft agent is ahead in most: the median of ten."""
    success = clocks()[updates, "π̃"].of("soft").curves["success"]
    most = np.array([np.convolve(curve, np.ones(50) / 50, "valid") > 0.5 for curve in success])
    return float(np.median(np.where(most.any(1), most.argmax(1) + 50, success.shape[1])))


def nearest_to_iqm(method: str) -> float:
    """How far the interquartile mean of a method's returns is from the agent nearest to it."""
    returns = of(method).scores("returns")
    return float(np.abs(returns - iqm(returns)).min())


def with_one_agent(method: str) -> float:
    """Fisher's p of our agents that escape against the paper's row, if one agent stands behind that row."""
    won, theirs = escaped(method), int(PRINTED[method]["success"].mean >= 50)
    return float(stats.fisher_exact([[won, len(of(method)) - won], [theirs, 1 - theirs]]).pvalue)


def positive_target(method: str, measure: str, change: str = "entropy") -> np.ndarray:
    """Scores of a method's agents in the variations with a positive target entropy."""
    return np.concatenate([varied()[c].of(method).scores(measure) for c in varied() if change in c])


class Counted(NamedTuple):
    """How many agents found the way out, how many of these kept it, and of how many."""

    found: int
    kept: int
    n: int


class Won(NamedTuple):
    """How many agents escape, of how many."""

    won: int
    n: int


def of_all() -> Results:
    """The study's agents, every method's."""
    return shipped_results()


def way(results: Results, method: str) -> Counted:
    """Of a method's agents, see `Results.found_and_kept`."""
    found, kept = results.found_and_kept(method)
    return Counted(int(found.sum()), int(kept.sum()), len(found))


def over_updates(driver: str) -> Counted:
    """The agents with demonstrations alone of one driver, over all numbers of updates."""
    each = [way(clocks()[updates, driver], "demos") for updates in study_clocks.UPDATES]
    return Counted(*(sum(column) for column in zip(*each, strict=True)))


def keeping_p(method: str) -> float:
    """Fisher's p: of the agents that found the way out, do more keep it if β never ends than if it ends at 1,000?"""
    ends, stays = way(of_all(), method), way(ablations()["β for ever"], method)
    return float(stats.fisher_exact([[each.kept, each.found - each.kept] for each in (ends, stays)]).pvalue)


def stratified_p(pairs: list[tuple[Counted, Counted]], which: str) -> float:
    """The exact p of a difference between the first and the second group, compared within each pair.

    Given how many agents won in each pair, those of the first group have a hypergeometric distribution; their sum
    over the pairs has the convolution. As in Fisher's test, p adds up what is at most as probable as what happened.
    """
    chances, won = np.ones(1), 0
    for first, second in pairs:
        both, won = getattr(first, which) + getattr(second, which), won + getattr(first, which)
        own = stats.hypergeom(first.n + second.n, both, first.n).pmf(np.arange(first.n + 1))
        chances = np.convolve(chances, own)
    return float(chances[chances <= chances[won] * (1 + 1e-9)].sum())


def driver_p(which: str) -> float:
    """μ against π̃, with demonstrations alone, at each number of updates."""
    pairs = [tuple(way(clocks()[updates, d], "demos") for d in ("μ", "π̃")) for updates in study_clocks.UPDATES]
    return stratified_p(pairs, which)


def updates_p(which: str) -> float:
    """A quarter of an update against two, with demonstrations alone, for each driver."""
    pairs = [tuple(way(clocks()[updates, d], "demos") for updates in ("1/4", "2")) for d in ("μ", "π̃")]
    return stratified_p(pairs, which)


def trend_p() -> float:
    """The two-sided p of a trend: of the soft agents, do fewer keep the way out with each doubling of the updates?

    By 100,000 permutations of which agents keep it; the statistic is the covariance with the logarithm of the updates.
    """
    groups = [clocks()[of].found_and_kept("soft")[1] for of in (("1/4", "π̃"), ("1", "π̃"), ("2", "π̃"), ("4", "π̃"))]
    kept = np.concatenate(groups).astype(float)
    doublings = np.repeat([-2.0, 0.0, 1.0, 2.0], [len(each) for each in groups])
    doublings -= doublings.mean()
    drawn = np.random.default_rng(0).permuted(np.tile(kept, (100_000, 1)), axis=1) @ doublings
    return float(np.mean(np.abs(drawn) >= abs(kept @ doublings) - 1e-9))


def power(first: float, second: float, n: int = 10) -> float:
    """How often n agents against n, with these true rates, have a Fisher's p below 0.05."""
    chance = np.outer(*(stats.binom(n, rate).pmf(np.arange(n + 1)) for rate in (first, second)))
    below = [[stats.fisher_exact([[a, n - a], [b, n - b]]).pvalue < 0.05 for b in range(n + 1)] for a in range(n + 1)]
    return float(chance[np.array(below)].sum())


def half_interval(method: str) -> float:
    """Half the length of the 95 % interval of a method's mean return."""
    _, low, high = interval(of(method).scores("returns"), np.mean)
    return (high - low) / 2


def of_sweep(setting: str, value: float) -> Won:
    """The sweep's agents with this value that escape; of those with ξ above 0, unless the setting is ξ."""
    swept = sweep.load_sweep()
    mine = np.array(
        [each[setting] == value and (setting == "xi_multiplier" or each["xi_multiplier"] > 0) for each in swept.agents]
    )
    return Won(int((swept.scores("success")[mine] >= ESCAPES).sum()), int(mine.sum()))
