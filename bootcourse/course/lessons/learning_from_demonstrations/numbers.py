"""What the numbers and claims in this lesson's text are computed from, beside tools/course/known.py."""

from functools import cache

import numpy as np

from bootcourse.research.results import Results
from bootcourse.statistics import found_after
from tools.course.known import of, rule_drives, shipped_experiment, shipped_runs


@cache
def demonstrated_q(method: str) -> np.ndarray:
    """After training, what the shipped agents of a method think of the rule's actions, (agents,).

    The mean over the first 20 seconds of the rule's drives on 20 roads.
    """
    values, did = _way_out(method)
    return np.array([each[np.arange(len(did)), did].mean() for each in values])


def _way_out(method: str) -> tuple[list[np.ndarray], np.ndarray]:
    """What the shipped agents of a method think of each action there, [(states, 9)], and what the rule did."""
    drives = rule_drives()[:20]
    seen = np.concatenate([drive.observations[:20] for drive in drives])
    did = np.concatenate([drive.actions[:20] for drive in drives])
    return [run.agent.q_values(seen) for run in shipped_runs(method)], did


def without_bonus(method: str = "") -> Results:
    """The agents whose demonstrations pay no bonus, c = 0: ten of each of two methods."""
    agents = shipped_experiment("ablations")["c = 0"]
    return agents.of(method) if method else agents


def found_by(method: str) -> np.ndarray:
    """The training episodes after which the study's agents of a method have found the way out, (agents,)."""
    return found_after(of(method).curves["success"])


def in_50(method: str, first: int) -> np.ndarray:
    """The share of successes in 50 training episodes of each of the study's agents of a method, (agents,)."""
    return of(method).curves["success"][:, first : first + 50].mean(axis=1)
