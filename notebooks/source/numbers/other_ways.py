"""What the numbers and claims in this lesson's text are computed from, beside tools/course/known.py."""

from functools import cache

import numpy as np
from bootcourse.episodes.evaluate import drive_episodes, held_out_seeds
from bootcourse.episodes.record import record
from bootcourse.episodes.words import overtaken
from bootcourse.learn.teachers import teacher_policy
from bootcourse.policies import rule_policy
from bootcourse.research import beyond
from bootcourse.research.results import Results
from bootcourse.research.teachers import TEACHERS
from bootcourse.scenario import DEFAULT
from tools.course.known import shipped_experiment, shipped_results, shipped_teachers

LATER = ("ppo", "ppo_cloned", "rlpd", "ibrl", "jsrl")  # methods that the paper does not train


def later(method: str) -> Results:
    """The ten agents of a method that the paper does not train."""
    return shipped_experiment("beyond")[method]


def longer() -> Results:
    """The ten agents of the paper's method with a longer view, a smaller bonus and larger batches."""
    return shipped_experiment("longer-view")["γ = 0.95"]


def first_episodes(method: str, episodes: int = 50) -> float:
    """How many decisions these agents' first episodes take altogether, the mean over agents."""
    return float(later(method).curves["decisions"][:, :episodes].sum(axis=1, dtype=float).mean())


def learned(method: str) -> np.ndarray:
    """The decisions until each agent gets out in 95 % of 50 episodes, inf if it does not, see `study.beyond`."""
    return beyond.spent(later(method))


def taught(teacher: str, method: str = "ppo_cloned") -> Results:
    """The ten agents of a method that a teacher of the experiment `teachers` taught."""
    return shipped_teachers()[teacher, method]


def taught_cost(teacher: str) -> np.ndarray:
    """`learned` of the PPO agents that began as clones of a teacher."""
    return beyond.spent(taught(teacher))


@cache
def teacher_drives(teacher: str):
    """Such a teacher's own drives on 200 of the study's held-out roads."""
    return drive_episodes(teacher_policy(TEACHERS[teacher].rule), held_out_seeds(1, 200))


def teachers_success(teacher: str) -> float:
    """The share of them that end ahead."""
    return float(teacher_drives(teacher).success.mean())


def teachers_accidents(teacher: str) -> float:
    """The share of them that end in an accident."""
    return float((teacher_drives(teacher).accident > 0).mean())


@cache
def rules_overtaking() -> np.ndarray:
    """When the rule is ahead of trap 1, in seconds on each of 100 held-out roads; inf where it is not."""
    drives = record(rule_policy(DEFAULT), held_out_seeds(1, 100))
    return np.array([overtaken(drive) or np.inf for drive in drives])


def accident_percent(results: Results) -> float:
    """The share of all held-out episodes of these agents that end in an accident, in %."""
    return 100 * float(results.episodes("accident").mean())


def driven(method: str) -> float:
    """The decisions of such an agent's whole training, the mean over agents."""
    return float(np.nansum(later(method).curves["decisions"], axis=1, dtype=float).mean())


def papers_cost() -> np.ndarray:
    """`learned` of the bootstrapped agents with the paper's setting."""
    return beyond.spent(shipped_results("paper").of("bootstrapped"))


def decisions_of(teacher: str, method: str) -> float:
    """The decisions of the whole training of an agent that a teacher taught, the mean over agents."""
    return float(np.nansum(beyond.lengths(taught(teacher, method).curves), axis=1, dtype=float).mean())
