"""Run a student's function so that whatever it does, the notebook goes on.

It runs in a thread of its own, because that is the one way to stop an endless loop that works the same
in a Jupyter kernel on Linux, macOS and Windows: Python can raise an exception in another thread, and
`TimeUp` is raised there again and again until the loop gives way.
"""

import contextlib
import copy
import ctypes
import io
import linecache
import threading
import time
import traceback
from collections.abc import Callable
from dataclasses import dataclass, field

from bootcourse.lessons.values import Plain, plain, same

PATIENCE = 1.0  # seconds in which a loop that catches everything may still give way
LONGEST_PRINT = 500  # characters of what a function prints that are kept


class TimeUp(SystemExit):
    """Not an Exception, so that `except Exception` lets it pass; a thread that ends with it says nothing."""


@dataclass
class GuardedRun:
    """What happened, case by case. The lists end with the first case that raised or took too long."""

    answers: list[Plain] = field(default_factory=list)
    error: BaseException | None = None
    changed: tuple[int, int] | None = None  # (case, place of the argument) that was changed in place
    out_of_time: bool = False
    still_runs: bool = False  # it could not be stopped
    printed: str = ""

    @property
    def case(self) -> int:
        """The case that was being run when it ended early."""
        return len(self.answers)


class _Printed(io.StringIO):
    """Keeps the beginning, so that an endless loop that prints fills no memory."""

    def write(self, text: str) -> int:
        room = LONGEST_PRINT - self.tell()
        super().write(text[: max(room, 0)])
        return len(text)


def run(function: Callable, cases: list[tuple], seconds: float) -> GuardedRun:
    """Call function(*arguments) for each case, on copies, for at most `seconds` in all."""
    report, printed = GuardedRun(), _Printed()
    worker = threading.Thread(target=_work, args=(function, cases, report), daemon=True)
    with contextlib.redirect_stdout(printed):
        worker.start()
        try:
            _wait(worker, seconds)
            report.out_of_time = worker.is_alive()
        finally:  # the ■ button interrupts the waiting, and ends the worker, too
            report.still_runs = not _stop(worker)
    report.printed = printed.getvalue().strip()
    return report


def _work(function: Callable, cases: list[tuple], report: GuardedRun) -> None:
    try:
        for number, arguments in enumerate(cases):
            given = copy.deepcopy(arguments)
            answer = plain(function(*given))
            for place, (before, after) in enumerate(zip(arguments, given, strict=True)):
                if report.changed is None and not same(plain(after), plain(before), nan_too=True):
                    report.changed = (number, place)
            report.answers.append(answer)
    except BaseException as error:  # exit() and the like, too
        report.error = error


def _wait(worker: threading.Thread, seconds: float) -> None:
    """Join in short steps: on Windows a longer one cannot be interrupted."""
    end = time.monotonic() + seconds
    while worker.is_alive() and time.monotonic() < end:
        worker.join(0.05)


def _stop(worker: threading.Thread) -> bool:
    """Raise TimeUp in the worker until it ends. False if it does not."""
    end = time.monotonic() + PATIENCE
    while worker.is_alive() and time.monotonic() < end:
        ctypes.pythonapi.PyThreadState_SetAsyncExc(ctypes.c_ulong(worker.ident), ctypes.py_object(TimeUp))
        worker.join(0.01)
    return not worker.is_alive()


def where(error: BaseException, function: Callable) -> str:
    """The student's own line that raised, as in "line 4, `return x + y`"; empty if there is none."""
    code = getattr(function, "__code__", None)
    frames = [f for f in traceback.extract_tb(error.__traceback__) if code and f.filename == code.co_filename]
    if not frames:
        return ""
    text = linecache.getline(frames[-1].filename, frames[-1].lineno).strip()
    return f"line {frames[-1].lineno}" + (f", `{text}`" if text else "")
