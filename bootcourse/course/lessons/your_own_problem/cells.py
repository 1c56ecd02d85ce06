"""What ships of the study on other problems and of methods at equal decisions, and which of it the lesson shows."""

from functools import cache

import numpy as np

from bootcourse.research import equal_decisions
from bootcourse.research.computed import experiment
from bootcourse.research.elsewhere_claims import Cells
from bootcourse.statistics import iqm

TWO = ("mountain-car", "cartpole")
AGENTS = 5  # of an entry to the challenge
BONUSES = {f"c = {c}": f"both, c = {c}" for c in (0, 0.03, 0.1, 0.3, 1)} | {"c = 2": "both"}


@cache
def cells() -> Cells:
    return Cells(experiment("elsewhere"))


@cache
def entries() -> dict[str, np.ndarray]:
    """What the first agents of each method earn after the challenge's decisions, {method: (5,)}, the best method first.

    As on the board, a method is as good as the interquartile mean of its agents.
    """
    computed = equal_decisions.by_method(experiment("beyond"))
    returns = {m: equal_decisions.at(each, "returns", equal_decisions.BOARD)[:AGENTS] for m, each in computed.items()}
    return dict(sorted(returns.items(), key=lambda entry: -iqm(entry[1])))
