"""What the numbers and claims in this lesson's text are computed from, beside tools/course/known.py."""

from functools import cache

import numpy as np

from bootcourse.course.lessons.bug_hunt import bugs
from tools.course.known import drive_episodes, held_out_seeds

hunt = cache(bugs.Hunt)  # the agents of the bug hunt


def early(name: str, what: str = "alike") -> float:
    """How often an agent does as the rule now ("alike") or a second later ("late"), after 500 to 1,250 updates."""
    return hunt().probe(name, what)[:, 2:6].mean()


def drawn_success(name: str) -> float:
    """The share of Round 4's 200 drives with drawn actions in which an agent ends ahead of trap 1."""
    policy = hunt().agent(name).as_policy(np.random.default_rng(0))
    return drive_episodes(policy, held_out_seeds(12, 200)).success.mean()
