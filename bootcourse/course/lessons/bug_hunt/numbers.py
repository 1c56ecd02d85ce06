"""What the numbers and claims in this lesson's text are computed from, beside tools/course/known.py."""

from functools import cache

import numpy as np

from bootcourse.course.lessons.bug_hunt import bugs
from tools.course.known import EGO, SPEED, drive_episodes, held_out_seeds, record

hunt = cache(bugs.Hunt)  # the agents of the bug hunt


def early(name: str, what: str = "alike") -> float:
    """How often an agent does as the rule now ("alike") or a second later ("late"), after 500 to 1,250 updates."""
    return hunt().probe(name, what)[:, 2:6].mean()


@cache
def as_the_rule(name: str) -> tuple[float, float]:
    """In which share of its decisions on 100 roads an agent does what the rule does, and its mean speed in m/s."""
    drives = record(hunt().agent(name).as_policy(), held_out_seeds(12, 100))
    alike = np.concatenate([np.asarray(drive.actions) == np.asarray(drive.rule_actions) for drive in drives])
    speeds = np.concatenate([drive.states[:, EGO, SPEED] for drive in drives])
    return float(alike.mean()), float(speeds.mean())


def drawn_success(name: str) -> float:
    """The share of Round 4's 200 drives with drawn actions in which an agent ends ahead of trap 1."""
    policy = hunt().agent(name).as_policy(np.random.default_rng(0))
    return drive_episodes(policy, held_out_seeds(12, 200)).success.mean()
