"""Judge a student's answer to an exercise: it is right, or a sentence says what is wrong with it.

An answer passes if it is right in every case, and is not the library's own. Otherwise the first of these that applies
is reported: it is not written yet, is no function, takes other arguments, returns nothing, takes too long, raises an
error, changes its arguments, is a mistake that the exercise knows, has a wrong type or shape, is NaN, differs from call
to call, or is wrong in a case that is shown.

The answer runs in a process of its own (`runner.py`); it is compared here, with values that only our code has made. An
error of our own code is a verdict, too, "broke": no answer stops a notebook or the grading of a class.
"""

import contextlib
import functools
import time
import traceback
import warnings
from collections.abc import Callable, Iterable
from copy import deepcopy
from dataclasses import replace
from pathlib import Path

import numpy as np
import torch

from bootcourse.course import runner
from bootcourse.course.answer_process import Report
from bootcourse.course.answered import FORGED, LONGEST, does_nothing, given, is_unfinished, not_answered, our_fault
from bootcourse.course.exercise import Exercise, Mistake
from bootcourse.course.values import (
    NUMERIC,
    SEVERAL,
    Plain,
    close,
    fitted,
    has_nan,
    like,
    numbers,
    plain,
    same,
    same_shape,
    shape_words,
)
from bootcourse.course.verdict import Verdict
from bootcourse.errors import BootcourseError


def judge(exercise: Exercise, answer: Callable | str, seconds: float | None = None) -> Verdict:
    """The verdict on a student's function, or on a text that defines it, such as a cell that was handed in.

    Whatever the function or the text does is part of the verdict: no error is raised. A text is executed only in the
    process that also runs the function (see `runner.py` for what is guarded); its imports and helpers stand in it.
    seconds: the exercise's own if None.
    """
    begin = time.monotonic()
    seconds = exercise.seconds if seconds is None else seconds
    try:
        verdict, printed = verdict_and_print(exercise, answer, seconds, begin)
    except BootcourseError as error:  # the process did not start; it is no fault of the answer
        return Verdict("broke", str(error))
    except Exception as error:  # our own code's: the class and the notebook go on
        return broken_off(exercise, error)
    if verdict.is_right or verdict.kind == "broke":
        return verdict
    details = [line[:LONGEST] for line in (*verdict.details, *([f"printed: {printed}"] if printed else []))]
    stuck = f'Stuck? In a cell of its own: `check.hint("{exercise.name}")`'
    return replace(verdict, sentence=verdict.sentence[:LONGEST], details=tuple(details), footer=stuck)


def verdict_and_print(exercise: Exercise, answer: Callable | str, seconds: float, begin: float) -> tuple[Verdict, str]:
    """The verdict, and what the answer printed. begin: when the check began, by the monotonic clock."""
    todo = f"Nothing to check yet: your code for `{exercise.name}` goes where the `...` stands."
    if does_nothing(answer):  # an untouched stub needs no process
        return Verdict("todo", todo), ""
    runner.get_ready()
    outcomes(exercise, exercise.solution)  # on a new machine it compiles the road: the answer has its whole time
    report = runner.run(exercise, answer, seconds, begin=begin)
    if is_unfinished(report, answer):
        return Verdict("todo", todo), ""
    verdict = not_answered(exercise, answer, report) or compared(exercise, answer, report, seconds)
    return verdict, report.printed.strip()


def broken_off(exercise: Exercise, error: Exception) -> Verdict:
    """The verdict where our own code raised an error: what to send us."""
    steps = traceback.extract_tb(error.__traceback__)
    where = f" in {Path(steps[-1].filename).name}, line {steps[-1].lineno}" if steps else ""
    return our_fault(exercise, f"{type(error).__name__}: {' '.join(str(error).split())}{where}")


# Is it right? -----------------------------------------------------------------------------------------


def compared(exercise: Exercise, answer: Callable | str, report: Report, seconds: float) -> Verdict:
    """The verdict on the answers to all cases: first the values, then the slopes of a loss."""
    cases, rights = exercise.all_arguments, outcomes(exercise, exercise.solution)
    mine = [fitted(each, right) for each, right in zip(report.answers, rights, strict=True)]
    if all_same(mine, rights, exercise.tolerance):
        return right_or_the_library_s(exercise, report)
    values, right_values = (list(value_part(exercise, each)) for each in (mine, rights))
    fails = [case for case in range(len(cases)) if not same(values[case], right_values[case], exercise.tolerance)]
    if mistake := known_mistake(exercise, mine, rights, values if fails else None):
        return Verdict("wrong", mistake.says, mistake=mistake)
    if not fails:
        return slopes_in_words(exercise, mine, rights)
    if sentence := no_truth_value(values, right_values):
        return Verdict("wrong", sentence, given(exercise, cases[fails[0]]))
    comparable = [like(*pair) and same_shape(*pair) for pair in zip(values, right_values, strict=True)]
    no_number = any(has_nan(one) and not has_nan(right) for one, right in zip(values, right_values, strict=True))
    if exercise.explain and all(comparable) and not no_number:
        sentence = exercise.explain(cases, [each.data for each in values])
        drawn = (mistake for mistake in exercise.mistakes if mistake.says == sentence)  # its values never repeat
        return Verdict("wrong", sentence, mistake=next(drawn, None))
    case = fails[0]
    if comparable[case] and answers_anew(exercise, answer, seconds):
        sentence = ("For the same arguments your function answers differently each time: it draws at random, or "
                    "keeps a value from one call to the next.")  # fmt: skip
        return Verdict("wrong", sentence, given(exercise, cases[case]))
    return unknown(exercise, cases[case], values[case], right_values[case])


def right_or_the_library_s(exercise: Exercise, report: Report) -> Verdict:
    """The verdict on an answer that is right in every case."""
    if report.library:
        sentence = "Right, and this is the library's: write your own to learn it."
        return Verdict("library", sentence, (f"the library's own: {report.library}"[:LONGEST],))
    count = len(exercise.all_arguments)
    return Verdict("passed", f"Right. Your `{exercise.name}` agrees in all {count} cases, corner cases included.")


def known_mistake(
    exercise: Exercise, mine: list[Plain], rights: list[Plain], values: list[Plain] | None
) -> Mistake | None:
    """The exercise's mistake that gives the same answers. values: if they are wrong; they count alone, too."""
    for is_whole in (True, False) if values is not None else (True,):
        for mistake in exercise.mistakes:
            theirs = map(fitted, outcomes(exercise, mistake.answer), rights)  # case by case: most differ in the first
            pair = (mine, theirs) if is_whole else (values, value_part(exercise, theirs))
            if all_same(*pair, exercise.tolerance):
                return mistake
    return None


def no_truth_value(values: list[Plain], rights: list[Plain]) -> str:
    """A sentence where True or False is asked for and another number came; "" elsewhere."""
    for mine, right in zip(values, rights, strict=True):
        if like(mine, right) and right.kind == "number" and right.array.dtype == bool and mine.array not in (0, 1):
            return f"Your function returns {numbers(mine)} in this case: the exercise asks for True or False."
    return ""


def answers_anew(exercise: Exercise, answer: Callable | str, seconds: float) -> bool:
    """Does it answer the same cases differently when all are run twice in one process? One alone could agree."""
    twice, count = runner.run(exercise, answer, seconds, times=2).answers, len(exercise.all_arguments)
    return len(twice) == 2 * count and not all_same(twice[:count], twice[count:], exercise.tolerance)


def value_part(exercise: Exercise, answers: Iterable[Plain]) -> Iterable[Plain]:
    """The answers without the slopes that follow a loss's value."""
    return (each.parts[0] for each in answers) if exercise.slopes else answers


def all_same(answers: Iterable[Plain], others: Iterable[Plain], tolerance: float) -> bool:
    """Are they the same? It ends at the first case that differs."""
    return all(same(a, other, tolerance, nan_too=True) for a, other in zip(answers, others, strict=True))


@contextlib.contextmanager
def one_thread():
    """PyTorch computes on one thread: for small tensors several are slower, much so on a busy machine."""
    threads = torch.get_num_threads()
    torch.set_num_threads(1)
    try:
        yield
    finally:
        torch.set_num_threads(threads)


@functools.lru_cache(maxsize=1024)
def outcomes(exercise: Exercise, function: Callable) -> list[Plain]:
    """The answers of a solution or of a known mistake to all cases."""
    with np.errstate(all="ignore"), warnings.catch_warnings(), one_thread():
        warnings.simplefilter("ignore")
        return [plain(exercise.outcome(function, *deepcopy(case))) for case in exercise.all_arguments]


def slopes_in_words(exercise: Exercise, answers: list[Plain], rights: list[Plain]) -> Verdict:
    """The verdict on a loss whose values are right, and a slope is not."""
    slopes = {
        name: [(a.parts[place], right.parts[place]) for a, right in zip(answers, rights, strict=True)]
        for place, name in enumerate(exercise.slopes, 1)
    }
    differ = ((name, k) for name in slopes for k, s in enumerate(slopes[name]) if not same(*s, exercise.tolerance))
    name, case = next(differ)
    pairs = slopes[name]
    mine, right = pairs[case]
    details = ()
    if mine.kind == "text":
        why = "use torch's functions" if "numpy" in mine.text else " ".join(mine.text.split()).rstrip(".")
        wrong = f"no gradient can pass through it: {why}."
    elif not (like(mine, right) and same_shape(mine, right)):
        return Verdict("wrong", FORGED)
    elif not any(right.array.any() for _, right in pairs):
        wrong = f"a gradient flows into `{name}`, which must not change: use `{name}.detach()`."
    elif not any(mine.kind in NUMERIC and mine.array.any() for mine, _ in pairs):
        wrong = f"no gradient reaches `{name}`: look for `.detach()`, `.item()`, `float()` or NumPy."
    else:
        details = (f"your slope = {numbers(mine)}", f"right = {numbers(right)}")
        details = (*given(exercise, exercise.all_arguments[case]), *details)
        wrong = f"its slope in `{name}` is wrong: look for a part that is detached, or that should be."
        if has_nan(mine):
            what = "is not a number (NaN): is something infinite, perhaps in a branch that `torch.where` drops?"
            wrong = f"its slope in `{name}` {what}"
    return Verdict("wrong", f"Your `{exercise.name}` has the right value, but {wrong}", details)


def unknown(exercise: Exercise, case: tuple, mine: Plain, right: Plain) -> Verdict:
    """The verdict on a wrong value that is none of the exercise's known mistakes."""
    details = given(exercise, case)
    if not like(mine, right):
        why = ", because training needs one" if right.kind == "tensor" and mine.kind in ("array", *SEVERAL) else ""
        return Verdict("wrong", f"Your function returns {mine.words}: the exercise asks for {right.words}{why}.")
    if not same_shape(mine, right):
        shapes = f"Your answer has shape {shape_words(mine)}: the right one has shape {shape_words(right)}."
        return Verdict("wrong", shapes, details)
    if has_nan(mine) and not has_nan(right):
        return Verdict("wrong", "Your answer is not a number (NaN) in this case.", details)
    at, values = "", (numbers(mine), numbers(right))
    if right.kind in NUMERIC and right.shape:
        place = tuple(np.argwhere(~close(mine, right, exercise.tolerance))[0].tolist())
        at = f" at [{', '.join(map(str, place))}]"
        if right.array.size > 36:  # `numbers` gives only the shape
            values = f"{mine.array[place]:.6g}", f"{right.array[place]:.6g}"
    details = (*details, f"yours = {values[0]}", f"right = {values[1]}")
    return Verdict("wrong", f"Not right yet: here your answer and the right one differ{at}.", details)
