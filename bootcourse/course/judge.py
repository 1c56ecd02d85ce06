"""Judge a student's answer to an exercise: it is right, or a sentence says what is wrong with it.

An answer passes if it is right in every case. Otherwise the first of these that applies is reported: it is not written
yet, is no function, takes other arguments, returns nothing, takes too long, raises an error, changes its arguments, is
a mistake that the exercise knows, has a wrong type or shape, is NaN, differs from call to call, or is wrong in a case
that is shown.

The answer runs in a process of its own (`runner.py`); it is compared here, with values that only our code has made.
"""

import dis
import functools
import inspect
import linecache
import re
import signal
import warnings
from collections.abc import Callable, Iterable
from copy import deepcopy
from dataclasses import replace

import numpy as np

from bootcourse.course import runner
from bootcourse.course.exercise import Exercise, Mistake, NotAsAsked
from bootcourse.course.values import (
    NUMERIC,
    SEVERAL,
    Plain,
    first_difference,
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


def judge(exercise: Exercise, answer: Callable | str, seconds: float | None = None) -> Verdict:
    """The verdict on a student's function. An error in the function is part of the verdict and is not raised."""
    if does_nothing(answer):  # an untouched stub needs no process
        return todo(exercise)
    seconds = exercise.seconds if seconds is None else seconds
    report = runner.run(exercise, answer, seconds)
    verdict = not_answered(exercise, answer, report, seconds) or compared(exercise, answer, report, seconds)
    if report.printed and not verdict.passed:
        verdict = replace(verdict, details=(*verdict.details, f"printed: {report.printed.strip()}"))
    return verdict


def judge_source(exercise: Exercise, source: str, seconds: float | None = None) -> Verdict:
    """The verdict on a text that defines the function, for instance a cell of a notebook that was handed in.

    The text is executed only in the process that also runs the function (see `runner.py` for what is guarded), within
    the same `seconds` (the exercise's own if None). Put the imports and the helpers that the function needs before it
    in the same text. A text that cannot be executed, or does not define the function, gets a verdict, too: no text
    raises an error here.
    """
    return judge(exercise, source, seconds)


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


def not_answered(exercise: Exercise, answer: Callable | str, report: runner.Report, seconds: float) -> Verdict | None:
    """The verdict on a function that did not answer every case, or changed its arguments; None if it did well."""
    cases = exercise.all_arguments
    here = given(exercise, cases[min(len(report.answers), len(cases) - 1)])
    nothing = [case for case, value in enumerate(report.answers) if value.kind == "NoneType"]
    if report.refused:
        return wrong(exercise, report.refused)
    if nothing[:1] == [0]:
        return todo(exercise) if is_begun(answer) else wrong(exercise, RETURNS_NOTHING)
    if nothing:
        sentence = "Your function returns nothing in this case: look for a branch without `return`."
        return wrong(exercise, sentence, given(exercise, cases[nothing[0]]))
    if report.error is not None:
        kind, text, line = report.error
        if kind == NotImplementedError.__name__:
            return todo(exercise)
        if kind == NotAsAsked.__name__:
            return wrong(exercise, text, here)
        return wrong(exercise, error_in_words(kind, text, place(answer, line)), here, kind="did_not_run")
    if report.ended != "":
        return wrong(exercise, end_in_words(report.ended, seconds), here, kind="did_not_run")
    if report.changed is not None:
        argument = exercise.case_names[report.changed[1]]
        return wrong(exercise, f"Your function changes its argument `{argument}`, which the caller still needs: "
                               "compute a new value instead of writing into it.")  # fmt: skip
    return None


RETURNS_NOTHING = "Your function returns nothing: end it with `return` and what the exercise asks for."


def is_begun(answer: Callable | str) -> bool:
    """Does its text still have the `...` of a stub?"""
    try:
        text = answer if isinstance(answer, str) else inspect.getsource(answer)
    except (OSError, TypeError):
        return False
    return re.search(r"^\s*(\.\.\.|pass)\s*$", text, re.M) is not None


def place(answer: Callable | str, line: int | None) -> str:
    """The student's line that raised the error, as in " in line 4, `return x + y`"; empty if none of theirs did."""
    if line is None:
        return ""
    lines = answer.splitlines() if isinstance(answer, str) else linecache.getlines(runner.file_of(answer))
    text = lines[line - 1].strip() if 0 < line <= len(lines) else ""
    return f" in line {line}" + (f", `{text}`" if text else "")


def error_in_words(kind: str, text: str, where: str) -> str:
    """One sentence about an error that the function raised."""
    if kind == "MemoryError" or "can't allocate memory" in text:
        return f"Your function asks for more memory{where} than the {runner.MEMORY / 2**30:.0f} GiB that a check allows."
    return f"Your function raises an error{where}: {f'{kind}: {text}'.strip(' :').rstrip('.')}."


def end_in_words(ended: str | int, seconds: float) -> str:
    """One sentence about a process that ended before the function did."""
    if ended == "time":
        return f"Your function was stopped after {seconds:g} s: look for a loop that never ends."
    if ended == "size":
        return "Your function returns too much to compare: look for a list or an array that is far too large."
    if ended < 0 or ended == 255:  # 255: the process that started it has ended, too
        name = signal.Signals(-ended).name if -ended in set(signal.Signals) else f"signal {-ended}"
        return (f"Your function made Python crash ({name}): look for a recursion without an end, or for compiled code "
                "that gets arguments of a wrong size.")  # fmt: skip
    return f"Your function ended Python itself (exit code {ended}): take out `os._exit` and the like."


def compared(exercise: Exercise, answer: Callable | str, report: runner.Report, seconds: float) -> Verdict:
    """The verdict on the answers to all cases: first the values, then the slopes of a loss."""
    cases, rights = exercise.all_arguments, outcomes(exercise, exercise.solution)
    mine = [fitted(each, right) for each, right in zip(report.answers, rights, strict=True)]
    if all_same(mine, rights, exercise.tolerance):
        sentence = f"Right. Your `{exercise.name}` agrees in all {len(cases)} cases, corner cases included."
        return Verdict("passed", sentence)
    of = (lambda each: each.data[0]) if exercise.slopes else (lambda each: each)
    values, right_values = list(map(of, mine)), list(map(of, rights))
    pairs = zip(values, right_values, strict=True)
    fails = [case for case, pair in enumerate(pairs) if not same(*pair, exercise.tolerance)]
    for part in (lambda each: each, of) if fails else (lambda each: each,):
        for mistake in exercise.mistakes:
            theirs = (part(fitted(each, right)) for each, right in zip(outcomes(exercise, mistake.answer), rights, strict=True))
            if all_same(map(part, mine), theirs, exercise.tolerance):
                return wrong(exercise, mistake.says, mistake=mistake)
    if not fails:
        return wrong(exercise, *slopes_in_words(exercise, mine, rights))
    comparable = [like(*pair) and same_shape(*pair) for pair in zip(values, right_values, strict=True)]
    if exercise.explain and all(comparable):
        return wrong(exercise, exercise.explain(cases, [each.data for each in values]))
    case = fails[0]
    if comparable[case] and changes_its_mind(exercise, answer, seconds):
        sentence = (
            "For the same arguments your function answers differently each time: it draws at random, or keeps a value "
            "from one call to the next."
        )
        return wrong(exercise, sentence, given(exercise, cases[case]))
    return wrong(exercise, *unknown(exercise, cases[case], values[case], right_values[case], report.warned.get(case)))


def all_same(answers: Iterable[Plain], others: Iterable[Plain], tolerance: float) -> bool:
    """Are they the same? It ends at the first case that differs."""
    return all(same(a, other, tolerance, nan_too=True) for a, other in zip(answers, others, strict=True))


@functools.lru_cache(maxsize=1024)
def outcomes(exercise: Exercise, function: Callable) -> list[Plain]:
    """The answers of a solution or of a known mistake to all cases."""
    with np.errstate(all="ignore"), warnings.catch_warnings():
        warnings.simplefilter("ignore")
        return [plain(exercise.outcome(function, *deepcopy(case))) for case in exercise.all_arguments]


def changes_its_mind(exercise: Exercise, answer: Callable | str, seconds: float) -> bool:
    """Does it answer differently when the same process runs all cases twice? (One case could agree by chance.)"""
    answers, cases = runner.run(exercise, answer, seconds, times=2).answers, len(exercise.all_arguments)
    return len(answers) == 2 * cases and not all_same(answers[:cases], answers[cases:], exercise.tolerance)


def slopes_in_words(exercise: Exercise, answers: list[Plain], rights: list[Plain]) -> tuple[str, tuple[str, ...]]:
    """(sentence, details) about a loss whose values are right, and a slope is not."""
    but = f"Your `{exercise.name}` has the right value, but"
    for place, name in enumerate(exercise.slopes, 1):
        pairs = [(a.data[place], right.data[place]) for a, right in zip(answers, rights, strict=True)]
        fails = [case for case, pair in enumerate(pairs) if not same(*pair, exercise.tolerance)]
        if fails:
            break
    mine, right = pairs[fails[0]]
    if mine.kind == "text":
        why = "use torch's functions" if "numpy" in mine.data else " ".join(mine.data.split()).rstrip(".")
        return f"{but} no gradient can pass through it: {why}.", ()
    if not any(right.data.any() for _, right in pairs):
        return f"{but} a gradient flows into `{name}`, which must not change: use `{name}.detach()`.", ()
    if not any(mine.data.any() for mine, _ in pairs):
        return f"{but} no gradient reaches `{name}`: look for `.detach()`, `.item()`, `float()` or NumPy.", ()
    what = "is wrong: look for a part that is detached."
    if has_nan(mine):
        what = "is not a number (NaN): is something infinite, perhaps in a branch that `torch.where` drops?"
    details = (f"your slope = {numbers(mine)}", f"right = {numbers(right)}")
    return f"{but} its slope in `{name}` {what}", (*given(exercise, exercise.all_arguments[fails[0]]), *details)


def unknown(exercise: Exercise, case: tuple, mine: Plain, right: Plain, warned: str | None) -> tuple[str, tuple]:
    """(sentence, details) about a wrong value that is none of the exercise's known mistakes."""
    if not like(mine, right):
        why = ", because training needs one" if right.kind == "tensor" and mine.kind in ("array", *SEVERAL) else ""
        return f"Your function returns {mine.words}: the exercise asks for {right.words}{why}.", ()
    if not same_shape(mine, right):
        shapes = f"Your answer has shape {shape_words(mine)}: the right one has shape {shape_words(right)}."
        return shapes, given(exercise, case)
    if has_nan(mine) and not has_nan(right):
        why = f": NumPy says '{warned}'" if warned else ""
        return f"Your answer is not a number (NaN) in this case{why}.", given(exercise, case)
    place = first_difference(mine, right, exercise.tolerance)
    at = f" at [{', '.join(map(str, place))}]" if place else ""
    small = right.kind not in NUMERIC or right.data.size <= 36
    values = (numbers(mine), numbers(right)) if small else (f"{mine.data[place]:.6g}", f"{right.data[place]:.6g}")
    details = (*given(exercise, case), f"yours = {values[0]}", f"right = {values[1]}")
    return f"Not right yet: here your answer and the right one differ{at}.", details


def given(exercise: Exercise, case: tuple) -> tuple[str, ...]:
    """The arguments of a case, one line each."""
    return tuple(f"{name} = {numbers(plain(value))}" for name, value in zip(exercise.case_names, case, strict=True))


def todo(exercise: Exercise) -> Verdict:
    sentence = f"Nothing to check yet: write `{exercise.name}` where the `...` stands, and end with `return`."
    return wrong(exercise, sentence, kind="todo")


def wrong(exercise: Exercise, sentence: str, details: tuple = (), kind: str = "wrong", mistake: Mistake | None = None):
    """The verdict with this sentence, and where there is help."""
    return Verdict(kind, sentence, details, f'Stuck? `check.hint("{exercise.name}")`', mistake)
