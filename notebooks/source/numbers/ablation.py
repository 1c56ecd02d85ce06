"""What the numbers and claims in this lesson's text are computed from, beside tools/course/known.py."""

import numpy as np
from bootcourse.research import clocks as study_clocks
from bootcourse.research.paper import PRINTED
from bootcourse.research.results import Results
from bootcourse.statistics import iqm
from scipy import stats
from tools.course.known import clocks, escaped, escapers, fisher, of, shipped_experiment, varied


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
