"""Judge a student's answer to an exercise: it is right, or a sentence says what is wrong with it.

An answer passes if it is right in every case. Otherwise the first of these that applies is reported: it is no
function, takes other arguments, is not written yet, returns nothing, takes too long, raises an error, changes its
arguments, is a mistake that the exercise knows, has a wrong type or shape, is NaN, differs from call to call, or is
wrong in a case that is shown.
"""

import functools
import inspect
import warnings
from collections.abc import Callable
from copy import deepcopy

import numpy as np

from bootcourse.lessons import guard
from bootcourse.lessons.exercise import Exercise
from bootcourse.lessons.values import (
    Plain,
    first_difference,
    has_nan,
    like,
    numbers,
    plain,
    same,
    same_shape,
    shape_words,
)
from bootcourse.lessons.verdict import Verdict


def judge(exercise: Exercise, answer: Callable) -> Verdict:
    """The verdict on a student's function. An error in the function is part of the verdict and is not raised."""
    if not callable(answer):
        return wrong(exercise, f"Give the check your function itself, `check.{exercise.name}({exercise.name})`: "
                               f"this is {plain(answer).words}.")  # fmt: skip
    if not takes(answer, len(exercise.arguments)):
        return wrong(exercise, f"Your function takes {inspect.signature(answer)}: the check calls `{exercise.call}`.")
    cases = exercise.all_arguments()
    report = guard.run(functools.partial(exercise.run, answer), cases, exercise.seconds)
    verdict = ended_early(exercise, answer, report, cases) or judge_answers(exercise, answer, report, cases)
    if report.printed and not verdict.passed:
        verdict = Verdict(
            verdict.kind, verdict.sentence, (*verdict.details, f"printed: {report.printed}"), verdict.footer
        )
    return verdict


def takes(answer: Callable, how_many: int) -> bool:
    """Can it be called with that many arguments?"""
    try:
        inspect.signature(answer).bind(*[None] * how_many)
    except TypeError:
        return False
    except ValueError:  # a function written in C may have no signature
        return True
    return True


def ended_early(exercise: Exercise, answer: Callable, report: guard.GuardedRun, cases: list[tuple]) -> Verdict | None:
    """The verdict on a function that did not answer every case, or changed its arguments; None if it did well."""
    empty = [number for number, answer in enumerate(report.answers) if answer.kind == "NoneType"]
    if isinstance(report.error, NotImplementedError) or empty[:1] == [0]:
        sentence = f"Nothing to check yet: write `{exercise.name}` where the `...` stands, and end with `return`."
        return Verdict("todo", sentence, footer=help_for(exercise))
    if empty:
        sentence = "Your function returns nothing in this case: look for a branch without `return`."
        return wrong(exercise, sentence, given(exercise, cases[empty[0]]))
    if report.out_of_time:
        sentence = f"Your function was stopped after {exercise.seconds:g} s: look for a loop that never ends."
        if report.still_runs:
            sentence = (f"Your function did not answer within {exercise.seconds:g} s and cannot be stopped: "
                        "restart the kernel if the notebook gets slow.")  # fmt: skip
        return wrong(exercise, sentence, given(exercise, cases[min(report.case, len(cases) - 1)]))
    if report.error is not None:
        place = guard.where(report.error, answer)
        what = f"{type(report.error).__name__}: {' '.join(str(report.error).split())}".strip(" :").rstrip(".")
        sentence = f"Your function raises an error{f' in {place}' if place else ''}: {what}."
        return wrong(exercise, sentence, given(exercise, cases[report.case]))
    if report.changed is not None:
        argument = exercise.case_names[report.changed[1]]
        return wrong(exercise, f"Your function changes its argument `{argument}`, which the caller still needs: "
                               "compute a new value instead of writing into it.")  # fmt: skip
    return None


def judge_answers(exercise: Exercise, answer: Callable, report: guard.GuardedRun, cases: list[tuple]) -> Verdict:
    """The verdict on the answers to all cases."""
    rights = outcomes(exercise, exercise.solution, cases)
    pairs = list(zip(report.answers, rights, strict=True))
    fails = [number for number, (a, right) in enumerate(pairs) if not same(a, right, exercise.tolerance)]
    if not fails:
        return Verdict(
            "passed", f"Right. Your `{exercise.name}` agrees in all {len(cases)} cases, corner cases included."
        )
    for mistake in exercise.mistakes:
        theirs = outcomes(exercise, mistake.answer, cases)
        if all(same(a, m, exercise.tolerance, nan_too=True) for a, m in zip(report.answers, theirs, strict=True)):
            return wrong(exercise, mistake.says)
    case = fails[0]
    mine, right = pairs[case]
    if exercise.explain and all(like(a, right) and same_shape(a, right) for a in report.answers):
        return wrong(exercise, exercise.explain(cases, [a.data for a in report.answers]))
    if like(mine, right) and same_shape(mine, right) and changes_its_mind(exercise, answer, report, cases):
        sentence = (
            "For the same arguments your function answers differently each time: it draws at random, or keeps a value "
            "from one call to the next."
        )
        return wrong(exercise, sentence, given(exercise, cases[case]))
    return wrong(exercise, *unknown_mistake(exercise, cases[case], mine, right))


def changes_its_mind(exercise: Exercise, answer: Callable, report: guard.GuardedRun, cases: list[tuple]) -> bool:
    """Does a second run of all cases give other answers? (In a single case they could agree by chance.)"""
    again = guard.run(functools.partial(exercise.run, answer), cases, exercise.seconds)
    pairs = zip(report.answers, again.answers, strict=False)
    return not all(same(first, second, exercise.tolerance, nan_too=True) for first, second in pairs)


def unknown_mistake(exercise: Exercise, case: tuple, mine: Plain, right: Plain) -> tuple[str, tuple]:
    """(sentence, details) about a wrong answer that is none of the exercise's known mistakes."""
    if not like(mine, right):
        return f"Your function returns {mine.words}: the exercise asks for {right.words}.", ()
    if not same_shape(mine, right):
        shapes = f"Your answer has shape {shape_words(mine)}: the right one has shape {shape_words(right)}."
        return shapes, given(exercise, case)
    if has_nan(mine) and not has_nan(right):
        return "Your answer is not a number (NaN) here: look for 0/0, ∞ - ∞ or log 0.", given(exercise, case)
    place = first_difference(mine, right, exercise.tolerance)
    at = f" at [{', '.join(map(str, place))}]" if place else ""
    small = max(mine.data.size, right.data.size) <= 36 if place else True
    values = (numbers(mine), numbers(right)) if small else (f"{mine.data[place]:.6g}", f"{right.data[place]:.6g}")
    details = (*given(exercise, case), f"yours = {values[0]}", f"right = {values[1]}")
    return f"Not right yet: here your answer and the right one differ{at}.", details


def outcomes(exercise: Exercise, function: Callable, cases: list[tuple]) -> list[Plain]:
    """The answers of a solution or of a known mistake to all cases."""
    with np.errstate(all="ignore"), warnings.catch_warnings():
        warnings.simplefilter("ignore")
        return [plain(exercise.run(function, *deepcopy(case))) for case in cases]


def given(exercise: Exercise, case: tuple) -> tuple[str, ...]:
    """The arguments of a case, one line each."""
    return tuple(f"{name} = {numbers(plain(value))}" for name, value in zip(exercise.case_names, case, strict=True))


def help_for(exercise: Exercise) -> str:
    return f'Stuck? `check.hint("{exercise.name}")`'


def wrong(exercise: Exercise, sentence: str, details: tuple[str, ...] = ()) -> Verdict:
    return Verdict("wrong", sentence, details, help_for(exercise))
