"""What the numbers and claims in this lesson's text are computed from, beside tools/course/known.py."""

from functools import cache

import numpy as np
from scipy import stats

from bootcourse.course.lessons.recorded_drives import choosing
from bootcourse.course.lessons.recorded_drives.exercises import conservative_loss  # noqa: F401 (the text names it)
from bootcourse.course.lessons.recorded_drives.figures import half_success, updates_made
from bootcourse.course.lessons.recorded_drives.reachable_entropy import REACHABLE, by_entropy
from bootcourse.course.shipped import shipped_agents
from bootcourse.storage.assets import FOLDER
from tools.course.known import of, shipped_experiment


@cache
def checked(row: int, column: str) -> str:
    """What assets/checks.md says in a row of its table, the first is 0: "learner", "task", "published", ..."""
    table = [line.strip("| ").split(" | ") for line in (FOLDER / "checks.md").read_text("utf-8").splitlines()]
    names, _, *rows = [cells for cells in table if len(cells) > 1 or cells[0].startswith("---")]
    return dict(zip(["ours" if name.startswith("ours") else name for name in names], rows[row], strict=True))[column]


def slower(axis: str) -> float:
    """How many times CQL's episodes, or updates, GAIL needs until half of its drives succeed: of the medians."""
    medians = []
    for method in ("gail", "cql"):
        at = half_success(of(method).curves["success"])
        needed = at if axis == "episodes" else np.take_along_axis(updates_made(of(method)), at[:, None] - 1, 1)[:, 0]
        medians.append(np.median(needed[at > 0]))
    return float(medians[0] / medians[1])


def with_entropy(method: str, entropy: float):
    """The agents of GAIL, or of CQL with an actor, that were trained with this target entropy (nats)."""
    return by_entropy(shipped_experiment("reachable-entropy")[method])[entropy]


def accidents_p() -> float:
    """The exact rank-sum p of these agents' accidents: a reachable target entropy against -1."""
    first, second = (with_entropy("gail", each).scores("accident") for each in (-1.0, REACHABLE))
    return float(stats.mannwhitneyu(first, second, method="exact").pvalue)


@cache
def worth_of(method: str) -> float:
    """What the first agent of a method is worth from the start at γ = 0.8, the mean of 100 roads."""
    return choosing.worth(shipped_agents(method)[0].as_policy(), range(100), 0.8)[0]


@cache
def overlap_of(method: str) -> float:
    """In which share of the recorded seconds it would do what was done."""
    return choosing.overlap(shipped_agents(method)[0].as_policy(), choosing.recorded())
