"""Checks of what a panel is given. Each raises BootcourseError with a sentence that says what to give instead."""

import sys
from collections.abc import Callable, Sequence

from bootcourse.episodes.rollout import Rollout
from bootcourse.errors import BootcourseError


def one_drive(drive: Rollout, called: str) -> Rollout:
    """A single recorded drive; `called`: the argument's name."""
    if isinstance(drive, Rollout):
        return drive
    if isinstance(drive, Sequence) and not isinstance(drive, (str, bytes)):
        count = f"{len(drive)} drives" if len(drive) else "an empty list"
        raise BootcourseError(f"{called} is {count}: give one drive, such as record(driver, [0])[0].")
    raise BootcourseError(f"{called} is {_article(drive)}: give a recorded drive, such as record(driver, [0])[0].")


def a_number(value: float, called: str) -> float:
    """A finite number."""
    if not isinstance(value, (int, float)) or isinstance(value, bool) or not abs(value) <= sys.float_info.max:
        raise BootcourseError(f"{called} = {value!r}: give a finite number.")
    return value


def whole_number(called: str, low: int, high: int) -> Callable[[float], None]:
    """A check of a number: is it a whole number from low to high?"""

    def check(value: float) -> None:
        if not low <= value <= high or value != int(value):
            raise BootcourseError(f"{called} = {value:g}: give a whole number from {low} to {high}.")

    return check


LAST_ROAD = 2**32 - 1  # the training roads have higher seeds
check_road = whole_number("road", 0, LAST_ROAD)


def an_instance(value: object, kind: type, called: str) -> object:
    """An object of the class `kind`."""
    if not isinstance(value, kind):
        raise BootcourseError(f"{called} is {_article(value)}: give a {kind.__name__}.")
    return value


def _article(value: object) -> str:
    kind = type(value).__name__
    return f"{'an' if kind[0] in 'aeiouAEIOU' else 'a'} {kind}"
