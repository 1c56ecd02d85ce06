"""Run an answer in a process of its own, so that the notebook goes on whatever the function does.

On Linux the process is a fork of a clean, warm one (`multiprocessing`'s forkserver), elsewhere a new one; one waits
ahead for the next check. Nothing that the function changes there outlives the check; endless loops, crashes,
`os._exit`, threads and prints end with it. What comes back is a message of plain numbers, never a pickle.

When the time is over, the process says where it is: `Report` holds the line, and how much of the time it computed.

What is guarded: time, everywhere. Memory, on Linux only. Files, network and other processes, only where `SHUT_IN` is
set, as the grading of a class does: in a notebook the function runs with your rights.
"""

import atexit
import contextlib
import ctypes
import faulthandler
import functools
import inspect
import io
import itertools
import multiprocessing
import os
import pickle
import re
import signal
import sys
import threading
import time
import traceback
import types
import warnings
from collections.abc import Callable, Iterator
from multiprocessing import forkserver

import cloudpickle
import msgspec
import numpy as np
import torch

from bootcourse.course.exercise import Exercise, NotAsAsked
from bootcourse.course.library import same_content
from bootcourse.course.stopped import Notes, Stopped
from bootcourse.course.values import MANY, Plain, decode_array, encode_array, plain, same, sendable
from bootcourse.errors import BootcourseError

FORKS = sys.platform == "linux"  # on macOS system libraries may break in a fork, and Windows has none
MEMORY = 2 * 2**30  # bytes that a function may use
START = 60  # seconds in which a process has to be ready
WALL = 7  # seconds after which a check is over, its start included, if that takes under 3 s and the limit is no longer
LEAST = 4  # seconds that a function has in any case: it may have to load a library first
SLACK = 5  # seconds after which the process ends by itself
LONGEST_PRINT = 500  # characters of a function's prints that are shown
LONGEST_MESSAGE = 2**26  # bytes
SENDING = 2  # seconds in which a message has to come whole, once it has begun
WHERE = getattr(signal, "SIGUSR1", None)  # on it the process says in which line it is; Windows has no such signal
PR_SET_PDEATHSIG = 1  # of Linux's prctl: the signal that a process gets when its parent ends
READY = b"ready"
PRELOADED = ["bootcourse.course.preloaded"]
SHUT_IN: Callable | None = None  # the process calls it before it runs an answer
SOURCE = "your answer"  # the file name of a function that came as text
PATH = re.compile(r"(?<![\w./])(?:[A-Za-z]:)?(?:[\\/][^\\/\s'\"():,;]+)+[\\/]([^\\/\s'\"():,;]+)")
NOT_SENT = (
    "Your function uses something that exists only in the notebook's own process, such as an open file, a widget or a "
    "lock: make it inside the function ({})."
)


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


# Here -------------------------------------------------------------------------------------------------


class Pickler(cloudpickle.Pickler):
    """Takes cached functions, too, and tensors in a tenth of the time."""

    def reducer_override(self, thing):
        if isinstance(thing, functools._lru_cache_wrapper):
            return cached_again, (thing.__wrapped__, thing.cache_parameters())
        if type(thing) is torch.Tensor and not thing.requires_grad:
            return torch.from_numpy, (thing.numpy(),)
        return super().reducer_override(thing)


def cached_again(function: Callable, parameters: dict) -> Callable:
    return functools.lru_cache(**parameters)(function)


def pickled(*things) -> bytes:
    stream = io.BytesIO()
    Pickler(stream).dump(things)
    return stream.getvalue()


@functools.lru_cache(maxsize=256)
def packed(exercise: Exercise) -> bytes:
    """What the process needs of an exercise."""
    asked = exercise.name, exercise.call, len(exercise.arguments)
    return pickled(exercise.outcome, exercise.all_arguments, *asked, exercise.library)


_one_at_a_time = threading.Lock()
_waiting: list["Process"] = []  # the process that waits ahead


def run(
    exercise: Exercise, answer: Callable | str, seconds: float, times: int = 1, begin: float | None = None
) -> Report:
    """Call a function, or the one that a source text defines, for every case, `times` over, in a process of its own.

    begin: when the check began, by the monotonic clock; now if None. Raises BootcourseError where the process cannot
    be started.
    """
    begin = time.monotonic() if begin is None else begin
    try:
        job = pickled(answer, times, seconds)
    except Exception as error:  # whatever an object's own pickling raises
        return Report(refused=NOT_SENT.format(PATH.sub(r"\1", " ".join(str(error).split()))[:200]))
    with _one_at_a_time:
        process = _waiting.pop() if _waiting else Process()
        if not process.process.is_alive():
            process = Process()
        try:
            return process.work(packed(exercise), job, seconds, begin)
        finally:  # also after the notebook's stop button
            process.end()
            with contextlib.suppress(BootcourseError):  # the next check says so
                _waiting.append(Process())


def get_ready() -> None:
    """Begin to load what the first check needs, and do not wait for it."""
    if FORKS:
        forkserver.set_forkserver_preload(PRELOADED)
        forkserver.ensure_running()


class Process:
    """A process that waits for one job."""

    def __init__(self):
        context = multiprocessing.get_context("forkserver" if FORKS else "spawn")
        context.set_forkserver_preload(PRELOADED)
        self.connection, theirs = context.Pipe()
        self.notes, written = context.Pipe(duplex=False)
        self.process = context.Process(target=serve, args=(theirs, written, SHUT_IN), daemon=True)
        main, sys.modules["__main__"] = sys.modules["__main__"], types.ModuleType("__main__")
        try:  # `multiprocessing` would run the script in `__main__` again
            self.process.start()
        except (OSError, EOFError) as error:
            raise broken(error) from None
        finally:
            sys.modules["__main__"] = main
        theirs.close()
        written.close()

    def work(self, exercise: bytes, job: bytes, seconds: float, begin: float) -> Report:
        """The report on a job. begin: when the check began."""
        try:
            self.connection.send_bytes(exercise)
            if not self.connection.poll(START) or self.connection.recv_bytes() != READY:
                raise broken("it did not answer")
            self.connection.send_bytes(job)
            seconds = time_left(seconds, time.monotonic() - begin)
            if not self.connection.poll(seconds):
                return Report(ended="time", stopped=Stopped.of(self.process.pid, self.notes, seconds))
            report = self.report()
            report.ended = ""  # this is said here alone
            return report
        except (EOFError, OSError) as error:  # it ended, or the function wrote
            self.process.join(1)
            return Report(ended="size" if "bad message length" in str(error) else self.process.exitcode or 0)

    def report(self) -> Report:
        """The report that comes. Raises EOFError or OSError if none comes, or what comes is none."""
        late = threading.Timer(SENDING, self.kill)  # the function may send a part, and wait
        late.start()
        try:
            return decoder.decode(self.connection.recv_bytes(LONGEST_MESSAGE))
        except (msgspec.MsgspecError, ArithmeticError, MemoryError, RecursionError) as error:
            raise EOFError(f"no report: {error}") from None
        finally:
            late.cancel()

    def kill(self) -> None:
        """Kill it, with all processes that it started."""
        with contextlib.suppress(ProcessLookupError, PermissionError, AttributeError):  # AttributeError: Windows
            os.killpg(self.process.pid, signal.SIGKILL)
        self.process.kill()

    def end(self) -> None:
        """Kill it, and close what led to it."""
        self.kill()
        self.process.join(1)
        self.connection.close()
        self.notes.close()


def time_left(seconds: float, waited: float) -> float:
    """The seconds that a function has, whose process took `waited` seconds to start."""
    return seconds if seconds > WALL else min(seconds, max(LEAST, WALL - waited))


def broken(why: object) -> BootcourseError:
    return BootcourseError(
        f"The process that runs your function could not be started ({why}). "
        "Restart the kernel; if that does not help, `bootcourse doctor` says what is wrong."
    )


@atexit.register
def stop() -> None:
    """End the process that waits; the next check starts another."""
    while _waiting:
        _waiting.pop().end()


# There ------------------------------------------------------------------------------------------------


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
    with contextlib.suppress(EOFError):  # nobody needs it any more
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
            pairs = enumerate(zip(map(plain, copy), map(plain, case), strict=True))
            changed = next(((number, place) for place, pair in pairs if not same(*pair, nan_too=True)), None)
            report.changed = report.changed or changed
    except BaseException as error:  # also SystemExit and KeyboardInterrupt
        report.error = in_words(error, answer)
        if called is not None and error is not called.error and is_ours(error, report.error):
            report.is_ours, report.refused = True, why_no_array(called.value)
    report.printed = PATH.sub(r"\1", sendable(printed.getvalue()))
    return report


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
