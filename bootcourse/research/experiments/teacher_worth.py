"""What is a teacher worth? Each teacher, from bad to perfect, with each method that it taught, as numbers.

    bootcourse study teachers --out DIR

`by_teacher` holds the agents, `QUANTITIES` what can be said of them, each agent's number and their estimate.
"""

from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path

import numpy as np

from bootcourse.methods import display_name
from bootcourse.research.beyond import SHARE, WINDOW, spent
from bootcourse.research.cells import train_and_test, trained
from bootcourse.research.experiment import Computed, Experiment
from bootcourse.research.results import Results
from bootcourse.research.tables import bracketed, k_of_n, markdown
from bootcourse.research.teachers import PLANNER, TEACHERS
from bootcourse.statistics import ESCAPES, Estimate, escapes, interval, median

# Of each method in the experiment `teachers`: changes and training episodes. The minutes of one core are those of ten
# agents side by side, by the speed of their first 20 s. The planner takes 12.5 ms for a decision. Demonstrations by it
# add 6 minutes (2 where it takes the part of μ in π̃, whose drives end early), its labels of DAgger's 80 episodes 25.
# Labels for the 1,500 episodes of a method with a KL would take eight hours, so those two cells are left out. The rule
# with rollouts takes 0.2 ms for a decision.
TAUGHT = {
    "dagger": ({"updates": 6}, 80),  # 1 minute
    "ppo_cloned": ({}, 6000),  # 3 minutes
    "bootstrapped": ({}, 1500),  # 7 minutes
    "soft": ({}, 1500),  # 8 minutes
    "rlpd": ({}, 150),  # 15 minutes
}


def cells(seeds: int = 10, episodes: int = 0, tests: int = 200) -> dict[str, dict]:
    """Five ways to use a teacher, with teachers from bad to perfect, a cell each. episodes: 0 for those of `TAUGHT`."""
    return {
        f"{teacher}, {method}": trained(seeds, episodes or own, tests, (method,), teacher=teacher, **changes)
        for method, (changes, own) in TAUGHT.items()
        for teacher in TEACHERS
        if teacher != PLANNER or method not in ("bootstrapped", "soft")
    }


Cells = dict[tuple[str, str], Results]  # {(teacher, method): its agents}


def by_teacher(varied: Computed) -> Cells:
    """The cells that were computed, by (teacher, method), in the orders of `TEACHERS` and `TAUGHT`."""
    of = {(agents.agents[0]["teacher"], agents.agents[0]["method"]): agents for agents in varied.values()}
    return {(t, m): of[t, m] for t in TEACHERS for m in TAUGHT if (t, m) in of}


@dataclass(frozen=True)
class Quantity:
    """A number of each agent, and the estimate of it for a cell, both in the label's unit."""

    label: str
    of_agents: Callable[[Results], np.ndarray]  # -> (agents,)
    estimate: Callable[[np.ndarray], Estimate]  # (agents,) -> with its 95 % interval over seeds
    logarithmic: bool = False  # scale of figures


QUANTITIES = {
    "escape": Quantity(
        "agents that escape (%)",
        lambda results: 100 * results.scores("success"),
        lambda success: Estimate(*(100 * part for part in escapes(success / 100))),
    ),
    "return": Quantity("return", lambda results: results.scores("returns"), interval),
    "accidents": Quantity(
        "accidents (% of drives)",
        lambda results: 100 * results.scores("accident"),
        lambda rates: interval(rates, np.mean),
    ),
    "decisions": Quantity(
        f"thousand decisions until {100 * SHARE:g} % of the last {WINDOW} roads in training escape",
        lambda results: spent(results) / 1000,
        median,
        logarithmic=True,
    ),
}


def value_and_interval(estimate: Estimate) -> tuple[str, str]:
    """("80", "[44, 97]"): a cell's value and interval; "not reached" where it is infinite, "" where there is none."""
    if np.isinf(estimate.value):
        return "not reached", "" if np.isnan(estimate.low) or np.isinf(estimate.low) else f"[{estimate.low:.0f}, –]"
    if np.isinf(estimate.high):
        return f"{estimate.value:.0f}", f"[{estimate.low:.0f}, –]"
    value, _, low_high = bracketed(estimate).partition(" ")
    return value, low_high


def counted(results: Results) -> str:
    """ "7 of 10": how many agents escaped on 95 % of the last roads at some time of their training."""
    return f"{int(np.isfinite(spent(results)).sum())} of {len(results)}"


def worth_rows(computed: Cells) -> tuple[list[str], list[list[str]]]:
    """(headings, rows): each cell's numbers, with 95 % intervals over seeds."""
    rows = []
    for (teacher, method), results in computed.items():
        of = {name: quantity.estimate(quantity.of_agents(results)) for name, quantity in QUANTITIES.items()}
        until = " ".join(value_and_interval(of["decisions"])).strip()
        numbers = [bracketed(of["return"]), bracketed(of["accidents"]), f"{until} ({counted(results)})"]
        escaping = k_of_n(results.scores("success") >= ESCAPES)
        rows.append([TEACHERS[teacher].words, display_name(method), escaping, *numbers])
    labels = [QUANTITIES[name].label for name in ("return", "accidents", "decisions")]
    return ["teacher", "method", "agents that escape", *labels], rows


def section(computed: dict[str, Computed], folder: Path) -> list[str]:
    """Each cell's numbers."""
    return ["## What a teacher is worth\n", ABOUT, markdown(*worth_rows(by_teacher(computed["teachers"])))]


ABOUT = """Teachers from bad to perfect, and methods that learn from them. Return: interquartile mean over agents,
accidents: mean, decisions: median, each with its 95 % interval over training seeds. In brackets behind the decisions:
how many agents reached it in their training.
"""

EXPERIMENT = Experiment("teachers", cells, train_and_test, ("success", "decisions"), section)
