"""What the numbers and claims in this lesson's text are computed from, beside tools/course/known.py."""

from functools import cache

import numpy as np

from bootcourse.course.lessons.bug_hunt import bugs
from bootcourse.episodes.record import record
from bootcourse.episodes.rollout import Rollout
from bootcourse.policies import stochastic_rule_policy
from bootcourse.scenario import DEFAULT

hunt = cache(bugs.Hunt)  # the agents of the bug hunt


@cache
def agree(bug: str) -> np.ndarray:
    """Where a learner's labels are the rule's action before the step, in the lesson's drive: (decisions,) bool."""
    return bugs.labels(bug, labelled_drive()) == labelled_drive().rule_actions


@cache
def labelled_drive() -> Rollout:
    """The drive whose labels the lesson compares."""
    return record(stochastic_rule_policy(DEFAULT, np.random.default_rng(1)), [10])[0]


def ends(name: str) -> float:
    """An agent's return in its last 30 training episodes, as a share of the healthy one's: the mean of two seeds."""
    returns = hunt().at_the_end("return")
    return returns[name].mean() / returns["healthy"].mean()
