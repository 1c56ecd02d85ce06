"""The checks that a notebook calls: `check.NAME(my_function)`, `check.hint("NAME")`, `check.solution("NAME")`.

NAME is an exercise (see `exercise.py`). A check says what is wrong with an answer and raises no error, and the cells
after it use the library's code, so the notebook goes on. `check.strict()` is for solved notebooks: after it, an answer
that does not pass raises `NotPassed`.
"""

import functools
import os
import sys
from collections.abc import Callable
from dataclasses import replace

from bootcourse.course import runner
from bootcourse.course.answer_files import PARTS
from bootcourse.course.edition import CLOSED, solutions_are_open
from bootcourse.course.exercise import Exercise, source_of
from bootcourse.course.judge import judge
from bootcourse.course.lessons import registry
from bootcourse.course.verdict import Verdict
from bootcourse.errors import BootcourseError, check_known, did_you_mean
from bootcourse.one_per_cell import this_cell

_hints_given: dict[str, int] = {}
_strict = False
_keeps = True
if "ipykernel" in sys.modules and "BOOTCOURSE_NO_ANSWERS" not in os.environ:  # in a notebook a check comes soon
    runner.get_ready()


class NotPassed(BootcourseError):
    """A check in strict mode did not pass."""


def strict(on: bool = True) -> None:
    """From now on, an answer that does not pass raises NotPassed."""
    global _strict
    _strict = on


def keep_nothing() -> None:
    """From now on a passed answer is not noted, as where the notebooks are made."""
    global _keeps
    _keeps = False


def hint(name: str) -> Verdict:
    """The next hint; after the last, the last one again. Raises BootcourseError for an unknown exercise."""
    exercise = _find(name)
    number = min(_hints_given.get(name, 0) + 1, len(exercise.hints))
    _hints_given[name] = number
    left = len(exercise.hints) - number
    more = f'`check.solution("{name}")` shows the solution.' if solutions_are_open() else ""
    more = f'`check.hint("{name}")` gives another.' if left else more
    return Verdict("hint", f"Hint {number} of {len(exercise.hints)}: {exercise.hints[number - 1]}", footer=more)


def solution(name: str):
    """The code of a right answer. Raises BootcourseError for an unknown exercise, and where solutions are closed."""
    if not solutions_are_open():
        raise BootcourseError(CLOSED)
    from IPython.display import Code

    return Code(source_of(_find(name).solution), language="python")


def _find(name: str) -> Exercise:
    check_known("The exercise", name, registry())
    return registry()[name]


def _check(exercise: Exercise, answer: Callable) -> Verdict:
    verdict = judge(exercise, answer)
    if _strict and not verdict.passed:
        raise NotPassed(f"{exercise.name}: {verdict}")
    if not verdict.passed or _strict:
        return verdict
    if _keeps and this_cell() is not None:
        from bootcourse.course.progress_card import note_passed

        note_passed(exercise.name)
    if exercise.name in PARTS or "bootcourse.course.own_code" in sys.modules:
        from bootcourse.course import own_code

        verdict = replace(verdict, footer=own_code.keep(exercise.name, answer))
    return verdict


def __getattr__(name: str) -> Callable[[Callable], Verdict]:
    """The check `check.NAME` of an exercise."""
    if name.startswith("_") or name not in registry():
        raise AttributeError(f"The exercise {did_you_mean(name, registry())}.")
    return functools.partial(_check, registry()[name])


def __dir__() -> list[str]:
    return ["hint", "solution", "strict", *registry()]
