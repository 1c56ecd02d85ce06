"""Did a student's function answer the cases of its exercise at all? If not, a sentence says what happened.

It is not written yet, is no function, ended its process, raised an error, returned nothing, or changed its arguments.
`judge.py` asks this first, and then whether the answers are right.
"""

import dis
import inspect
import linecache
import re
import signal
from collections.abc import Callable

from bootcourse.course.answer_process import MEMORY, Report, code_of, file_of
from bootcourse.course.exercise import Exercise, NotAsAsked
from bootcourse.course.stopped import Stopped
from bootcourse.course.values import numbers, plain
from bootcourse.course.verdict import Verdict

LONGEST = 2000  # characters of a line that a verdict shows
FORGED = "Your function ended its own check: return the answer instead."  # it sent a report of its own


def does_nothing(answer) -> bool:
    """Is it a function whose body is `...`, `pass`, a docstring or `return None`, or a class of such functions?"""
    if isinstance(answer, type):
        return all(does_nothing(part) for part in vars(answer).values() if callable(part))
    code = code_of(answer)
    idle = ("RESUME", "NOP", "COPY_FREE_VARS", "LOAD_CONST", "RETURN_CONST", "RETURN_VALUE")
    return code is not None and all(
        step.opname in idle and (not step.opname.endswith("_CONST") or step.argval is None)
        for step in dis.get_instructions(code)
    )


def is_unfinished(report: Report, answer: Callable | str) -> bool:
    """Does it return nothing and still have the `...` of a stub, or raise NotImplementedError?"""
    if report.error is not None and report.error[0] == NotImplementedError.__name__:
        return True
    try:
        text = answer if isinstance(answer, str) else inspect.getsource(answer)
    except (OSError, TypeError):
        return False
    returns_nothing = report.answers[:1] and report.answers[0].kind == "NoneType"
    return bool(returns_nothing) and re.search(r"^\s*(\.\.\.|pass)\s*$", text, re.M) is not None


def not_answered(exercise: Exercise, answer: Callable | str, report: Report) -> Verdict | None:
    """The verdict on a function that did not answer every case, or changed its arguments; None if it did well."""
    cases, answers, parts = exercise.all_arguments, report.answers, 1 + len(exercise.slopes)
    nothing = [case for case, value in enumerate(answers) if value.kind == "NoneType"]
    if report.refused:
        return Verdict("wrong", report.refused)
    if report.error is not None and report.is_ours:
        return our_fault(exercise, f"{report.error[0]}: {report.error[1]}")
    if report.ended != "":
        return Verdict("did_not_run", end_in_words(report, answer, len(cases)))
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
    where = f" in {line_in_words(answer, line)}" if line is not None else ""
    if kind == "MemoryError" or "can't allocate memory" in text:
        limit = f"{MEMORY / 2**30:.0f} GiB"
        return f"Your function asks for more memory{where} than the {limit} that a check allows."
    return f"Your function raises an error{where}: {f'{kind}: {text}'.strip(' :').rstrip('.')}."


def line_in_words(answer: Callable | str, line: int) -> str:
    """A line of the student's text, with its number."""
    lines = answer.splitlines() if isinstance(answer, str) else linecache.getlines(file_of(answer))
    code = lines[line - 1].strip() if 0 < line <= len(lines) else ""
    return f"line {line}" + (f", `{code}`" if code else "")


def end_in_words(report: Report, answer: Callable | str, cases: int) -> str:
    """One sentence about a process that ended before the function did. cases: how many it had to answer."""
    ended = report.ended
    if ended == "time":
        return stop_in_words(report.stopped, answer, cases)
    if ended == "size":
        return "Your function returns or sends too much to compare: look for a list or an array that is far too large."
    if ended < 0 or ended == 255:  # 255: the process that started it has ended, too
        name = signal.Signals(-ended).name if -ended in set(signal.Signals) else f"signal {-ended}"
        return (f"Your function made Python crash ({name}): look for a recursion without an end, or for compiled code "
                "that gets arguments of a wrong size.")  # fmt: skip
    return f"Your function ended Python itself (exit code {ended}): take out `os._exit` and the like."


def stop_in_words(stopped: Stopped, answer: Callable | str, cases: int) -> str:
    """One sentence about a function that was stopped: it computed one case for ever, or all slowly, or it waited."""
    theirs = [line for file, line in stopped.frames if file == file_of(answer)]
    where = f", in {line_in_words(answer, theirs[0])}" if theirs else ""
    begin, seconds, computed = f"stopped after {stopped.seconds:.2g} s", stopped.seconds, stopped.computed
    if computed is None:
        return f"Too slow, {begin}: a right answer needs a fraction of that."
    if computed < 0.05 * seconds:
        return (f"Your function was {begin}, and computed hardly anything in them{where}: look for something that "
                "waits, such as `sleep` or `input`.")  # fmt: skip
    if computed < 0.6 * seconds:
        return (f"Too slow, {begin}, of which your function computed for only {computed:.2g} s{where}: it waits, or "
                "the computer is busy with other programs. Run the check again.")  # fmt: skip
    if stopped.is_endless:
        return (f"Too slow, {begin} in one of the {cases} cases{where}: look for a loop that never ends, or that takes "
                "far too many turns.")  # fmt: skip
    done = len(stopped.cases) - 1
    return (f"Too slow, {begin}: {done} of the {cases} cases were done{where}. A right answer needs a fraction of "
            "that: look for work that is done again and again.")  # fmt: skip


def given(exercise: Exercise, case: tuple) -> tuple[str, ...]:
    """The arguments of a case, one line each."""
    return tuple(f"{name} = {numbers(plain(value))}" for name, value in zip(exercise.case_names, case, strict=True))


def our_fault(exercise: Exercise, said: str) -> Verdict:
    sentence = (f"Our check of `{exercise.name}` broke off on this answer. That is our mistake and not yours: please "
                "send your answer, with the line below, to those who make the course.")  # fmt: skip
    return Verdict("broke", sentence, (said[:LONGEST],))
