"""What the numbers and claims in this lesson's text are computed from, beside tools/course/known.py."""

from functools import cache

import numpy as np
from bootcourse.course.lessons.the_trap import figures


@cache
def right_first() -> np.ndarray:
    """On which of the lesson's 400 roads the plan gets out that begins to the right."""
    turns = ["keep right", ("keep left", 4), ("keep right", 3)]
    return figures.d2_and_success([*turns, ("accelerate straight", 5)])[1]
