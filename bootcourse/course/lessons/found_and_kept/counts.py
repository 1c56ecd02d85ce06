"""Counted for the lesson's tables: the paper's rows and ours, who finds, loses and keeps the way out, what it earns."""

import numpy as np

from bootcourse.methods import display_name
from bootcourse.research.cells import VARIED
from bootcourse.research.experiment import Computed
from bootcourse.research.experiments.clocks import DRIVERS, UPDATES
from bootcourse.research.paper import PRINTED
from bootcourse.research.results import Results
from bootcourse.research.tables import escaped
from bootcourse.statistics import Estimate, lost

KINDS = {  # of agents: the method, the change among the ablations ("": none), the same in experiments/stress.py
    "both aids, β ends": ("bootstrapped", "", "bootstrapped"),
    "both aids, β never ends": ("bootstrapped", "β for ever", "bootstrapped, β for ever"),
    "soft constraint alone, ξ fades": ("soft", "", "soft"),
    "soft constraint alone, ξ falls to 0.1 and stays": ("soft", "ξ falls to 0.1", "soft, ξ falls to 0.1"),
    "demonstrations alone, β ends": ("demos", "", "demos"),
    "demonstrations alone, β never ends": ("demos", "β for ever", "demos, β for ever"),
}
HEADINGS = ["twenty agents", "found it", "lost it at least once", "kept it", "their return", "return of all twenty"]
SETTINGS = ["updates", "soft constraint alone", *(f"demonstrations alone, driver {driver}" for driver in DRIVERS)]
BOTH_TABLES = ["", "the paper's success", "the paper's return", "our agents that escape"]


def both_tables(study: Results) -> list[list[str]]:
    """A row for each method of the paper's Table 4, below `BOTH_TABLES`: what the paper prints, and our agents."""
    rows = [(m, PRINTED[m]["success"].mean, PRINTED[m]["returns"].mean) for m in VARIED]
    return [[display_name(m), f"{rate:.0f} %", f"{earned:.0f}", escaped(study, m)] for m, rate, earned in rows]


def percent(chance: Estimate) -> str:
    """ "33 % [10, 54]"."""
    value, low, high = (100 * part for part in chance)
    return f"{value:.0f} % [{low:.0f}, {high:.0f}]"


def groups(kind: str, study: Results, changed: Computed, others: Computed) -> list[Results]:
    """The agents of one of `KINDS`: the study's ten, and the ten others."""
    method, change, other = KINDS[kind]
    return [(changed[change] if change else study).of(method), others[other]]


def fates(study: Results, changed: Computed, others: Computed) -> list[list[str]]:
    """A row for each of `KINDS`, below `HEADINGS`."""
    rows = []
    for kind, (method, *_) in KINDS.items():
        agents = groups(kind, study, changed, others)
        found, kept = np.concatenate([each.found_and_kept(method) for each in agents], axis=1)
        losers = sum(int(lost(each.curves["success"]).sum()) for each in agents)
        earned = np.concatenate([each.scores("returns") for each in agents])
        counted = [f"{found.sum()}", f"{losers}", f"{kept.sum()}"]
        rows.append([kind, *counted, f"{earned[kept].mean():.0f}", f"{earned.mean():.0f}"])
    return rows


def kept_in_each(cells: dict[tuple[str, str], Results]) -> list[list[str]]:
    """A row for each number of updates for a decision, below `SETTINGS`: of how many agents how many kept the way out.

    The agents with the soft constraint alone are the same with each driver: they see no demonstrations.
    """
    rows = []
    for updates in UPDATES:
        alone, *others = (cells[updates, driver] for driver in DRIVERS)
        rows.append([updates.replace("1/4", "¼"), _kept(alone, "soft"), *(_kept(c, "demos") for c in (alone, *others))])
    return rows


def _kept(results: Results, method: str) -> str:
    """ "6 of 10"."""
    return f"{results.found_and_kept(method)[1].sum()} of {len(results.of(method))}"
