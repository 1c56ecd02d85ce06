"""Measured for the lesson: who finds the way out, and who escapes."""

from collections.abc import Sequence

import numpy as np

from bootcourse.research.experiment import Computed
from bootcourse.research.results import Results
from bootcourse.statistics import found_after

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
        "no demonstrations": ([study.of("soft"), others["soft"]], [study.of("sac"), others["sac"]]),
    }


def escape(agents: Sequence[Results]) -> str:
    """How many of these agents escape, "16 of 20"."""
    return f"{sum(each.escapers(each.methods[0]) for each in agents)} of {sum(map(len, agents))}"


def found(agents: Sequence[Results]) -> np.ndarray:
    """The training episodes after which these agents have found the way out, (agents,)."""
    return np.concatenate([found_after(each.curves["success"]) for each in agents])


FOUND = ["with the soft constraint", "find the way out after (median)", "escape at the end"]


def found_and_escaped(agents: Kinds) -> list[list[str]]:
    """A row for each kind of demonstrations, below `FOUND`."""
    return [[name, f"{np.median(found(soft)):.0f} episodes", escape(soft)] for name, (soft, _) in agents.items()]
