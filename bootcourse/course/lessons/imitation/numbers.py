"""What the numbers and claims in this lesson's text are computed from, beside tools/course/known.py."""

from functools import cache

import numpy as np
from scipy import stats

from bootcourse.course.lessons.imitation.figures import half_success, updates_made
from bootcourse.course.lessons.imitation.reachable_entropy import REACHABLE, UPDATES, by_entropy  # noqa: F401
from bootcourse.storage.assets import FOLDER
from tools.course.known import of, shipped_experiment


@cache
def checked(row: int, column: str) -> str:
    """What assets/checks.md says in a row of its table, the first is 0: "learner", "task", "published", ..."""
    table = [line.strip("| ").split(" | ") for line in (FOLDER / "checks.md").read_text("utf-8").splitlines()]
    names, _, *rows = [cells for cells in table if len(cells) > 1 or cells[0].startswith("---")]
    return dict(zip(["ours" if name.startswith("ours") else name for name in names], rows[row], strict=True))[column]


def own_decisions(method: str) -> float:
    """How many decisions of its own an agent of a method learned from, the mean over agents."""
    agent, updates = of(method).agents[0], updates_made(of(method))[:, -1].mean()
    return float(updates * agent["envs_per_agent"] / agent["updates"])


def slower(axis: str) -> float:
    """How many times CQL's episodes, or updates, GAIL needs until half of its drives succeed: of the medians."""
    medians = []
    for method in ("gail", "cql"):
        at = half_success(of(method).curves["success"])
        needed = at if axis == "episodes" else np.take_along_axis(updates_made(of(method)), at[:, None] - 1, 1)[:, 0]
        medians.append(np.median(needed[at > 0]))
    return float(medians[0] / medians[1])


def with_entropy(entropy: float):
    """The GAIL agents that were trained with this target entropy (nats), beside others with another."""
    return by_entropy(shipped_experiment("reachable-entropy")["gail"])[entropy]


def accidents_p() -> float:
    """The exact rank-sum p of these agents' accidents: a reachable target entropy against -1."""
    first, second = (with_entropy(each).scores("accident") for each in (-1.0, REACHABLE))
    return float(stats.mannwhitneyu(first, second, method="exact").pvalue)
