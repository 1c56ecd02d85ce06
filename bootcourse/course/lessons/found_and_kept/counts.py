"""For the lesson: the paper's success, and the agents of round 4."""

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
