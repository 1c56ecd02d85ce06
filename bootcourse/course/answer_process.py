"""In the process of an answer: wait for an exercise and an answer, call it in every case, and report.

`runner.py` starts the process and reads the report, a message of plain numbers. Nothing that the function changes here
outlives the check.
"""

import contextlib
import ctypes
import faulthandler
import inspect
import io
import itertools
import os
import pickle
import re
import signal
import sys
import time
import traceback
import types
import warnings
from collections.abc import Callable, Iterator

import msgspec
import numpy as np
import torch

from bootcourse.course.exercise import NotAsAsked
from bootcourse.course.library import same_content
from bootcourse.course.stopped import Notes, Stopped
from bootcourse.course.values import MANY, Plain, decode_array, encode_array, plain, same, sendable

FORKS = sys.platform == "linux"  # on macOS system libraries may break in a fork, and Windows has none
MEMORY = 2 * 2**30  # bytes that a function may use
START = 60  # seconds in which the process has to be ready, and after which it is killed
SLACK = 5  # seconds after its time is over, after which the process ends by itself
LONGEST_PRINT = 500  # characters of a function's prints that are shown
WHERE = getattr(signal, "SIGUSR1", None)  # on it the process says in which line it is; Windows has no such signal
PR_SET_PDEATHSIG = 1  # of Linux's prctl: the signal that a process gets when its parent ends
READY = b"ready"
SOURCE = "your answer"  # the file name of a function that came as text
PATH = re.compile(r"(?<![\w./])(?:[A-Za-z]:)?(?:[\\/][^\\/\s'\"():,;]+)+[\\/]([^\\/\s'\"():,;]+)")


class Report(msgspec.Struct):
    """What the function did, case by case, up to the first case that raised an error."""

    answers: list[Plain] = []
    refused: str = ""  # why it cannot be called at all
    error: tuple[str, str, int | None] | None = None  # (type, text, line of the student's file)
    is_ours: bool = False  # the error came out of our check, not out of the function
    library: str = ""  # the library's function of the same content, if the function calls it
    changed: tuple[int, int] | None = None  # (case, index of the argument) of the first argument changed in place
    printed: str = ""
    ended: str | int = ""  # "time", "size", or how the process ended before its time: an exit code, minus a signal
    stopped: Stopped | None = None  # if it ended by "time"


def serve(connection, notes, shut_in: Callable | None) -> None:
    """In the process: wait for an exercise and an answer, and report."""
    nowhere = os.open(os.devnull, os.O_RDWR)
    for descriptor in (0, 1, 2):
        os.dup2(nowhere, descriptor)  # compiled code, too, prints nowhere
    if FORKS:
        os.setsid()  # the notebook's stop button does not reach it
        first, second = sorted((connection.fileno(), notes.fileno()))
        for begin, end in (3, first), (first + 1, second), (second + 1, 1024):
            os.closerange(begin, end)  # what belongs to `multiprocessing`
        ctypes.CDLL(None).prctl(PR_SET_PDEATHSIG, signal.SIGKILL)
        faulthandler.register(WHERE, notes.fileno())
    if shut_in is not None:
        shut_in()
    torch.set_num_threads(1)
    with contextlib.suppress(EOFError):  # the other end is closed: no check will come
        exercise = connection.recv_bytes()
        pickle.loads(exercise)  # imports what it needs
        connection.send_bytes(READY)
        job = connection.recv_bytes()
        if FORKS:
            limit_memory()
        connection.send_bytes(encoder.encode(work(exercise, job, Notes(notes.fileno() if FORKS else None))))
        time.sleep(START)  # it is killed: nothing that the function left to do at the end is done


def limit_memory() -> None:
    import resource

    with open("/proc/self/statm") as file:
        size = int(file.read().split()[0]) * resource.getpagesize()
    resource.setrlimit(resource.RLIMIT_AS, (size + MEMORY, size + MEMORY))


class Printed(io.StringIO):
    """The beginning of what is printed."""

    def write(self, text: str) -> int:
        super().write(text[: LONGEST_PRINT - self.tell()])
        return len(text)


class Called:
    """The answer, as the exercise's `run` calls it: it knows the last value and the last error that came out of it.

    An iterator that the answer returns, such as a generator, becomes a list.
    """

    def __init__(self, answer: Callable):
        self.answer, self.value, self.error = answer, None, None

    def __call__(self, *arguments, **named):
        try:
            value = self.answer(*arguments, **named)
            is_lazy = isinstance(value, Iterator) and not isinstance(value, io.IOBase)
            self.value = list(itertools.islice(value, MANY + 1)) if is_lazy else value
            return self.value
        except BaseException as error:
            self.error = error
            raise


def work(exercise: bytes, job: bytes, notes: Notes | None = None) -> Report:
    """What the student's function answers in each case, and which argument it changed. notes: of its progress."""
    report, answer, called = Report(), None, None
    outcome, cases, *asked, library = pickle.loads(exercise)
    sys.stdout = sys.stderr = printed = Printed()
    try:
        answer, times, seconds = pickle.loads(job)
        faulthandler.dump_traceback_later(seconds + SLACK, exit=True, file=open(os.devnull, "w"))
        warnings.simplefilter("ignore")
        if isinstance(answer, str):
            answer = defined_in(answer, asked[0])
        report.refused, called = why_not_called(answer, *asked), Called(answer)
        if not report.refused:
            report.library = same_content(answer, library)
        copies = [case for _ in range(times) for case in pickle.loads(exercise)[1]]
        for number, (case, copy) in enumerate(zip(cases * times, copies, strict=True) if not report.refused else ()):
            if notes is not None:
                notes.begin_case()
            report.answers.append(plain(outcome(called, *copy)))
            places = enumerate(zip(copy, case, strict=True))
            changed = next(((number, place) for place, pair in places if not unchanged(*pair)), None)
            report.changed = report.changed or changed
    except BaseException as error:  # also SystemExit and KeyboardInterrupt
        report.error = in_words(error, answer)
        if called is not None and error is not called.error and is_ours(error, report.error):
            report.is_ours, report.refused = True, why_no_array(called.value)
    report.printed = PATH.sub(r"\1", sendable(printed.getvalue()))
    return report


def unchanged(argument, before) -> bool:
    """Is an argument what it was before the answer was called? NaN equals NaN."""
    if type(argument) is type(before):  # what most arguments are is compared as it is: a tenth of the time
        if isinstance(before, (int, float, str)) and argument == before:
            return True
        if type(before) is tuple and len(argument) == len(before):
            return all(map(unchanged, argument, before))
        if type(before) in (np.ndarray, torch.Tensor) and argument.dtype == before.dtype:
            if argument.shape == before.shape and bool((argument == before).all()):
                return True
    return same(plain(argument), plain(before), nan_too=True)


def is_ours(error: BaseException, said: tuple[str, str, int | None]) -> bool:
    """Did our own code raise this error, which did not come out of the answer, on what the answer had returned?"""
    theirs = (NotAsAsked, NotImplementedError, MemoryError, SystemExit, KeyboardInterrupt)
    return said[2] is None and not isinstance(error, theirs) and "can't allocate memory" not in said[1]


def why_no_array(value) -> str:
    """Why NumPy can make no array of what the answer returned; "" if it can, and our own code is to blame."""
    try:
        np.asarray(value)
    except Exception as error:  # whatever an object's own methods raise
        return f"Your function returns {plain(value).words}, of which NumPy makes no array ({type(error).__name__})."
    return ""


def defined_in(source: str, name: str):
    """The function that a source text defines; the sentence about it if it defines none of that name."""
    space = {"__name__": "__main__"}
    exec(compile(source, SOURCE, "exec"), space)
    return space.get(name, f"There is no function `{name}` in this text.")


def why_not_called(answer, name: str, call: str, arguments: int) -> str:
    """Why this cannot be called as the exercise asks; "" if it can."""
    if isinstance(answer, str):
        return answer
    if not callable(answer):
        return f"Give the check your function itself, `check.{name}({name})`: this is {plain(answer).words}."
    with contextlib.suppress(ValueError):  # a function written in C may have no signature
        signature = inspect.signature(answer)
        try:
            signature.bind(*[None] * arguments)
        except TypeError:
            return f"Your function takes {signature}: the check calls `{call}`."
    return ""


def in_words(error: BaseException, answer) -> tuple[str, str, int | None]:
    """An error's type, its text without paths of this machine, and the last line of the student's file it passed."""
    try:
        text = PATH.sub(r"\1", sendable(" ".join(str(error).split())))[:LONGEST_PRINT]
    except BaseException:  # an error may come with a text that cannot be made
        text = ""
    if isinstance(error, SyntaxError) and error.filename == SOURCE:
        return type(error).__name__, error.msg, error.lineno
    lines = [frame.lineno for frame in traceback.extract_tb(error.__traceback__) if frame.filename == file_of(answer)]
    return sendable(type(error).__name__)[:80], text, lines[-1] if lines else None


def file_of(answer) -> str:
    """The file in which a function or a class is written; SOURCE if that is not known."""
    parts = vars(answer).values() if isinstance(answer, type) else [answer]
    return next((code.co_filename for part in parts if (code := code_of(part))), SOURCE)


def code_of(function) -> types.CodeType | None:
    """The code of a function, also of one that a cache holds."""
    return getattr(inspect.unwrap(function) if callable(function) else None, "__code__", None)


encoder = msgspec.msgpack.Encoder(enc_hook=encode_array)
decoder = msgspec.msgpack.Decoder(Report, dec_hook=decode_array)
