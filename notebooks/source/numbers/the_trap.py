"""What the numbers and claims in this lesson's text are computed from, beside tools/course/known.py."""

from functools import cache

import numpy as np
from bootcourse.course.lessons.the_trap import figures

STRAIGHT_BETWEEN = (("keep left", 2), ("keep straight", 2), ("keep right", 2))
RIGHT_FIRST = ("keep right", ("keep left", 4), ("keep right", 3))


@cache
def unhurt(turns: tuple) -> np.ndarray:
    """On which of the lesson's 400 roads a plan gets out unhurt."""
    return figures.d2_and_unhurt([*turns, ("accelerate straight", 5)])[1]
