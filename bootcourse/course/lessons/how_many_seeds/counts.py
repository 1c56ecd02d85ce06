"""Computed for the lesson's tables: our agents beside the paper's rates, their means, two groups."""

from collections.abc import Sequence

import numpy as np

from bootcourse.methods import display_name
from bootcourse.research.experiment import Computed
from bootcourse.research.paper import EPISODES, PRINTED
from bootcourse.research.results import Results
from bootcourse.research.tables import improvement_rows, k_of_n
from bootcourse.statistics import ESCAPES, bracketed, difference, interval, iqm, rate

BESIDE_THE_PAPER = ["", "agents that escape (95 %)", f"the paper's success, {EPISODES} drives",
                    "if one agent drove them all"]  # fmt: skip
MEANS = ["mean of the return", "3 seeds", "10 seeds", "ten others (not only seeds)"]
ABLATION = ["success, %", "IQM", "the agents, sorted"]


def beside_the_paper(study: Results, methods: Sequence[str]) -> list[list[str]]:
    """A row for each method, below `BESIDE_THE_PAPER`: our agents, the paper's rate, and what it says of one agent."""
    rows = []
    for method in methods:
        printed = PRINTED[method]["success"].mean
        one = np.array([printed >= 100 * ESCAPES])  # does the one agent escape?
        _, low, high = rate(one)
        theirs = f"{one.sum()} of 1 ({100 * low:.0f} to {100 * high:.0f} %)"
        ours = k_of_n(study.of(method).scores("success") >= ESCAPES)
        rows.append([display_name(method), ours, f"{printed:g} %", theirs])
    return rows


def means(study: Results, others: Computed, methods: Sequence[str]) -> list[list[str]]:
    """A row for each method, below `MEANS`: its mean return, with the interval, from ever more and from other seeds."""
    rows = []
    for method in methods:
        earned = study.of(method).scores("returns")
        groups = (earned[:3], earned, others[method].scores("returns"))
        some = [interval(group, np.mean) for group in groups]
        rows.append([display_name(method), *(f"{each.value:.0f} [{each.low:.0f}, {each.high:.0f}]" for each in some)])
    return rows


def improvements(study: Results, methods: Sequence[str]) -> tuple[list, list]:
    """How often a bootstrapped agent earns more than one of each other of these methods: (headings, rows)."""
    return improvement_rows(study.pick(i for i, a in enumerate(study.agents) if a["method"] in methods))


def ablation(success: dict[str, np.ndarray]) -> tuple[list[list[str]], str]:
    """The rows below `ABLATION` of two groups of agents (success 0 to 1), and their difference as a sentence."""
    groups = {name: 100 * np.sort(group) for name, group in success.items()}
    rows = [[name, f"{iqm(each):.0f}", ", ".join(f"{one:.0f}" for one in each)] for name, each in groups.items()]
    unchanged, changed = groups.values()
    effect = difference(changed, unchanged)
    holds = "holds 0" if effect.low <= 0 <= effect.high else "does not hold 0"
    return rows, f"Changed less unchanged: {bracketed(effect)} points. The interval {holds}."
