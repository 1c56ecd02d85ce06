"""Run a student's function in a process of its own, so that the notebook goes on whatever the function does.

`worker.py` is that process. Nothing that the function changes there (the library, the random state, its own globals)
outlives the check; endless loops, crashes, `os._exit`, threads and prints end with it; what comes back is JSON.

What is guarded: time, everywhere. Memory, on Linux only: elsewhere a function that fills the memory slows down the
machine until its time is up. Files, network and other processes, nowhere: the function runs with your rights.
"""

import atexit
import functools
import json
import linecache
import os
import pickle
import subprocess
import sys
import threading
from collections.abc import Callable
from dataclasses import dataclass, field

import cloudpickle

from bootcourse.course import worker
from bootcourse.course.exercise import Exercise
from bootcourse.course.values import Plain, from_json
from bootcourse.errors import BootcourseError

MEMORY = 2 * 2**30  # bytes that a function may use
NOT_SENT = (
    "Your function uses something that exists only in the notebook's own process, such as an open file, a widget or a "
    "lock: make it inside the function ({})."
)
PATIENCE = 60  # seconds in which a process that is started anew has to be ready


@dataclass
class GuardedRun:
    """What the function did, case by case, up to the first case that raised an error or took too long."""

    answers: list[Plain] = field(default_factory=list)
    refused: str = ""  # why it cannot be called at all
    error: dict | None = None  # kind, text, line, todo: see `worker.told`
    changed: tuple[int, int] | None = None  # (case, index of the argument) of the first argument changed in place
    ended: str | int = ""  # "time", "size", or how the process ended before its time: an exit code, minus a signal
    printed: str = ""
    warned: dict[int, str] = field(default_factory=dict)  # case -> NumPy's first warning

    @property
    def case(self) -> int:
        """The case at which it ended, if it ended early."""
        return len(self.answers)


def run(exercise: Exercise, answer: Callable | str, times: int = 1) -> GuardedRun:
    """Call a function, or the one that a source text defines, for every case, `times` over.

    Raises BootcourseError where the process cannot be started.
    """
    source = answer if isinstance(answer, str) else None
    try:
        pickled = cloudpickle.dumps(None if isinstance(answer, str) else answer)
    except Exception as error:  # whatever an object's own pickling raises
        return GuardedRun(refused=NOT_SENT.format(" ".join(str(error).split())[:200]))
    job = {
        "exercise": packed(exercise), "answer": pickled, "source": source,
        "name": exercise.name, "call": exercise.call, "arguments": len(exercise.arguments),
        "seconds": exercise.seconds, "memory": MEMORY, "times": times, "path": sys.path, "alone": not worker.FORKS,
    }  # fmt: skip
    with _one_at_a_time:
        found = report(*(_in_a_fork if worker.FORKS else _alone)(pickle.dumps(job), exercise.seconds))
    if not (found.error or found.refused) and found.case != times * len(exercise.all_arguments):
        found.ended = found.ended or 0  # somebody else wrote that it is done
    return found


@functools.lru_cache(maxsize=256)
def packed(exercise: Exercise) -> bytes:
    """What the process needs of an exercise: how to run an answer, the solution, the cases."""
    return cloudpickle.dumps((exercise.answers, exercise.solution, exercise.all_arguments))


def report(ended: str | int, stream: bytes) -> GuardedRun:
    """What the lines say that the process wrote. A line that it cannot have written ends the report."""
    found = GuardedRun(ended=ended)
    try:
        for line in stream.splitlines():
            told = json.loads(line)
            if "answer" in told:
                if told["changed"] is not None and found.changed is None:
                    found.changed = (found.case, int(told["changed"]))
                found.answers.append(from_json(told["answer"]))
            elif "printed" in told:
                found.printed += str(told["printed"])
            elif "warned" in told:
                found.warned.setdefault(found.case, str(told["warned"]))
            elif "error" in told:
                told = told["error"]
                line = None if told["line"] is None else int(told["line"])
                found.error = {"kind": str(told["kind"]), "text": str(told["text"]), "todo": bool(told["todo"]),
                               "line": line}  # fmt: skip
            elif "refused" in told:
                found.refused = str(told["refused"])
    except (ValueError, KeyError, TypeError, RecursionError):
        found.ended = found.ended or 0
    found.printed = found.printed.strip()[: worker.LONGEST_PRINT]
    return found


def where(report: GuardedRun, answer: Callable | str) -> str:
    """The student's line that raised the error, as in "line 4, `return x + y`"; empty if none of theirs did."""
    line = report.error["line"]
    if line is None:
        return ""
    if isinstance(answer, str):
        lines = answer.splitlines()
        text = lines[line - 1].strip() if 0 < line <= len(lines) else ""
    else:
        text = linecache.getline(worker.file_of(answer), line).strip()
    return f"line {line}" + (f", `{text}`" if text else "")


# The process ----------------------------------------------------------------------------------------

_one_at_a_time = threading.Lock()
_process: subprocess.Popen | None = None  # warm: the one that forks, or the next one that works on a job alone
_owner = 0  # the process that started it


def _start() -> subprocess.Popen:
    """The warm process, started if there is none."""
    global _process, _owner
    if _process is None or _process.poll() is not None or _owner != os.getpid():
        _owner = os.getpid()
        _process = subprocess.Popen(
            [sys.executable, "-m", "bootcourse.course.worker"],
            stdin=subprocess.PIPE, stdout=subprocess.PIPE,
            stderr=subprocess.DEVNULL if worker.FORKS else subprocess.PIPE,
            start_new_session=True,  # the notebook's stop button does not reach it
            env={**os.environ, "OMP_NUM_THREADS": "1", "OPENBLAS_NUM_THREADS": "1",
                 "PYTHONPATH": os.pathsep.join(filter(None, sys.path))},
        )  # fmt: skip
        if worker.FORKS and _process.stdout.readline() != worker.READY:
            raise _broken(_process)
    return _process


def _broken(process: subprocess.Popen) -> BootcourseError:
    process.kill()
    return BootcourseError(
        f"The process that runs your function could not be started (it ended with {process.wait()}). "
        "Restart the kernel; if that does not help, `bootcourse doctor` says what is wrong."
    )


@atexit.register
def stop() -> None:
    """End the process; the next check starts another."""
    global _process
    process, _process = _process, None
    if process is not None and _owner == os.getpid():
        process.kill()
        process.communicate()


def _in_a_fork(job: bytes, seconds: float) -> tuple[str | int, bytes]:
    """(how it ended, what it wrote) of a job that the warm process runs in a fork."""
    process = _start()
    try:
        process.stdin.write(job)
        process.stdin.flush()
        head = json.loads(process.stdout.readline() or "{}")
        if head:
            return head["ended"], process.stdout.read(head["bytes"])
    except OSError:  # a broken pipe: the process has ended
        pass
    except BaseException:  # also the notebook's stop button
        stop()
        raise
    return process.wait(), b""


def _alone(job: bytes, seconds: float) -> tuple[str | int, bytes]:
    """The same for a process that runs one job only; the next one is started ahead."""
    global _process
    process = _start()
    try:
        stream, errors = process.communicate(job, timeout=seconds + PATIENCE)
        ended = "time" if b"Timeout (" in errors else process.returncode
    except subprocess.TimeoutExpired:
        process.kill()
        ended, stream = "time", process.communicate()[0]
    except BaseException:
        stop()
        raise
    _process = None
    if not stream.startswith(worker.READY):
        raise _broken(process)
    _start()
    return "" if worker.DONE in stream else ended, stream.removeprefix(worker.READY)
