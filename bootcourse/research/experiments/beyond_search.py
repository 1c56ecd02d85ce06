"""The search before `beyond`: three settings of each method, on seeds and roads that no test uses."""

from pathlib import Path

from bootcourse.learn.settings import with_seeds
from bootcourse.research import equal_decisions
from bootcourse.research.cells import results_of
from bootcourse.research.experiment import Computed, Experiment
from bootcourse.research.results import Results
from bootcourse.research.tables import markdown


def cells() -> dict[str, dict]:
    """A method each."""
    return {method: {"method": method} for method in equal_decisions.COMMON}


def searched(method: str) -> Results:
    """Every try with a few seeds, tested on `SEARCH_ROADS`. Raises Interrupted."""
    first, n = equal_decisions.FIRST_SEARCH_SEED, equal_decisions.SEARCH_SEEDS
    agents = [with_seeds(one, n, first) for one in equal_decisions.tries(method)]
    groups = agents if method.startswith("ppo") else [sum(agents, [])]  # what differs in η alone trains side by side
    budgets, roads = [equal_decisions.SEARCHED], equal_decisions.SEARCH_ROADS
    return equal_decisions.joined([equal_decisions.trained_and_tested(group, budgets, roads) for group in groups])


def section(computed: dict[str, Computed], folder: Path) -> list[str]:
    """What each try earned."""
    rows = equal_decisions.search_rows(computed["beyond-search"])
    return ["### The search before it\n", markdown(*rows)]


EXPERIMENT = Experiment("beyond-search", cells, results_of(searched), (), section)
