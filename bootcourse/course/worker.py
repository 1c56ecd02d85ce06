"""The process in which students' functions run: `guard.py` starts it. Nothing that they do there reaches the kernel.

It reads jobs from its input, pickles that the kernel made. On Linux it stays clean and warm: each job runs in a fork
of it, which ends with the job. (It has one thread, so that a fork is safe; in a kernel torch, numba, widgets and
training have several.) Elsewhere it runs one job and ends.

What a function answers is written as one JSON object a line, never as a pickle:
{"answer": ..., "changed": place or null}, {"printed": text}, {"warned": text}, {"error": ...}, {"refused": sentence},
{"done": true}.
"""

import contextlib
import copy
import ctypes
import faulthandler
import functools
import inspect
import io
import json
import os
import pickle
import select
import signal
import sys
import time
import traceback
import warnings
from collections.abc import Callable

import cloudpickle  # noqa: F401 (every fork needs it)

from bootcourse.course.values import as_json, plain, same

FORKS = sys.platform == "linux"  # on macOS system libraries may break in a fork, and Windows has none
LONGEST_PRINT = 500  # characters of a function's prints that are kept
LONGEST_WAIT = 10  # of a process for the processor, in units of its time limit
LONGEST_ANSWER = 64 * 2**20  # bytes of all that one job may write
READY, DONE = b"ready\n", b'{"done": true}\n'
PR_SET_PDEATHSIG = 1  # of Linux's prctl: the signal that a process gets when its parent ends
SOURCE = "your answer"  # the file name of a function that came as text


def main() -> None:
    """Work on the jobs until the input ends."""
    jobs, replies = os.fdopen(os.dup(0), "rb"), os.fdopen(os.dup(1), "wb")
    nowhere = os.open(os.devnull, os.O_RDWR)
    for descriptor in (0, 1):
        os.dup2(nowhere, descriptor)  # compiled code, too, prints nowhere
    signal.signal(signal.SIGINT, signal.SIG_IGN)  # a notebook's stop button is the kernel's
    import torch

    torch.set_num_threads(1)
    replies.write(READY)
    replies.flush()
    with contextlib.suppress(EOFError):
        while True:
            job = pickle.load(jobs)
            sys.path[:] = job["path"]
            run, cases = prepared(job["exercise"])
            if not FORKS or job["alone"]:
                faulthandler.dump_traceback_later(job["seconds"], exit=True)  # its clock needs no interpreter
                work(job, run, cases, replies)
                return
            ended, stream = in_a_fork(job, run, cases, close=(jobs, replies))
            replies.write(json.dumps({"ended": ended, "bytes": len(stream)}).encode() + b"\n" + stream)
            replies.flush()


@functools.lru_cache(maxsize=128)
def prepared(exercise: bytes) -> tuple[Callable, list[tuple]]:
    """(run, cases) of an exercise: each case's arguments, and the same as `plain`.

    Its solution has run once, so that what it needs is imported and compiled.
    """
    run, solution, cases = pickle.loads(exercise)
    run(solution, *copy.deepcopy(cases[0]))
    return run, [(arguments, [*map(plain, arguments)]) for arguments in cases]


def in_a_fork(job: dict, run: Callable, cases: list[tuple], close: tuple) -> tuple[str | int, bytes]:
    """(how it ended, what it wrote): "" for well, "time", "size", a negative signal or an exit code."""
    ours, theirs = os.pipe()
    child = os.fork()
    if child == 0:
        try:
            os.setsid()
            for file in close:
                os.close(file.fileno())
            limit(job["memory"], job["seconds"])
            with os.fdopen(theirs, "wb") as stream:
                work(job, run, cases, stream)
        finally:
            os._exit(0)
    os.close(theirs)
    try:
        ended, stream = read(ours, Clock(child, job["seconds"]))
    finally:
        os.close(ours)
        with contextlib.suppress(ProcessLookupError, PermissionError):
            os.killpg(child, signal.SIGKILL)  # with all processes that it started
        status = os.waitstatus_to_exitcode(os.waitpid(child, 0)[1])
    return ended or ("" if DONE in stream else status), stream


def limit(memory: int, seconds: float) -> None:
    """At most `memory` bytes more than now, `seconds` of computing and some more, no life after the parent's end."""
    import resource

    ctypes.CDLL(None).prctl(PR_SET_PDEATHSIG, signal.SIGKILL)
    with open("/proc/self/statm") as file:
        size = int(file.read().split()[0]) * resource.getpagesize()
    resource.setrlimit(resource.RLIMIT_AS, (size + memory, size + memory))
    resource.setrlimit(resource.RLIMIT_CPU, (int(seconds) + 10, int(seconds) + 10))


class Clock:
    """The time that is left to a process: seconds in which it only waits for a busy processor do not count."""

    def __init__(self, process: int, seconds: float):
        self.process, self.seconds, self.start = process, seconds, time.monotonic()

    def left(self) -> float:
        passed = time.monotonic() - self.start
        waited = 0.0
        with contextlib.suppress(OSError):  # a kernel that does not count it
            with open(f"/proc/{self.process}/schedstat") as file:
                waited = int(file.read().split()[1]) / 1e9
        return self.seconds - passed + min(waited, LONGEST_WAIT * self.seconds)


def read(pipe: int, clock: Clock) -> tuple[str, bytes]:
    """What comes until the last line, the end of the pipe, or the end of the time."""
    parts, size = [], 0
    while not (parts and DONE in parts[-1]):
        left = clock.left()
        if not select.select([pipe], [], [], max(0.0, left))[0]:
            if left > 0:
                continue  # it may have waited for the processor
            return "time", b"".join(parts)
        parts.append(os.read(pipe, 2**20))
        size += len(parts[-1])
        if size > LONGEST_ANSWER:
            return "size", b""
        if not parts[-1]:
            break
    return "", b"".join(parts)


# In the process of one job --------------------------------------------------------------------------


class Printed(io.TextIOBase):
    """Sends on the beginning of what is printed."""

    def __init__(self, send: Callable):
        self.send, self.room = send, LONGEST_PRINT

    def write(self, text: str) -> int:
        kept, self.room = text[: self.room], max(0, self.room - len(text))
        if kept:
            self.send(printed=kept)
        return len(text)


def work(job: dict, run: Callable, cases: list[tuple], stream) -> None:
    """Write, line by line, what the student's function answers in each case, and which argument it changed."""

    def send(**what):
        stream.write(json.dumps(what).encode() + b"\n")
        stream.flush()

    sys.stdout = sys.stderr = Printed(send)
    warnings.simplefilter("ignore")
    warnings.simplefilter("always", RuntimeWarning)
    warnings.showwarning = lambda text, kind, file, line, *_: send(warned=f"{text}", line=line)
    answer = None
    try:
        answer = source_s(job) if job["source"] is not None else pickle.loads(job["answer"])
        refused = no_answer(answer, job)
        if refused:
            send(refused=refused)
        else:
            for arguments, unchanged in cases * job["times"]:
                given = copy.deepcopy(arguments)
                value = as_json(plain(run(answer, *given)))
                pairs = enumerate(zip(map(plain, given), unchanged, strict=True))
                changed = next((place for place, pair in pairs if not same(*pair, nan_too=True)), None)
                send(answer=value, changed=changed)
    except BaseException as error:  # also SystemExit and KeyboardInterrupt
        send(error=told(error, answer))
    send(done=True)


def source_s(job: dict):
    """The function that a source text defines; None if it defines none of that name."""
    space = {"__name__": "__main__"}
    exec(compile(job["source"], SOURCE, "exec"), space)
    return space.get(job["name"])


def no_answer(answer, job: dict) -> str | None:
    """Why this cannot be called as the exercise asks; None if it can."""
    name, call = job["name"], job["call"]
    if job["source"] is not None and answer is None:
        return f"There is no function `{name}` in this text."
    if not callable(answer):
        words = plain(answer).words
        return f"Give the check your function itself, `check.{name}({name})`: this is {words}."
    with contextlib.suppress(ValueError):  # a function written in C may have no signature
        signature = inspect.signature(answer)
        try:
            signature.bind(*[None] * job["arguments"])
        except TypeError:
            return f"Your function takes {signature}: the check calls `{call}`."
    return None


def file_of(answer) -> str:
    """The file in which a function or a class is written; SOURCE if that is not known."""
    parts = [answer, *vars(answer).values()] if isinstance(answer, type) else [answer]
    return next((part.__code__.co_filename for part in parts if hasattr(part, "__code__")), SOURCE)


def told(error: BaseException, answer) -> dict:
    """An error in plain words: its type, its text, and the last line of the student's file that it passed."""
    try:
        text = " ".join(str(error).split())[:LONGEST_PRINT]
    except BaseException:  # an error may come with a text that cannot be made
        text = ""
    file = file_of(answer)
    lines = [frame.lineno for frame in traceback.extract_tb(error.__traceback__) if frame.filename == file]
    if isinstance(error, SyntaxError) and error.filename == SOURCE:
        lines, text = [error.lineno], error.msg
    return {"kind": type(error).__name__[:80], "todo": isinstance(error, NotImplementedError), "text": text,
            "line": lines[-1] if lines else None}  # fmt: skip


if __name__ == "__main__":
    main()
