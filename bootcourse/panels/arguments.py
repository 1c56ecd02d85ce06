"""Checks of what a panel is given. Each raises BootcourseError with a sentence that says what to give instead."""

import sys
from collections.abc import Callable, Sequence

from bootcourse.episodes.rollout import Rollout
from bootcourse.errors import BootcourseError


def one_drive(drive: Rollout, name: str) -> Rollout:
    """A single recorded drive; name: of the argument."""
    if isinstance(drive, Rollout):
        return drive
    given = f"a {type(drive).__name__}"
    if isinstance(drive, Sequence) and not isinstance(drive, (str, bytes)):
        given = f"a list of {len(drive)}"
    raise BootcourseError(f"{name} is {given}: give one recorded drive, such as record(driver, [0])[0].")


def a_number(value: float, name: str) -> float:
    """A finite number."""
    if not isinstance(value, (int, float)) or isinstance(value, bool) or not abs(value) <= sys.float_info.max:
        raise BootcourseError(f"{name} = {value!r}: give a finite number.")
    return value


def whole_number(name: str, low: int, high: int) -> Callable[[float], None]:
    """A check of a number: is it a whole number from low to high?"""

    def check(value: float) -> None:
        if not low <= value <= high or value != int(value):
            raise BootcourseError(f"{name} = {value:g}: give a whole number from {low} to {high}.")

    return check


LAST_ROAD = 2**32 - 1  # the training roads have higher seeds
check_road = whole_number("road", 0, LAST_ROAD)
