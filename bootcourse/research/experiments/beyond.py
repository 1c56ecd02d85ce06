"""Methods that the paper does not train, at equal numbers of decisions, with the settings of `beyond-search`."""

from pathlib import Path

from bootcourse.episodes.evaluate import held_out_seeds
from bootcourse.learn.settings import with_seeds
from bootcourse.research.cells import TESTS, results_of
from bootcourse.research.equal_decisions import (
    BUDGETS,
    CHOSEN,
    COMMON,
    GROUP,
    budget_rows,
    by_method,
    last_of,
    seconds_rows,
    trained_and_tested,
    tries,
)
from bootcourse.research.experiment import Computed, Experiment
from bootcourse.research.jobs import HELD_OUT
from bootcourse.research.results import Results
from bootcourse.research.tables import markdown

SEEDS = 10  # of training


def cells() -> dict[str, dict]:
    """`GROUP` agents of a method each."""
    firsts = range(0, SEEDS, GROUP)
    return {f"{method}-{first}": {"method": method, "first": first} for first in firsts for method in COMMON}


def trained_to_budgets(method: str, first: int) -> Results:
    """The chosen try with `GROUP` seeds from `first` on, tested at each budget. Raises Interrupted.

    `tested` is at `BOARD`, `measured` has the means at each budget: returns_100000, success_100000 ...
    """
    settings = with_seeds(tries(method)[CHOSEN[method]], GROUP, first)
    budgets = [budget for budget in BUDGETS if budget <= last_of(method, first)]
    return trained_and_tested(settings, budgets, held_out_seeds(HELD_OUT, TESTS))


def section(computed: dict[str, Computed], folder: Path) -> list[str]:
    """What each method reached after each budget, and after equal seconds."""
    later = by_method(computed["beyond"])
    text = ["## Other learners, at equal decisions\n", BUDGET, markdown(*budget_rows(later))]
    return text + ["### After equal seconds\n", EQUAL_SECONDS, markdown(*seconds_rows(later))]


BUDGET = """Each method has γ = 0.97 and the best of three settings, which were compared on other seeds and roads (the
table below). Tested with most probable actions on the held-out roads. The teacher's decisions in demonstrations are not
counted. Seconds are those of one core, shared among the agents that trained side by side. RLPD takes about five times
as long for a decision as the others with a replay buffer, and stops at the second budget, as half of their agents do.
Plain SAC trained on a slower machine, so its seconds are not compared.
"""
EQUAL_SECONDS = """The last 50 training episodes that ended in so much time, with drawn actions; the teacher drives the
beginning of jump-start RL's.
"""

EXPERIMENT = Experiment("beyond", cells, results_of(trained_to_budgets), ("return", "decisions"), section)
