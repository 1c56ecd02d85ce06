"""Computed for the lesson's tables: the means of some seeds and of others, two groups of an ablation."""

from collections.abc import Sequence

import numpy as np

from bootcourse.methods import display_name
from bootcourse.research.experiment import Computed
from bootcourse.research.results import Results
from bootcourse.statistics import bracketed, difference, interval, iqm

MEANS = ["mean of the return", "3 seeds", "10 seeds", "ten others (not only seeds)"]
ABLATION = ["success, %", "IQM", "the agents, sorted"]


def means(study: Results, others: Computed, methods: Sequence[str]) -> list[list[str]]:
    """A row for each method, below `MEANS`: its mean return, with the interval, from ever more and from other seeds."""
    rows = []
    for method in methods:
        earned = study.of(method).scores("returns")
        groups = (earned[:3], earned, others[method].scores("returns"))
        some = [interval(group, np.mean) for group in groups]
        rows.append([display_name(method), *(f"{each.value:.0f} [{each.low:.0f}, {each.high:.0f}]" for each in some)])
    return rows


def ablation(success: dict[str, np.ndarray]) -> tuple[list[list[str]], str]:
    """The rows below `ABLATION` of two groups of agents (success 0 to 1), and their difference as a sentence."""
    groups = {name: 100 * np.sort(group) for name, group in success.items()}
    rows = [[name, f"{iqm(each):.0f}", ", ".join(f"{one:.0f}" for one in each)] for name, each in groups.items()]
    unchanged, changed = groups.values()
    effect = difference(changed, unchanged)
    holds = "holds 0" if effect.low <= 0 <= effect.high else "does not hold 0"
    return rows, f"Changed less unchanged: {bracketed(effect)} points. The interval {holds}."
