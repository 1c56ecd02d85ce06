"""What the numbers and claims in this lesson's text are computed from, beside tools/course/known.py."""

from functools import cache

import numpy as np

from bootcourse.course.lessons.learning_from_demonstrations import measures
from bootcourse.research.results import Results
from bootcourse.scenario import ACTION_NAMES
from bootcourse.statistics import found_after
from tools.course.known import rule_drives, shipped_experiment, shipped_results, shipped_runs


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


@cache
def kinds() -> measures.Kinds:
    """With the soft constraint and without it, by demonstrations: the study's ten agents first, then the ten others."""
    return measures.kinds(shipped_results(), shipped_experiment("ablations"), shipped_experiment("stress"))


def _with(name: str) -> tuple[list[Results], list[Results]]:
    """One of `kinds`, by its last word: "c = 2", "c = 0", "margin" or "none"."""
    return kinds()["no demonstrations" if name == "none" else f"demonstrations, {name}"]


def in_all(name: str) -> str:
    """ "16 of 20": how many agents with the soft constraint and these demonstrations escape."""
    agents = _with(name)[0]
    return f"{sum(measures.escape(agents))} of {sum(map(len, agents))}"


def escape_freely(name: str) -> int:
    """How many agents without the soft constraint escape."""
    return sum(measures.escape(_with(name)[1]))


def found(name: str) -> np.ndarray:
    """The training episodes after which the agents with the soft constraint have found the way out, (agents,)."""
    return np.concatenate([found_after(each.curves["success"]) for each in _with(name)[0]])


def training(name: str, curve: str, first: int, last: int) -> np.ndarray:
    """The mean of the study's ten agents with the soft constraint in some training episodes, (agents,)."""
    return _with(name)[0][0].curves[curve][:, first:last].mean(axis=1)


def actor_only() -> np.ndarray:
    """When the agents with the KL in the actor's loss alone and no demonstrations have found the way out, (agents,)."""
    return found_after(shipped_experiment("ablations")["KL in the actor only"].of("soft").curves["success"])


def straight() -> float:
    """The share of the lesson's states, the first 20 s of 20 of the rule's drives, in which it keeps straight."""
    did = np.concatenate([drive.rule_actions[:20] for drive in rule_drives()[:20]])
    return float(np.mean(did == ACTION_NAMES.index("keep straight")))
