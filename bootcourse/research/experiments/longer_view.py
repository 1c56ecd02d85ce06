"""The paper's method with a longer view, a smaller bonus, a larger batch and two updates per decision."""

from pathlib import Path

from bootcourse.learn.settings import SETTINGS
from bootcourse.research import tables
from bootcourse.research.beyond import learner_rows
from bootcourse.research.cells import SHIPPED_CURVES, TESTS, train_and_test, trained
from bootcourse.research.experiment import Computed, Experiment

SANER = {**SETTINGS["paper"], "gamma": 0.95, "bonus": 0.5, "batch": 128}


def cells(seeds: int = 10, episodes: int = 1500, tests: int = TESTS) -> dict[str, dict]:
    """A single one."""
    return {"γ = 0.95": trained(seeds, episodes, tests, methods=("bootstrapped",), **SANER)}


def section(computed: dict[str, Computed], folder: Path) -> list[str]:
    """What these agents reached, and at which cost."""
    return ["## A longer view\n", LONGER_VIEW, tables.markdown(*learner_rows(computed["longer-view"]))]


LONGER_VIEW = """The paper's method with two updates per decision, a bonus of 0.5 instead of 2, batches of 128 instead
of 64, and a γ of 0.95 instead of 0.8.
"""

EXPERIMENT = Experiment("longer-view", cells, train_and_test, SHIPPED_CURVES, section)
