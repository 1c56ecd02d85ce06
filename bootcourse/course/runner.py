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
import functools
import io
import multiprocessing
import os
import signal
import sys
import threading
import time
import types
from collections.abc import Callable
from multiprocessing import forkserver

import cloudpickle
import msgspec
import torch

from bootcourse.course.answer_process import FORKS, PATH, READY, START, Report, decoder, serve
from bootcourse.course.exercise import Exercise
from bootcourse.course.stopped import Stopped
from bootcourse.errors import BootcourseError

WALL = 7  # seconds after which a check is over, its start included, if that takes under 3 s and the limit is no longer
LEAST = 4  # seconds that a function has in any case: it may have to load a library first
LONGEST_MESSAGE = 2**26  # bytes
SENDING = 2  # seconds in which a message has to come whole, once it has begun
PRELOADED = ["bootcourse.course.preloaded"]
SHUT_IN: Callable | None = None  # the process calls it before it runs an answer
NOT_SENT = (
    "Your function uses something that exists only in the notebook's own process, such as an open file, a widget or a "
    "lock: make it inside the function ({})."
)


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
            late.join()  # or its thread outlives the check by a moment

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
