"""Fields of frozen dataclasses with their limits beside their defaults, and one check for all of them.

lanes: int = limited(3, low=2, high=8)
"""

import math
import sys
from dataclasses import field, fields
from typing import get_args

from bootcourse.errors import BootcourseError

Range = tuple[float, float]  # (low, high)
NO_LIMITS = (-math.inf, math.inf, -math.inf)


def limited(default, low: float = -math.inf, high: float = math.inf, above: float = -math.inf, shared: bool = False):
    """A field in low..high and greater than `above`; of a `Range`, both numbers.

    shared: agents that train side by side must have the same value.
    """
    return field(default=default, metadata={"limits": (low, high, above), "shared": shared})


def check_limits(record, prefix: str = "") -> None:
    """Raise BootcourseError for the first field of a dataclass whose value does not fit its type or its limits.

    int and float: a finite number; bool: True or False; `X | None`: None is allowed; other types are not checked.
    """
    for f in fields(record):
        value, kinds = getattr(record, f.name), get_args(f.type) or (f.type,)
        named = f"{prefix}{f.name} = {value!r}"
        if f.type is bool and not isinstance(value, bool):
            raise BootcourseError(f"{named}: give True or False.")
        if not {int, float} & {*kinds} or (value is None and type(None) in kinds):
            continue
        if f.type == Range and not (isinstance(value, tuple) and len(value) == 2):
            raise BootcourseError(f"{named}: give (low, high), low first.")
        limits = f.metadata.get("limits", NO_LIMITS)
        for number in value if f.type == Range else (value,):
            if not _fits(number, int if int in kinds else (int, float), *limits):
                raise BootcourseError(
                    f"{named}: give a {'whole' if int in kinds else 'finite'} number{in_words(*limits)}."
                )
        if f.type == Range and value[0] > value[1]:
            raise BootcourseError(f"{named}: give (low, high), low first.")


def _fits(number, kind, low: float, high: float, above: float) -> bool:
    is_number = isinstance(number, kind) and not isinstance(number, bool) and abs(number) <= sys.float_info.max
    return is_number and low <= number <= high and number > above


def in_words(low: float, high: float, above: float) -> str:
    """What limits ask for, behind "a number": " of 0 or more, at most 1"."""
    least = [f" of {low:g} or more"] * (low > -math.inf) + [f" above {above:g}"] * (above > -math.inf)
    return ",".join(least + [f" at most {high:,.12g}"] * (high < math.inf))
