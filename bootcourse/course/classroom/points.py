"""How many points each exercise gives: its difficulty (1, 2 or 3), or what a TOML file says.

default = 2            # optional; without it, the difficulty
[exercises]
soft_constraint = 5
"""

import tomllib
from pathlib import Path

from bootcourse.course.lessons import registry
from bootcourse.errors import BootcourseError, did_you_mean
from bootcourse.files import read_bytes


def read_points(path: Path | None, lessons: set[int] | None = None) -> dict[str, float]:
    """Exercise -> points, of these lessons (None: of all). Raises BootcourseError for a wrong file."""
    try:
        told = tomllib.loads(read_bytes(path).decode()) if path else {}
    except ValueError as error:
        raise BootcourseError(f"{path} is no TOML: {error}.") from None
    own, default = told.get("exercises", {}), told.get("default")
    wrong = [key for key in told if key not in ("default", "exercises")] or [k for k in own if k not in registry()]
    if wrong:
        choices = registry() if wrong[0] in own else ("default", "exercises")
        raise BootcourseError(f"{path}: {did_you_mean(wrong[0], choices)}.")
    for name, value in {"default": default or 0, **own}.items():
        if isinstance(value, bool) or not isinstance(value, (int, float)) or not 0 <= value < 1e6:
            raise BootcourseError(f"{path}: {name} = {value!r}: give a number of points, 0 or more.")
    wanted = {n: e for n, e in registry().items() if lessons is None or int(e.lesson[:2]) in lessons}
    return {name: own.get(name, e.difficulty if default is None else default) for name, e in wanted.items()}


def read_lessons(text: str) -> set[int] | None:
    """ "4-8" or "1,5,7" as numbers; "" is None, all lessons. Raises BootcourseError for what is no lesson."""
    if not text:
        return None
    last = max(int(exercise.lesson[:2]) for exercise in registry().values())
    try:
        ends = [part.split("-") for part in text.split(",")]
        found = {number for part in ends for number in range(int(part[0]), int(part[-1]) + 1) if len(part) <= 2}
    except ValueError:
        found = set()
    if not found:
        raise BootcourseError(f"--lessons {text}: give numbers of lessons, such as 4-8 or 1,5,7.")
    if max(found) > last:
        raise BootcourseError(f"--lessons {text}: there is no lesson {max(found)}, the last is {last}.")
    return found
