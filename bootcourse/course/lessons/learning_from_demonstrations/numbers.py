"""What the numbers and claims in this lesson's text are computed from, beside tools/course/known.py."""

from functools import cache

import numpy as np

from bootcourse.research.results import Results
from bootcourse.scenario import ACTION_NAMES
from bootcourse.statistics import found_after
from tools.course.known import of, rule_drives, shipped_experiment, shipped_runs


@cache
def demonstrated_q(method: str) -> np.ndarray:
    """After training, what the shipped agents of a method think of the rule's actions, (agents,).

    The mean over the first 20 seconds of the rule's drives on 20 roads.
    """
    values, did = _way_out(method)
    return np.array([each[np.arange(len(did)), did].mean() for each in values])


@cache
def demonstrated_largest(method: str) -> np.ndarray:
    """In which share of these states the rule's action has the largest Q, for the shipped agents, (agents,)."""
    values, did = _way_out(method)
    return np.array([np.mean(each.argmax(1) == did) for each in values])


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


def straight_on_the_way() -> int:
    """In how many of the states of the rule's way out on 20 roads it keeps straight."""
    did = np.concatenate([drive.actions[:20] for drive in rule_drives()[:20]])
    return int((did == ACTION_NAMES.index("keep straight")).sum())


def found_by(method: str) -> np.ndarray:
    """The training episodes after which the study's agents of a method have found the way out, (agents,)."""
    return found_after(of(method).curves["success"])


def in_50(method: str, first: int, measure: str = "success") -> np.ndarray:
    """The mean of a measure over 50 training episodes of each of the study's agents of a method, (agents,)."""
    return of(method).curves[measure][:, first : first + 50].mean(axis=1)
