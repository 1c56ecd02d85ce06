"""Run a student's function so that the notebook goes on whatever the function does.

The function runs in a thread, which can be stopped in the same way in a Jupyter kernel on Linux, macOS and Windows:
Python can raise an exception in another thread. `TimeUp` is raised there repeatedly until an endless loop ends.
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

PATIENCE = 1.0  # seconds during which TimeUp is raised again in a loop that catches every exception
LONGEST_PRINT = 500  # characters of a function's prints that are kept


class TimeUp(SystemExit):
    """Not an `Exception`, so that `except Exception` does not catch it; a thread that ends with it prints nothing."""


@dataclass
class GuardedRun:
    """What the function did, case by case, up to the first case that raised an error or took too long."""

    answers: list[Plain] = field(default_factory=list)
    error: BaseException | None = None
    changed: tuple[int, int] | None = None  # (case, index of the argument) of the first argument changed in place
    out_of_time: bool = False
    still_runs: bool = False  # the thread could not be stopped
    printed: str = ""

    @property
    def case(self) -> int:
        """The case at which it ended, if it ended early."""
        return len(self.answers)


class _Printed(io.StringIO):
    """Keeps only the beginning, so that an endless loop that prints does not fill the memory."""

    def write(self, text: str) -> int:
        room = LONGEST_PRINT - self.tell()
        super().write(text[: max(room, 0)])
        return len(text)


def run(function: Callable, cases: list[tuple], seconds: float) -> GuardedRun:
    """Call function(*arguments) for each case, with copies of the arguments, for at most `seconds` in all."""
    report, printed = GuardedRun(), _Printed()
    worker = threading.Thread(target=_work, args=(function, cases, report), daemon=True)
    with contextlib.redirect_stdout(printed):
        worker.start()
        try:
            _wait(worker, seconds)
            report.out_of_time = worker.is_alive()
        finally:  # also when the notebook's stop button interrupts the waiting
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
    except BaseException as error:  # also SystemExit, which exit() raises
        report.error = error


def _wait(worker: threading.Thread, seconds: float) -> None:
    """Join in short steps, since on Windows a join cannot be interrupted."""
    end = time.monotonic() + seconds
    while worker.is_alive() and time.monotonic() < end:
        worker.join(0.05)


def _stop(worker: threading.Thread) -> bool:
    """Raise TimeUp in the worker until it ends. Returns whether it has ended."""
    end = time.monotonic() + PATIENCE
    while worker.is_alive() and time.monotonic() < end:
        ctypes.pythonapi.PyThreadState_SetAsyncExc(ctypes.c_ulong(worker.ident), ctypes.py_object(TimeUp))
        worker.join(0.01)
    return not worker.is_alive()


def where(error: BaseException, function: Callable) -> str:
    """The student's line that raised the error, as in "line 4, `return x + y`"; empty if none of theirs did."""
    code = getattr(function, "__code__", None)
    frames = [f for f in traceback.extract_tb(error.__traceback__) if code and f.filename == code.co_filename]
    if not frames:
        return ""
    text = linecache.getline(frames[-1].filename, frames[-1].lineno).strip()
    return f"line {frames[-1].lineno}" + (f", `{text}`" if text else "")
