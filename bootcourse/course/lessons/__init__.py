"""The lessons in their order, and their exercises: the folder NAME holds all that belongs to the lesson NAME.

A lesson's number is its place in `LESSONS` and stands nowhere else: to move a lesson, move its name. File names,
headings, exercises, predictions, links and tables follow (`make notebooks`, `make book`).
"""

import ast
import functools
import importlib
import re
from collections.abc import Iterator, Mapping
from dataclasses import replace
from pathlib import Path
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from bootcourse.course.exercise import Exercise

COURSE = (
    "start",
    "the_trap",
    "values",
    "discrete_sac",
    "update_and_loop",
    "the_barrier",
    "the_rule",
    "demonstrations",
    "soft_constraint",
    "learning_from_demonstrations",
    "how_many_seeds",
    "found_and_kept",
)
ELECTIVES = (
    "recorded_drives",
    "bug_hunt",
    "your_teacher",
    "the_second_trap",
    "looking_ahead",
    "other_ways",
    "your_own_problem",
)
LESSONS = COURSE + ELECTIVES


def number(lesson: str) -> int:
    """A lesson's number. Raises ValueError for no lesson."""
    return LESSONS.index(lesson)


def stem(lesson: str) -> str:
    """The name of a lesson's files, such as "07_soft_constraint". Raises ValueError for no lesson."""
    return f"{number(lesson):02d}_{lesson}"


class Registry(Mapping):
    """name -> exercise, in the order of the lessons and of the files' lines: every `Exercise` of NAME/exercises.py.

    An exercise is looked up in the files that have its name in them. Only to count or list them all are all files
    loaded, which takes seconds.
    """

    def __getitem__(self, name: str) -> "Exercise":
        for lesson in LESSONS:
            if name in words_of(lesson) and name in exercises_of(lesson):
                return exercises_of(lesson)[name]
        raise KeyError(name)

    def __iter__(self) -> Iterator[str]:
        return iter(_all())

    def __len__(self) -> int:
        return len(_all())


@functools.cache
def registry() -> Registry:
    """Every exercise by its name."""
    return Registry()


def _file(lesson: str) -> Path:
    return Path(__file__).parent / lesson / "exercises.py"


@functools.cache
def _text(lesson: str) -> str:
    """The lesson's file of exercises; "" if it has none."""
    return _file(lesson).read_text(encoding="utf-8") if _file(lesson).exists() else ""


@functools.cache
def words_of(lesson: str) -> frozenset[str]:
    """The words of the lesson's file of exercises."""
    return frozenset(re.findall(r"\w+", _text(lesson)))


@functools.cache
def exercises_of(lesson: str) -> "dict[str, Exercise]":
    """The exercises of a lesson."""
    from bootcourse.course.exercise import Exercise  # loads torch, which a lesson's number does not need

    if not _text(lesson):
        return {}
    values = vars(importlib.import_module(f"{__name__}.{lesson}.exercises")).values()
    return {value.name: replace(value, lesson=stem(lesson)) for value in values if isinstance(value, Exercise)}


@functools.cache
def minutes_of(lesson: str) -> dict[str, int]:
    """The minutes of a lesson's exercises, {name: minutes}, as its files say: they are read, and not loaded."""
    minutes = {}
    for file in _file(lesson).parent.glob("*.py"):
        text = file.read_text(encoding="utf-8")
        for node in ast.parse(text).body if "course.exercise import" in text else ():
            name = getattr(node, "name", None) or ast.unparse(getattr(node, "targets", [node])[0])
            for call in ast.walk(node):
                if isinstance(call, ast.Call) and ast.unparse(call.func) == "exercise":
                    minutes[name] = next(each.value.value for each in call.keywords if each.arg == "minutes")
    return minutes


@functools.cache
def _all() -> dict[str, str]:
    """name -> lesson. Raises ValueError if two exercises have one name."""
    lessons: dict[str, str] = {}
    for lesson in LESSONS:
        for name in exercises_of(lesson):
            if name in lessons:
                raise ValueError(f"Two exercises are called {name}: {stem(lessons[name])}, {lesson}")
            lessons[name] = lesson
    return lessons
