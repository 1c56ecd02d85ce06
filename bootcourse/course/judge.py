"""Judge a student's answer to an exercise: it is right, or a sentence says what is wrong with it.

An answer passes if it is right in every case. Otherwise the first of these that applies is reported: it is not written
yet, is no function, takes other arguments, returns nothing, takes too long, raises an error, changes its arguments, is
a mistake that the exercise knows, has a wrong type or shape, is NaN, differs from call to call, or is wrong in a case
that is shown.

The answer runs in a process of its own (`runner.py`); it is compared here, with values that only our code has made.
"""

import contextlib
import dis
import functools
import inspect
import linecache
import re
import signal
import time
import warnings
from collections.abc import Callable, Iterable
from copy import deepcopy
from dataclasses import replace

import numpy as np
import torch

from bootcourse.course import runner
from bootcourse.course.exercise import Exercise, NotAsAsked
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

LONGEST = 2000  # characters of a line that a verdict shows
FORGED = "Your function ended its own check: return the answer instead."  # it sent a report of its own


def judge(exercise: Exercise, answer: Callable | str, seconds: float | None = None) -> Verdict:
    """The verdict on a student's function, or on a text that defines it, such as a cell that was handed in.

    Whatever the function or the text does is part of the verdict: no error is raised. A text is executed only in the
    process that also runs the function (see `runner.py` for what is guarded); its imports and helpers stand in it.
    seconds: the exercise's own if None.
    """
    begin = time.monotonic()
    todo = f"Nothing to check yet: write `{exercise.name}` where the `...` stands, and end with `return`."
    verdict, printed = Verdict("todo", todo), ""
    if not does_nothing(answer):  # an untouched stub needs no process
        seconds = exercise.seconds if seconds is None else seconds
        runner.get_ready()
        outcomes(exercise, exercise.solution)  # on a new machine it compiles the road: the answer has its whole time
        report = runner.run(exercise, answer, seconds, begin=begin)
        if not is_unfinished(report, answer):
            verdict = not_answered(exercise, answer, report) or compared(exercise, answer, report, seconds)
            printed = report.printed.strip()
    if verdict.passed:
        return verdict
    details = [line[:LONGEST] for line in (*verdict.details, *([f"printed: {printed}"] if printed else []))]
    stuck = f'Stuck? `check.hint("{exercise.name}")`'
    return replace(verdict, sentence=verdict.sentence[:LONGEST], details=tuple(details), footer=stuck)


# Did it answer? ---------------------------------------------------------------------------------------


def does_nothing(answer) -> bool:
    """Is it a function whose body is `...`, `pass`, a docstring or `return None`, or a class of such functions?"""
    if isinstance(answer, type):
        return all(does_nothing(part) for part in vars(answer).values() if callable(part))
    code = runner.code_of(answer)
    idle = ("RESUME", "NOP", "COPY_FREE_VARS", "LOAD_CONST", "RETURN_CONST", "RETURN_VALUE")
    return code is not None and all(
        step.opname in idle and (not step.opname.endswith("_CONST") or step.argval is None)
        for step in dis.get_instructions(code)
    )


def is_unfinished(report: runner.Report, answer: Callable | str) -> bool:
    """Does it return nothing and still have the `...` of a stub, or raise NotImplementedError?"""
    if report.error is not None and report.error[0] == NotImplementedError.__name__:
        return True
    try:
        text = answer if isinstance(answer, str) else inspect.getsource(answer)
    except (OSError, TypeError):
        return False
    returns_nothing = report.answers[:1] and report.answers[0].kind == "NoneType"
    return bool(returns_nothing) and re.search(r"^\s*(\.\.\.|pass)\s*$", text, re.M) is not None


def not_answered(exercise: Exercise, answer: Callable | str, report: runner.Report) -> Verdict | None:
    """The verdict on a function that did not answer every case, or changed its arguments; None if it did well."""
    cases, answers, parts = exercise.all_arguments, report.answers, 1 + len(exercise.slopes)
    nothing = [case for case, value in enumerate(answers) if value.kind == "NoneType"]
    if report.refused:
        return Verdict("wrong", report.refused)
    if report.ended != "":
        return Verdict("did_not_run", end_in_words(report.ended, report.seconds))
    if len(answers) > len(cases) or report.error is None and len(answers) < len(cases):
        return Verdict("wrong", FORGED)
    if nothing and len(nothing) == len(answers):
        return Verdict("wrong", "Your function returns nothing: end it with `return` and what the exercise asks for.")
    if nothing:
        sentence = "Your function returns nothing in this case: look for a branch without `return`."
        return Verdict("wrong", sentence, given(exercise, cases[nothing[0]]))
    if report.error is not None:
        here = given(exercise, cases[min(len(answers), len(cases) - 1)])
        if report.error[0] == NotAsAsked.__name__:
            return Verdict("wrong", report.error[1], here)
        return Verdict("did_not_run", error_in_words(answer, *report.error), here)
    if report.changed is not None:
        names = exercise.case_names
        argument = names[report.changed[1] % len(names)]
        return Verdict("wrong", f"Your function changes its argument `{argument}`, which the caller still needs: "
                                "compute a new value instead of writing into it.")  # fmt: skip
    return Verdict("wrong", FORGED) if parts > 1 and any(len(each.parts or ()) != parts for each in answers) else None


def error_in_words(answer: Callable | str, kind: str, text: str, line: int | None) -> str:
    """One sentence about an error that the function raised, with its line if it is the student's."""
    where = ""
    if line is not None:
        lines = answer.splitlines() if isinstance(answer, str) else linecache.getlines(runner.file_of(answer))
        code = lines[line - 1].strip() if 0 < line <= len(lines) else ""
        where = f" in line {line}" + (f", `{code}`" if code else "")
    if kind == "MemoryError" or "can't allocate memory" in text:
        limit = f"{runner.MEMORY / 2**30:.0f} GiB"
        return f"Your function asks for more memory{where} than the {limit} that a check allows."
    return f"Your function raises an error{where}: {f'{kind}: {text}'.strip(' :').rstrip('.')}."


def end_in_words(ended: str | int, seconds: float) -> str:
    """One sentence about a process that ended before the function did."""
    if ended == "time":
        return f"Your function was stopped after {seconds:.2g} s: look for a loop that never ends."
    if ended == "size":
        return "Your function returns or sends too much to compare: look for a list or an array that is far too large."
    if ended < 0 or ended == 255:  # 255: the process that started it has ended, too
        name = signal.Signals(-ended).name if -ended in set(signal.Signals) else f"signal {-ended}"
        return (f"Your function made Python crash ({name}): look for a recursion without an end, or for compiled code "
                "that gets arguments of a wrong size.")  # fmt: skip
    return f"Your function ended Python itself (exit code {ended}): take out `os._exit` and the like."


# Is it right? -----------------------------------------------------------------------------------------


def compared(exercise: Exercise, answer: Callable | str, report: runner.Report, seconds: float) -> Verdict:
    """The verdict on the answers to all cases: first the values, then the slopes of a loss."""
    cases, rights = exercise.all_arguments, outcomes(exercise, exercise.solution)
    mine = [fitted(each, right) for each, right in zip(report.answers, rights, strict=True)]
    if all_same(mine, rights, exercise.tolerance):
        sentence = f"Right. Your `{exercise.name}` agrees in all {len(cases)} cases, corner cases included."
        return Verdict("passed", sentence)
    values, right_values = (value_part(exercise, each) for each in (mine, rights))
    fails = [case for case in range(len(cases)) if not same(values[case], right_values[case], exercise.tolerance)]
    for is_whole in (True, False) if fails else (True,):  # a mistake counts by its values alone, too
        for mistake in exercise.mistakes:
            theirs = list(map(fitted, outcomes(exercise, mistake.answer), rights))
            pair = (mine, theirs) if is_whole else (values, value_part(exercise, theirs))
            if all_same(*pair, exercise.tolerance):
                return Verdict("wrong", mistake.says, mistake=mistake)
    if not fails:
        return slopes_in_words(exercise, mine, rights)
    comparable = [like(*pair) and same_shape(*pair) for pair in zip(values, right_values, strict=True)]
    no_number = any(has_nan(one) and not has_nan(right) for one, right in zip(values, right_values, strict=True))
    if exercise.explain and all(comparable) and not no_number:
        sentence = exercise.explain(cases, [each.data for each in values])
        drawn = (mistake for mistake in exercise.mistakes if mistake.says == sentence)  # its values never repeat
        return Verdict("wrong", sentence, mistake=next(drawn, None))
    case = fails[0]
    if comparable[case]:  # run all cases twice in one process: one case alone could agree by chance
        twice = runner.run(exercise, answer, seconds, times=2).answers
        first, again = twice[: len(cases)], twice[len(cases) :]
        if len(again) == len(cases) and not all_same(first, again, exercise.tolerance):
            sentence = ("For the same arguments your function answers differently each time: it draws at random, or "
                        "keeps a value from one call to the next.")  # fmt: skip
            return Verdict("wrong", sentence, given(exercise, cases[case]))
    return unknown(exercise, cases[case], values[case], right_values[case])


def value_part(exercise: Exercise, answers: list[Plain]) -> list[Plain]:
    """The answers without the slopes that follow a loss's value."""
    return [each.parts[0] for each in answers] if exercise.slopes else answers


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
    elif not any(right.array.any() for _, right in pairs):
        wrong = f"a gradient flows into `{name}`, which must not change: use `{name}.detach()`."
    elif not any(mine.array.any() for mine, _ in pairs):
        wrong = f"no gradient reaches `{name}`: look for `.detach()`, `.item()`, `float()` or NumPy."
    else:
        details = (f"your slope = {numbers(mine)}", f"right = {numbers(right)}")
        details = (*given(exercise, exercise.all_arguments[case]), *details)
        wrong = f"its slope in `{name}` is wrong: look for a part that is detached."
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


def given(exercise: Exercise, case: tuple) -> tuple[str, ...]:
    """The arguments of a case, one line each."""
    return tuple(f"{name} = {numbers(plain(value))}" for name, value in zip(exercise.case_names, case, strict=True))
