"""Counted for the lesson's table: who finds the way out, who loses it at least once, and who has it at the end."""

from bootcourse.research.experiment import Computed
from bootcourse.research.results import Results
from bootcourse.statistics import lost

KINDS = {  # of agents: the method, the change among the ablations ("": none), the same in experiments/stress.py
    "both aids, β ends at 1,000": ("bootstrapped", "", "bootstrapped"),
    "both aids, β never ends": ("bootstrapped", "β for ever", "bootstrapped, β for ever"),
    "the same without the bonus, β ends": ("bootstrapped", "c = 0", "bootstrapped, c = 0"),
    "the same without the bonus, β never ends": ("bootstrapped", "β for ever, c = 0", ""),
    "soft constraint alone, ξ fades from 2": ("soft", "", "soft"),
    "soft constraint alone, ξ falls to 0.1": ("soft", "ξ falls to 0.1", "soft, ξ falls to 0.1"),
    "soft constraint alone, ξ held at 0.1": ("soft", "ξ stays at 0.1", "soft, ξ stays at 0.1"),
}
HEADINGS = ["ten of the study · ten others", "found it", "lost it at least once", "have it at the end", "mean return"]


def groups(kind: str, study: Results, changed: Computed, others: Computed) -> list[Results]:
    """The agents of one of `KINDS`: the study's, and the ten others where they were trained."""
    method, change, other = KINDS[kind]
    return [(changed[change] if change else study).of(method), *([others[other]] if other else [])]


def fates(study: Results, changed: Computed, others: Computed) -> list[list[str]]:
    """A row for each of `KINDS`, below `HEADINGS`: "10 · 9" is the study's ten agents and the ten others."""
    rows = []
    for kind, (method, *_) in KINDS.items():
        columns = []
        for agents in groups(kind, study, changed, others):
            found, kept = agents.found_and_kept(method)
            each = found.sum(), lost(agents.curves["success"]).sum(), kept.sum()
            columns.append([*map(str, each), f"{agents.scores('returns').mean():.0f}"])
        rows.append([kind, *(" · ".join(each) for each in zip(*columns, strict=True))])
    return rows
