"""Measured for the lesson: what a critic thinks of demonstrated actions, who finds the way out, and who escapes."""

from collections.abc import Sequence
from typing import NamedTuple

import numpy as np

from bootcourse.research.experiment import Computed
from bootcourse.research.results import Results
from bootcourse.statistics import found_after


class Opinion(NamedTuple):
    """What a critic thinks of the demonstrated action, a mean over some states."""

    q: float
    lead: float  # over the mean of the other actions' Q
    over_best: float  # over the largest of the other actions' Q; negative where another comes first
    first: float  # % of the states in which it has the largest Q


def opinion(q: np.ndarray, did: np.ndarray) -> Opinion:
    """Of the Q of each action, (states, actions), and the number of the demonstrated one, (states,)."""
    shown = np.arange(q.shape[1]) == np.asarray(did)[:, None]
    own, others = q[shown], q[~shown].reshape(len(q), -1)
    each = own, own - others.mean(axis=1), own - others.max(axis=1), 100 * (q.argmax(axis=1) == did)
    return Opinion(*(float(np.mean(values)) for values in each))


Kinds = dict[str, tuple[list[Results], list[Results]]]


def kinds(study: Results, changed: Computed, others: Computed) -> Kinds:
    """{demonstrations: (agents with the soft constraint, without it)}: the study's ten first, then the ten others."""
    free = changed["c = 0"]
    return {
        "demonstrations, c = 2": (
            [study.of("bootstrapped"), others["bootstrapped"]],
            [study.of("demos"), others["demos"]],
        ),
        "demonstrations, c = 0": ([free.of("bootstrapped"), others["bootstrapped, c = 0"]], [free.of("demos")]),
        "demonstrations, margin": ([study.of("margin_soft")], [study.of("margin")]),
        "no demonstrations": ([study.of("soft"), others["soft"]], [study.of("sac"), others["sac"]]),
    }


def escape(agents: Sequence[Results]) -> list[int]:
    """How many of each ten agents escape."""
    return [each.escapers(each.methods[0]) for each in agents]


HEADINGS = ["", "found after so many episodes of its own", "escape", "escape without the soft constraint"]


def found_and_escaped(agents: Kinds) -> list[list[str]]:
    """A row for each kind of demonstrations, below `HEADINGS`: "7 · 9" is the study's ten agents and the ten others."""
    rows = []
    for name, (soft, free) in agents.items():
        after = [found_after(each.curves["success"]) for each in soft]
        cells = [f"{episodes.min()} to {episodes.max()}" for episodes in after], escape(soft), escape(free)
        rows.append([name, *(" · ".join(map(str, cell)) for cell in cells)])
    return rows
