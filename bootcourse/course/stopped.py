"""What a process that was stopped had been doing: computing or waiting, in which case, in which line.

The process notes how much it has computed before each case (`Notes`). When its time is over, it is asked for the line
that it is in, and the system for the processor's time (`Stopped.of`); both on Linux only.
"""

import contextlib
import os
import re
import signal
import time
from pathlib import Path
from typing import NamedTuple

LONGEST = 2**16  # bytes of notes that are read: the process may write anything there
SLOW_TO_SAY = 2  # seconds in which it has to say its line: other processes may have the processors
QUIET = 0.1  # seconds without a byte after which it has said all


class Notes:
    """Written in the process: the seconds that it has computed, before each case. descriptor: None writes nothing."""

    def __init__(self, descriptor: int | None):
        self.descriptor = descriptor

    def begin_case(self) -> None:
        if self.descriptor is not None:
            os.write(self.descriptor, b"%.3f\n" % time.process_time())


class Stopped(NamedTuple):
    """Of a process that was stopped."""

    seconds: float  # that it had
    computed: float | None = None  # of these; None where this is not known
    cases: tuple[float, ...] = ()  # the seconds computed in each case, the last of which was not finished
    frames: tuple[tuple[str, int], ...] = ()  # (file, line), the innermost first

    @classmethod
    def of(cls, process: int, notes, seconds: float) -> "Stopped":
        """notes: the end of the pipe that is read."""
        try:
            computed = processor_seconds(process)
            with contextlib.suppress(OSError):
                os.killpg(process, signal.SIGUSR1)
            text = said(notes.fileno())
        except (OSError, AttributeError, ValueError):  # not Linux, or it has ended
            return cls(seconds)
        begun = [float(number) for number in re.findall(r"^(\d{1,6}\.\d{3})$", text, re.M)]
        if not begun:
            return cls(seconds)
        cases = [end - begin for begin, end in zip(begun, [*begun[1:], computed], strict=True)]
        frames = re.findall(r'^  File "([^"\n]*)", line (\d{1,9}) in ', text, re.M)
        return cls(seconds, computed - begun[0], tuple(cases), tuple((file, int(line)) for file, line in frames))

    @property
    def is_endless(self) -> bool:
        """Does its last case compute much longer than all before it took, and more than half of the time?"""
        *before, last = self.cases or (0.0,)
        return last > self.seconds / 2 and last > 20 * max(before, default=0.0)


def processor_seconds(session: int) -> float:
    """The processor's seconds of all processes of a session: of an answer's, and where it is shut in, its child."""
    ticks = 0
    for stat in Path("/proc").glob("[0-9]*/stat"):
        with contextlib.suppress(OSError):  # it has ended
            fields = stat.read_text(errors="replace").rpartition(")")[2].split()
            if int(fields[3]) == session:
                ticks += int(fields[11]) + int(fields[12])
    return ticks / os.sysconf("SC_CLK_TCK")


def said(descriptor: int) -> str:
    """All that stands in the pipe, once the process has said its line or has had the time to."""
    os.set_blocking(descriptor, False)
    end, quiet, text = time.monotonic() + SLOW_TO_SAY, float("inf"), b""
    while time.monotonic() < min(end, quiet) and len(text) < LONGEST:
        try:
            more = os.read(descriptor, LONGEST)
        except BlockingIOError:
            time.sleep(0.01)
            continue
        if not more:
            break
        text += more
        if b"most recent call first" in text:
            quiet = time.monotonic() + QUIET
    return text.decode("utf-8", "replace")
