"""What ships of the study on other problems and of methods at equal decisions, and which of it the lesson shows."""

from functools import cache

import numpy as np
from scipy.stats import mannwhitneyu

from bootcourse.research import equal_decisions
from bootcourse.research.computed import experiment
from bootcourse.research.elsewhere_claims import Cells
from bootcourse.statistics import iqm

THREE = ("mountain-car", "cartpole", "lander")
AGENTS = 5  # of an entry to the challenge
BONUSES = {f"c = {c}": f"both, c = {c}" for c in (0, 0.03, 0.1, 0.3, 1)} | {"c = 2": "both"}


@cache
def cells() -> Cells:
    return Cells(experiment("elsewhere"))


@cache
def entries(first: int = 0) -> dict[str, np.ndarray]:
    """What five agents of each method earn after the challenge's decisions, {method: (5,)}, the best method first.

    first: their lowest seed. As on the board, a method is as good as the interquartile mean of its agents.
    """
    computed = equal_decisions.by_method(experiment("beyond"))
    all_seeds = {m: equal_decisions.at(each, "returns", equal_decisions.BOARD) for m, each in computed.items()}
    returns = {method: each[first : first + AGENTS] for method, each in all_seeds.items()}
    return dict(sorted(returns.items(), key=lambda entry: -iqm(entry[1])))


def places(first: int = 0) -> dict[str, int]:
    """The place of each entry: 1 for the best and for those that a rank test at 5 % does not tell from it."""
    (_, best), *_ = entries(first).items()
    return {
        method: place if mannwhitneyu(best, returns).pvalue < 0.05 else 1
        for place, (method, returns) in enumerate(entries(first).items(), start=1)
    }
