"""What the numbers and claims in this lesson's text are computed from, beside tools/course/known.py."""

from functools import cache

import numpy as np

from bootcourse.course.lessons.bug_hunt import bugs, tables
from tools.course.known import Episodes, held_out_seeds, record

hunt = cache(bugs.Hunt)  # the agents of the bug hunt


def early(name: str, what: str = "alike") -> float:
    """How often an agent does as the rule now ("alike") or a second later ("late"), after 500 to 1,250 updates."""
    return hunt().probe(name, what)[:, tables.EARLY].mean()


@cache
def as_the_rule(name: str) -> float:
    """In which share of its decisions on 100 roads an agent does what the rule does."""
    drives = record(hunt().agent(name).as_policy(), held_out_seeds(12, 100))
    alike = [np.asarray(drive.actions) == np.asarray(drive.rule_actions) for drive in drives]
    return float(np.concatenate(alike).mean())


@cache
def driven(name: str, drawn: bool = False) -> Episodes:
    """Round 1's 200 drives of an agent, by its most probable actions or by drawn ones."""
    return tables.drives(hunt(), name, drawn)
