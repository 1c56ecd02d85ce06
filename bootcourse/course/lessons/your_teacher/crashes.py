"""What do drives that crash teach? Agents learn from the half-random teacher's, each time without one part.

    bootcourse study crashes --out DIR

Of the 200 drives that this teacher demonstrates, those that end ahead of trap 1 are taken out. Ten agents of each kind
train as long as those of the experiment `teachers`.
"""

from collections.abc import Callable
from functools import cache
from pathlib import Path

import numpy as np
import torch
from torch import Tensor

from bootcourse.course.lessons.your_teacher.taught_agents import demonstrated, teach, tested
from bootcourse.episodes.rollout import Rollout
from bootcourse.learn.demonstrations import demonstration_rows
from bootcourse.learn.settings import settings_for, with_seeds
from bootcourse.learn.training import Training
from bootcourse.research.cells import results_of, tested_results
from bootcourse.research.experiment import Computed, Experiment
from bootcourse.research.experiments.teacher_worth import TAUGHT
from bootcourse.research.jobs import Interrupted, orphaned
from bootcourse.research.results import Results
from bootcourse.research.tables import bracketed, k_of_n, markdown
from bootcourse.research.teachers import teacher_named
from bootcourse.road.state import EGO, LANE
from bootcourse.scenario import DEFAULT
from bootcourse.statistics import ESCAPES, interval

NAME, TEACHER = "crashes", "random-50"
KINDS = {  # cell: what the agents learn from, method and changed settings
    "all": ("drives, bonus and labels", "bootstrapped", {}),
    "no-labels": ("drives and bonus", "demos", {}),
    "no-bonus": ("drives and labels", "bootstrapped", {"bonus": 0.0}),
    "cut": ("the drives until the free lane, bonus and labels", "bootstrapped", {}),
    "as-many": ("the drives without as many decisions before the free lane, bonus and labels", "bootstrapped", {}),
    "lane": ("the drives without the accident in the free lane, bonus and labels", "bootstrapped", {}),
    "accident": ("the drives with the accident, without its free lane, bonus and labels", "bootstrapped", {}),
    "lane-no-bonus": ("the drives without the accident in the free lane, and labels", "bootstrapped", {"bonus": 0.0}),
}


def cells(seeds: int = 10, episodes: int = TAUGHT["bootstrapped"][1], tests: int = 200) -> dict[str, dict]:
    """One for each kind."""
    return {kind: {"kind": kind, "seeds": seeds, "episodes": episodes, "tests": tests} for kind in KINDS}


def from_crashes(kind: str, seeds: int, episodes: int, tests: int) -> Results:
    """Train and test the agents of one kind, with the compiled learner. Raises Interrupted."""
    _, method, changes = KINDS[kind]
    settings, rows = with_seeds(settings_for(method, **changes), seeds), rows_of_crashes(kind)
    training = Training(settings, episodes, DEFAULT, teacher_named(TEACHER), demonstrations=rows, learner="compiled")
    result = training.run(progress=False, stop=orphaned)
    if result.interrupted:
        raise Interrupted(NAME)
    return tested_results(result, tests, TEACHER)


@cache
def crashed() -> list[Rollout]:
    """The teacher's drives that do not end ahead of trap 1."""
    return [drive for drive in demonstrated(TEACHER) if not drive.success]


def rows_of_crashes(kind: str) -> Tensor:
    """What one kind of agents learns from, (transitions, row)."""
    rows = torch.cat([demonstration_rows([drive], teacher_named(TEACHER)) for drive in crashed()])
    return rows[torch.from_numpy(is_kept(kind))]


def is_kept(kind: str) -> np.ndarray:
    """Which of these drives' decisions, one after the other, the kind learns from: (decisions,) bool.

    "cut": those before the free lane; "as-many": without as many of those as the cut takes away, drawn at random;
    "lane", with the bonus or without it, and "accident": the free lane without its accident, and the reverse.
    """
    if kind == "accident":
        return marked(without_the_lane)
    if kind.startswith("lane"):
        return marked(without_the_accident)
    before = marked(before_the_lane)
    if kind == "cut":
        return before
    kept = np.ones(len(before), dtype=bool)
    if kind == "as-many":
        kept[np.random.default_rng(0).choice(np.flatnonzero(before), (~before).sum(), replace=False)] = False
    return kept


def before_free_lane(drive: Rollout) -> int:
    """How many of a drive's decisions are made before the car is in the free lane."""
    return int(before_the_lane(lanes_of(drive)).sum())


def lanes_of(drive: Rollout) -> np.ndarray:
    """The ego's lane at each of a drive's decisions, (decisions,) int."""
    return drive.cars[: len(drive.actions), EGO, LANE].astype(int)


def before_the_lane(lanes: np.ndarray) -> np.ndarray:
    """What comes before lane 0: (decisions,) bool."""
    return np.cumsum(lanes == 0) == 0


def without_the_accident(lanes: np.ndarray) -> np.ndarray:
    """The free lane without its accident: all of a drive but its last decision, if it reaches lane 0."""
    kept = np.ones(len(lanes), dtype=bool)
    if (lanes == 0).any():
        kept[-1] = False
    return kept


def without_the_lane(lanes: np.ndarray) -> np.ndarray:
    """The accident without the free lane: what comes before lane 0, and a drive's last decision."""
    kept = before_the_lane(lanes)
    kept[-1] = True
    return kept


def marked(kept: Callable[[np.ndarray], np.ndarray]) -> np.ndarray:
    """The decisions of these drives, one after the other, that `kept(lanes)` marks in each: (decisions,) bool."""
    return np.concatenate([np.asarray(kept(lanes_of(drive)), dtype=bool) for drive in crashed()])


def short_training(kept: Callable[[np.ndarray], np.ndarray], seeds: int = 2) -> dict[str, np.ndarray]:
    """Agents that learn from what `kept` marks, as long as the other trainings of the lesson, tested: as `tested`."""
    settings, rows = with_seeds(settings_for("bootstrapped"), seeds), rows_of_crashes("all")
    rows = rows[torch.from_numpy(marked(kept))]
    return tested(teach(teacher_named(TEACHER), settings, learner="compiled", demonstrations=rows).agents)


def rows_of(computed: Computed) -> tuple[list[str], list[list[str]]]:
    """(headings, rows): what each kind reached."""
    rows = []
    for kind in [kind for kind in KINDS if kind in computed]:
        agents = computed[kind]
        accidents = interval(100 * agents.scores("accident"), np.mean)
        escaping = k_of_n(agents.scores("success") >= ESCAPES)
        rows.append([KINDS[kind][0], escaping, bracketed(interval(agents.scores("returns"))), bracketed(accidents)])
    return ["agents learn from", "agents that escape", "return", "accidents (% of drives)"], rows


def section(computed: dict[str, Computed], folder: Path) -> list[str]:
    """What each kind reached."""
    return ["### From drives that crash\n", ABOUT, markdown(*rows_of(computed[NAME]))]


ABOUT = """The drives of the half-random teacher, without the few that end ahead of trap 1: each ends in an accident.
Agents learn from all that is in them, or without one part.
"""

EXPERIMENT = Experiment(NAME, cells, results_of(from_crashes), ("success", "decisions"), section)
