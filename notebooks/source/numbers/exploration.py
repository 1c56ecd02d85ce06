"""What the numbers and claims in this lesson's text are computed from, beside tools/course/known.py."""

import numpy as np
from tools.course.known import of


def undecided(method: str, first: int, last: int | None) -> float:
    """The mean effective number of actions of a method's agents in some of their training episodes."""
    return float(np.exp(of(method).curves["entropy"][:, first:last].mean()))


def ended_ahead(method: str, agents: int = 5) -> np.ndarray:
    """How many training episodes the agents that ship with their networks ended ahead of trap 1, (agents,)."""
    return of(method).curves["success"][:agents].sum(axis=1)
