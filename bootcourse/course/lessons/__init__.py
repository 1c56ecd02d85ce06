"""The lessons in their order, and their exercises: the folder NAME holds all that belongs to the lesson NAME.

A lesson's number is its place in `LESSONS` and stands nowhere else: to move a lesson, move its name. File names,
headings, exercises, predictions, links and tables follow (`make notebooks`, `make book`).
"""

import functools
import importlib
from dataclasses import replace
from pathlib import Path
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from bootcourse.course.exercise import Exercise

COURSE = (
    "start",
    "the_trap",
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
    "imitation",
    "offline_learning",
    "bug_hunt",
    "your_teacher",
    "the_second_trap",
    "looking_ahead",
    "other_ways",
    "your_own_problem",
)
APPENDIX = ("traffic",)
LESSONS = COURSE + ELECTIVES + APPENDIX


def number(lesson: str) -> int:
    """A lesson's number. Raises ValueError for no lesson."""
    return LESSONS.index(lesson)


def stem(lesson: str) -> str:
    """The name of a lesson's files, such as "07_soft_constraint". Raises ValueError for no lesson."""
    return f"{number(lesson):02d}_{lesson}"


@functools.cache
def registry() -> "dict[str, Exercise]":
    """name -> exercise, in the order of the lessons and of the files' lines: every `Exercise` of NAME/exercises.py."""
    from bootcourse.course.exercise import Exercise  # loads torch, which a lesson's number does not need

    exercises = {}
    for lesson in LESSONS:
        if not (Path(__file__).parent / lesson / "exercises.py").exists():
            continue
        for value in vars(importlib.import_module(f"{__name__}.{lesson}.exercises")).values():
            if isinstance(value, Exercise):
                if value.name in exercises:
                    raise ValueError(f"Two exercises are called {value.name}: {exercises[value.name].lesson}, {lesson}")
                exercises[value.name] = replace(value, lesson=stem(lesson))
    return exercises
