"""How many points each exercise gives: its difficulty (1, 2 or 3), or what a TOML file says.

default = 2            # optional; without it, the difficulty
[exercises]
soft_constraint = 5
"""

import re
from collections import Counter
from collections.abc import Sequence
from pathlib import Path
from typing import Annotated

import msgspec
from msgspec import Meta, Struct

from bootcourse.course.classroom.submission import Submission
from bootcourse.course.lessons import LESSONS, number, registry
from bootcourse.errors import BootcourseError, check_known
from bootcourse.files import decoding, read_bytes

Worth = Annotated[float, Meta(ge=0, le=1e6)]


class Points(Struct, forbid_unknown_fields=True):
    """The content of the file."""

    default: Worth | None = None
    exercises: dict[str, Worth] = {}


def read_points(path: Path | None, lessons: set[int] | None = None) -> dict[str, float]:
    """Exercise -> points, of these lessons (None: of all). Raises BootcourseError for a wrong file."""
    points = Points()
    if path is not None:
        with decoding(path, "give numbers of points, as the course's page about classes says"):
            points = msgspec.toml.decode(read_bytes(path), type=Points)
        for name in points.exercises:
            check_known(f"{path}: the exercise", name, registry())
    return {
        name: points.exercises.get(name, exercise.difficulty if points.default is None else points.default)
        for name, exercise in registry().items()
        if lessons is None or int(exercise.lesson[:2]) in lessons
    }


def handed_out(submissions: Sequence[Submission]) -> set[int] | None:
    """The lessons that most submissions were given, as numbers; None if they do not say."""
    given = Counter(frozenset(one.lessons) & set(LESSONS) for one in submissions)
    return next(({number(lesson) for lesson in lessons} for lessons, _ in given.most_common() if lessons), None)


def read_lessons(text: str) -> set[int] | None:
    """ "2-7" or "1,5,7" as numbers; "" is None, all lessons. Raises BootcourseError for what is no lesson."""
    if not text:
        return None
    parts = [re.fullmatch(r"(\d{1,4})(?:-(\d{1,4}))?", part.strip()) for part in text.split(",")]
    numbers = {n for part in parts if part for n in range(int(part[1]), int(part[2] or part[1]) + 1)}
    if not numbers or not all(parts):
        raise BootcourseError(f"--lessons {text}: give numbers of lessons, such as 2-7 or 1,5,7.")
    last = max(int(exercise.lesson[:2]) for exercise in registry().values())
    if max(numbers) > last:
        raise BootcourseError(f"--lessons {text}: there is no lesson {max(numbers)}, the last is {last}.")
    return numbers
