"""What the paper leaves open, and three of its choices: the paper's ablation with each of them changed."""

from dataclasses import replace
from pathlib import Path

from bootcourse.research import tables
from bootcourse.research.cells import SHIPPED_CURVES, TESTS, train_and_test, trained
from bootcourse.research.experiment import Computed, Experiment
from bootcourse.scenario import DEFAULT, Scenario


def traps(speed: float) -> Scenario:
    """Faster traps, m/s."""
    return replace(DEFAULT, name=f"traps-{speed}", traps=replace(DEFAULT.traps, speed=speed))


def traffic(name: str, **changes) -> Scenario:
    """The traffic, changed."""
    return replace(DEFAULT, name=name, traffic=replace(DEFAULT.traffic, **changes))


CHANGED = {
    "as it is": {},
    "traps at 10.3 m/s": {"scenario": traps(10.3)},
    "traps at 10.6 m/s": {"scenario": traps(10.6)},
    "traps at 11 m/s": {"scenario": traps(11.0)},
    "no traffic": {"scenario": traffic("no-traffic", cars=0)},
    "3 cars": {"scenario": traffic("3-cars", cars=3)},
    "12 cars": {"scenario": traffic("12-cars", cars=12)},
    "6 cars, twice as close": {"scenario": traffic("close", lead=20.0, headway=20.0)},
    "network 32 x 32": {"hidden": (32, 32)},
    "network 128 x 128": {"hidden": (128, 128)},
    "1 update for each decision": {"updates": 4},
    "demonstrations driven by π̃": {"stochastic_demonstrations": True},
    "target entropy 0.3": {"target_entropy": 0.3},
    "target entropy 1": {"target_entropy": 1.0},
    "γ = 0.9": {"gamma": 0.9},
    "γ = 0.95": {"gamma": 0.95},
    "γ = 0.99": {"gamma": 0.99},
    "γ = 0.9, target entropy 0.3": {"gamma": 0.9, "target_entropy": 0.3},
}


def cells(seeds: int = 3, episodes: int = 1500, tests: int = TESTS) -> dict[str, dict]:
    """The four methods of the ablation, with one thing changed."""
    return {name: trained(seeds, episodes, tests, **changes) for name, changes in CHANGED.items()}


def section(computed: dict[str, Computed], folder: Path) -> list[str]:
    """A table for each of three measures."""
    varied = computed["sensitivity"]
    seeds = len(next(iter(varied.values())).of("sac"))
    text = ["## Sensitivity\n", f"{seeds} seeds each: mean (lowest to highest seed). Too few for intervals.\n"]
    return text + [tables.sensitivity_table(varied, measure) for measure in ("success", "returns", "collision")]


EXPERIMENT = Experiment("sensitivity", cells, train_and_test, SHIPPED_CURVES, section)
