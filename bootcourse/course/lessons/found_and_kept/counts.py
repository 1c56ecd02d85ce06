"""For the lesson: the paper's success, and the agents of round 4."""

from collections.abc import Sequence

import numpy as np

from bootcourse.course.shipped import shipped_experiment
from bootcourse.research.cells import VARIED
from bootcourse.research.experiments import clocks
from bootcourse.research.paper import PRINTED
from bootcourse.research.results import Results

SYMBOLS = {"the rule": "μ", "the stochastic rule": "π̃"}


def printed() -> dict[str, float]:
    """The paper's success of each method, %."""
    return {method: PRINTED[method]["success"].mean for method in VARIED}


def by_updates(driver: str) -> dict[str, Results]:
    """The four methods' agents of round 4 whose demonstrations this driver gave: {updates for a decision: results}.

    driver: "the rule" or "the stochastic rule".
    """
    settings = clocks.choices(shipped_experiment("clocks")).items()
    return {updates: agents for (updates, by), agents in settings if by == SYMBOLS[driver]}


def how_many(rates: Sequence[np.ndarray]) -> str:
    """Behind a number: how many agents each method has, if not ten, as " (3 each)" or " (4 to 10)"."""
    few, most = min(map(len, rates)), max(map(len, rates))
    return "" if few == 10 else f" ({few} each)" if few == most else f" ({few} to {most})"
