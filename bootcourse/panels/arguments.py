"""What a panel's call may be given: each function returns it, or says in a sentence what to give instead."""

import math
from collections.abc import Sequence

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
    if not isinstance(value, (int, float)) or isinstance(value, bool) or not math.isfinite(value):
        raise BootcourseError(f"{called} = {value!r}: give a finite number.")
    return value


def an_instance(value: object, kind: type, called: str) -> object:
    """An object of a class of the library."""
    if not isinstance(value, kind):
        raise BootcourseError(f"{called} is {_article(value)}: give a {kind.__name__}.")
    return value


def _article(value: object) -> str:
    kind = type(value).__name__
    return f"{'an' if kind[0] in 'aeiouAEIOU' else 'a'} {kind}"
