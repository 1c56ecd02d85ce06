"""Judge a student's answer to an exercise: it is right, or a sentence says what is wrong with it.

An answer passes if it is right in every case. Otherwise the first of these that applies is reported: it is not written
yet, is no function, takes other arguments, returns nothing, takes too long, raises an error, changes its arguments, is
a mistake that the exercise knows, has a wrong type or shape, is NaN, differs from call to call, or is wrong in a case
that is shown.

The answer runs in a process of its own (`guard.py`); it is compared here, with values that only our code has made.
"""

import dis
import functools
import signal
import warnings
from collections.abc import Callable, Iterable
from copy import deepcopy
from dataclasses import replace

import numpy as np

from bootcourse.course import guard
from bootcourse.course.exercise import Exercise, Mistake, NotAsAsked
from bootcourse.course.values import (
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


def judge(exercise: Exercise, answer: Callable) -> Verdict:
    """The verdict on a student's function. An error in the function is part of the verdict and is not raised."""
    if does_nothing(answer):  # an untouched stub needs no process
        return todo(exercise)
    return judge_any(exercise, answer)


def judge_source(exercise: Exercise, source: str, seconds: float | None = None) -> Verdict:
    """The verdict on a text that defines the function, for instance a cell of a notebook that was handed in.

    The text is executed only in the process that also runs the function (see `guard.py` for what is guarded), within
    the same `seconds` (the exercise's own if None). Put the imports and the helpers that the function needs before it
    in the same text. A text that cannot be executed, or does not define the function, gets a verdict, too: no text
    raises an error here. Texts can be judged one after the other in one process of yours: a warm check takes some
    hundredths of a second. `guard.stop()` ends the process that runs them, which your own process's end does as well.
    """
    return judge_any(exercise if seconds is None else limited(exercise, seconds), source)


@functools.lru_cache(maxsize=256)
def limited(exercise: Exercise, seconds: float) -> Exercise:
    return replace(exercise, seconds=seconds)


def judge_any(exercise: Exercise, answer: Callable | str) -> Verdict:
    report = guard.run(exercise, answer)
    cases = exercise.all_arguments
    verdict = ended_early(exercise, answer, report, cases) or judge_answers(exercise, answer, report, cases)
    if report.printed and not verdict.passed:
        verdict = replace(verdict, details=(*verdict.details, f"printed: {report.printed}"))
    return verdict


def does_nothing(answer) -> bool:
    """Is it a function whose body is `...`, `pass`, a docstring or `return None`, or a class of such functions?"""
    if isinstance(answer, type):
        return all(does_nothing(part) for part in vars(answer).values() if callable(part))
    code = getattr(answer, "__code__", None)
    idle = ("RESUME", "NOP", "COPY_FREE_VARS", "LOAD_CONST", "RETURN_CONST", "RETURN_VALUE")
    return code is not None and all(
        step.opname in idle and (not step.opname.endswith("_CONST") or step.argval is None)
        for step in dis.get_instructions(code)
    )


def ended_early(
    exercise: Exercise, answer: Callable | str, report: guard.GuardedRun, cases: list[tuple]
) -> Verdict | None:
    """The verdict on a function that did not answer every case, or changed its arguments; None if it did well."""
    if report.refused:
        return wrong(exercise, report.refused)
    empty = [number for number, answer in enumerate(report.answers) if answer.kind == "NoneType"]
    if empty[:1] == [0] or (report.error and report.error["todo"]):
        return todo(exercise)
    if empty:
        sentence = "Your function returns nothing in this case: look for a branch without `return`."
        return wrong(exercise, sentence, given(exercise, cases[empty[0]]))
    here = given(exercise, cases[min(report.case, len(cases) - 1)])
    if report.error is not None:
        return wrong(exercise, error_in_words(report, answer), here)
    if report.ended != "":
        return wrong(exercise, end_in_words(report.ended, exercise.seconds), here)
    if report.changed is not None:
        argument = exercise.case_names[report.changed[1]]
        return wrong(exercise, f"Your function changes its argument `{argument}`, which the caller still needs: "
                               "compute a new value instead of writing into it.")  # fmt: skip
    return None


def error_in_words(report: guard.GuardedRun, answer: Callable | str) -> str:
    """One sentence about an error that the function raised."""
    error, place = report.error, guard.where(report, answer)
    if error["kind"] == NotAsAsked.__name__:
        return error["text"]
    where = f" in {place}" if place else ""
    if error["kind"] == "MemoryError" or "can't allocate memory" in error["text"]:
        return f"Your function asks for more memory{where} than the {guard.MEMORY / 2**30:.0f} GiB that a check allows."
    what = f"{error['kind']}: {error['text']}".strip(" :").rstrip(".")
    return f"Your function raises an error{where}: {what}."


def end_in_words(ended: str | int, seconds: float) -> str:
    """One sentence about a process that ended before the function did."""
    if ended == "time":
        return f"Your function was stopped after {seconds:g} s: look for a loop that never ends."
    if ended == "size":
        return "Your function returns too much to compare: look for a list or an array that is far too large."
    if ended < 0:
        name = signal.Signals(-ended).name if -ended in set(signal.Signals) else f"signal {-ended}"
        return (f"Your function made Python crash ({name}): look for a recursion without an end, or for compiled code "
                "that gets arguments of a wrong size.")  # fmt: skip
    return f"Your function ended Python itself (exit code {ended}): take out `os._exit` and the like."


def judge_answers(exercise: Exercise, answer: Callable | str, report: guard.GuardedRun, cases: list[tuple]) -> Verdict:
    """The verdict on the answers to all cases: first the values, then the slopes."""
    if not exercise.slopes:
        return judge_values(exercise, answer, report, cases, list)
    verdict = judge_values(exercise, answer, report, cases, lambda answers: [each.data[0] for each in answers])
    return (verdict.passed and judge_slopes(exercise, report.answers, cases)) or verdict


def judge_values(
    exercise: Exercise, answer: Callable | str, report: guard.GuardedRun, cases: list[tuple], of: Callable
) -> Verdict:
    """The verdict on the values; of(answers) picks them out."""

    def makes(mistake: Mistake, mine: list[Plain]) -> bool:
        theirs = (fitted(a, right) for a, right in zip(of(outcomes(exercise, mistake.answer)), rights, strict=True))
        return all_same(mine, theirs, exercise.tolerance)  # which ends at the first case that differs

    rights = of(outcomes(exercise, exercise.solution))
    mine = [fitted(a, right) for a, right in zip(of(report.answers), rights, strict=True)]
    fails = [k for k, (a, right) in enumerate(zip(mine, rights, strict=True)) if not same(a, right, exercise.tolerance)]
    if not fails:
        return Verdict(
            "passed", f"Right. Your `{exercise.name}` agrees in all {len(cases)} cases, corner cases included."
        )
    known = [mistake for mistake in exercise.mistakes if makes(mistake, mine)]
    if known:
        whole = [m for m in known if all_same(report.answers, outcomes(exercise, m.answer), exercise.tolerance)]
        return wrong(exercise, [*whole, *known][0].says)
    case = fails[0]
    comparable = [like(a, right) and same_shape(a, right) for a, right in zip(mine, rights, strict=True)]
    if exercise.explain and all(comparable):
        return wrong(exercise, exercise.explain(cases, [a.data for a in mine]))
    if comparable[case] and changes_its_mind(exercise, answer, len(cases)):
        sentence = (
            "For the same arguments your function answers differently each time: it draws at random, or keeps a value "
            "from one call to the next."
        )
        return wrong(exercise, sentence, given(exercise, cases[case]))
    return wrong(exercise, *unknown_mistake(exercise, cases[case], mine[case], rights[case], report.warned.get(case)))


def judge_slopes(exercise: Exercise, answers: list[Plain], cases: list[tuple]) -> Verdict | None:
    """The verdict on a loss whose values are right; None if its slopes are right, too."""
    rights = outcomes(exercise, exercise.solution)
    for mistake in exercise.mistakes:
        theirs = outcomes(exercise, mistake.answer)
        if not all_same(theirs, rights, exercise.tolerance) and all_same(answers, theirs, exercise.tolerance):
            return wrong(exercise, mistake.says)
    but = f"Your `{exercise.name}` has the right value, but"
    for place, name in enumerate(exercise.slopes, 1):
        pairs = [(a.data[place], right.data[place]) for a, right in zip(answers, rights, strict=True)]
        fails = [case for case, pair in enumerate(pairs) if not same(*pair, exercise.tolerance)]
        if not fails:
            continue
        mine, right = pairs[fails[0]]
        if mine.kind == "text":
            why = "use torch's functions" if "numpy" in mine.data else " ".join(mine.data.split()).rstrip(".")
            return wrong(exercise, f"{but} no gradient can pass through it: {why}.")
        if not any(right.data.any() for _, right in pairs):
            what = f"a gradient flows into `{name}`, which must not change: use `{name}.detach()`."
            return wrong(exercise, f"{but} {what}")
        if not any(mine.data.any() for mine, _ in pairs):
            what = f"no gradient reaches `{name}`: look for `.detach()`, `.item()`, `float()` or NumPy."
            return wrong(exercise, f"{but} {what}")
        details = (*given(exercise, cases[fails[0]]), f"your slope = {numbers(mine)}", f"right = {numbers(right)}")
        what = "is wrong: look for a part that is detached."
        if has_nan(mine):
            what = "is not a number (NaN): is something infinite, perhaps in a branch that `torch.where` drops?"
        return wrong(exercise, f"{but} its slope in `{name}` {what}", details)
    return None


def all_same(answers: list[Plain], others: Iterable[Plain], tolerance: float) -> bool:
    return all(same(a, other, tolerance, nan_too=True) for a, other in zip(answers, others, strict=True))


def changes_its_mind(exercise: Exercise, answer: Callable | str, cases: int) -> bool:
    """Does it answer differently when the same process runs all cases twice? (One case could agree by chance.)"""
    answers = guard.run(exercise, answer, times=2).answers
    return len(answers) == 2 * cases and not all_same(answers[:cases], answers[cases:], exercise.tolerance)


def unknown_mistake(
    exercise: Exercise, case: tuple, mine: Plain, right: Plain, warned: str | None = None
) -> tuple[str, tuple]:
    """(sentence, details) about a wrong answer that is none of the exercise's known mistakes."""
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
    small = max(mine.data.size, right.data.size) <= 36 if place else True
    values = (numbers(mine), numbers(right)) if small else (f"{mine.data[place]:.6g}", f"{right.data[place]:.6g}")
    details = (*given(exercise, case), f"yours = {values[0]}", f"right = {values[1]}")
    return f"Not right yet: here your answer and the right one differ{at}.", details


@functools.lru_cache(maxsize=1024)
def outcomes(exercise: Exercise, function: Callable) -> list[Plain]:
    """The answers of a solution or of a known mistake to all cases."""
    with np.errstate(all="ignore"), warnings.catch_warnings():
        warnings.simplefilter("ignore")
        return [plain(exercise.answers(function, *deepcopy(case))) for case in exercise.all_arguments]


def given(exercise: Exercise, case: tuple) -> tuple[str, ...]:
    """The arguments of a case, one line each."""
    return tuple(f"{name} = {numbers(plain(value))}" for name, value in zip(exercise.case_names, case, strict=True))


def help_for(exercise: Exercise) -> str:
    return f'Stuck? `check.hint("{exercise.name}")`'


def todo(exercise: Exercise) -> Verdict:
    sentence = f"Nothing to check yet: write `{exercise.name}` where the `...` stands, and end with `return`."
    return Verdict("todo", sentence, footer=help_for(exercise))


def wrong(exercise: Exercise, sentence: str, details: tuple[str, ...] = ()) -> Verdict:
    return Verdict("wrong", sentence, details, help_for(exercise))
