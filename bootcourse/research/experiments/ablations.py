"""One choice of the method changed, or two: the KL's place, no bonus, how long β lasts, a ξ that stays."""

from pathlib import Path

from bootcourse.research import tables
from bootcourse.research.cells import SHIPPED_CURVES, TESTS, train_and_test, trained
from bootcourse.research.experiment import Computed, Experiment

HELPED = ("demos", "bootstrapped")
CHANGED = {
    "KL in the actor only": {"kl_in_target": False, "methods": ("soft", "bootstrapped")},
    "c = 0": {"bonus": 0.0, "methods": HELPED},
    "β over 300 episodes": {"beta_episodes": 300, "methods": HELPED},
    "β for ever": {"beta_episodes": None, "methods": HELPED},
    "β for ever, c = 0": {"beta_episodes": None, "bonus": 0.0, "methods": ("bootstrapped",)},
    **{f"ξ stays at {xi:g}": {"xi_fixed": xi, "methods": ("soft",)} for xi in (2.0, 0.5, 0.1)},
    "ξ falls to 0.1": {"xi_min": 0.1, "methods": ("soft",)},
}


def cells(seeds: int = 10, episodes: int = 2000, tests: int = TESTS) -> dict[str, dict]:
    """The methods that the choice is about."""
    return {name: trained(seeds, episodes, tests, **changes) for name, changes in CHANGED.items()}


def section(computed: dict[str, Computed], folder: Path) -> list[str]:
    """Who escapes and what they earn."""
    return ["## One choice of the method changed\n", tables.variations_table(computed["ablations"])]


EXPERIMENT = Experiment("ablations", cells, train_and_test, SHIPPED_CURVES, section)
