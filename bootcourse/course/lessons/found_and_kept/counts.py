"""For the lesson: the paper's rows beside ours, and the agents of round 4."""

from bootcourse.course.shipped import shipped_experiment
from bootcourse.methods import display_name
from bootcourse.research.cells import VARIED
from bootcourse.research.experiments import clocks
from bootcourse.research.paper import PRINTED
from bootcourse.research.results import Results
from bootcourse.research.tables import escaped

BOTH_TABLES = ["", "the paper's success", "the paper's return", "our agents that escape", "our return"]
SYMBOLS = {"the rule": "μ", "the stochastic rule": "π̃"}


def printed() -> dict[str, float]:
    """The paper's success of each method, %."""
    return {method: PRINTED[method]["success"].mean for method in VARIED}


def both_tables(study: Results) -> list[list[str]]:
    """A row for each method of the paper's Table 4, below `BOTH_TABLES`: what the paper prints, and our agents."""
    rows = [(m, rate, PRINTED[m]["returns"].mean) for m, rate in printed().items()]
    ours = {m: f"{study.of(m).scores('returns').mean():.0f}" for m in VARIED}
    return [[display_name(m), f"{rate:.0f} %", f"{earned:.0f}", escaped(study, m), ours[m]] for m, rate, earned in rows]


def by_updates(driver: str) -> dict[str, Results]:
    """The four methods' agents of round 4 whose demonstrations this driver gave: {updates for a decision: results}.

    driver: "the rule" or "the stochastic rule".
    """
    settings = clocks.choices(shipped_experiment("clocks")).items()
    return {updates: agents for (updates, by), agents in settings if by == SYMBOLS[driver]}
