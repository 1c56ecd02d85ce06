"""A process that judges answers, shut in, and the `Judge` that starts it, asks it, and starts it anew when it dies.

`python -m bootcourse.course.classroom.judging FOLDER` reads one JSON object a line, {"exercise": name, "source": text,
"seconds": limit}, and answers each with one line, a `Judged`. `course.judge` runs the text in a process of its own
again, with limits of time and memory.
"""

import contextlib
import functools
import json
import os
import shutil
import subprocess
import sys
import tempfile
import threading
from pathlib import Path

import msgspec

import bootcourse
from bootcourse.errors import BootcourseError

START, SLACK = 180.0, 120.0  # s that a process has to start, and to answer beyond an exercise's own limit


class Judged(msgspec.Struct, frozen=True):
    """What the check says about an answer."""

    kind: str  # of a Verdict: passed, wrong, did_not_run or todo; or unjudged
    sentence: str
    details: tuple[str, ...] = ()
    is_known: bool = False  # is it one of the exercise's known mistakes?


UNJUDGED = Judged("unjudged", "Your answer could not be judged: the process that judges it ended.")


def main() -> None:
    """Judge until the input ends. The first line says what holds the process in."""
    from bootcourse.course import runner
    from bootcourse.course.classroom.sandbox import SCRATCH, shut_in, shut_in_answer

    questions, replies = os.fdopen(os.dup(0), "r", encoding="utf-8"), os.fdopen(os.dup(1), "w", encoding="utf-8")
    nowhere = os.open(os.devnull, os.O_RDWR)
    for descriptor in (0, 1):
        os.dup2(nowhere, descriptor)
    folder = Path(sys.argv[1])
    holds = shut_in(folder)
    runner.SHUT_IN = functools.partial(shut_in_answer, folder) if holds else None
    from bootcourse.course.judge import judge
    from bootcourse.course.lessons import registry

    first = next(iter(registry().values()))
    judge(first, f"def {first.call}:\n    1 / 0\n")  # starts the processes that run answers
    print(json.dumps(holds), file=replies, flush=True)
    for line in questions:
        asked = json.loads(line)
        verdict = judge(registry()[asked["exercise"]], asked["source"], asked["seconds"])
        for left in (folder / SCRATCH).glob("*") if holds else ():
            shutil.rmtree(left, ignore_errors=True) if left.is_dir() else left.unlink()
        judged = Judged(verdict.kind, verdict.sentence, verdict.details, verdict.mistake is not None)
        print(msgspec.json.encode(judged).decode(), file=replies, flush=True)


class Judge:
    """One such process. Use it in one thread, and close it."""

    def __init__(self):
        self.process: subprocess.Popen | None = None
        self.holds: list[str] = []  # what shuts it in: network, processes, files
        self.folder: str | None = None

    def ask(self, exercise: str, source: str, seconds: float) -> Judged:
        """The verdict on an answer. A process that dies is started anew, for a second try.

        Raises BootcourseError if no process starts.
        """
        asked = json.dumps({"exercise": exercise, "source": source, "seconds": seconds})
        for _ in range(2):
            self.start()
            with contextlib.suppress(OSError, msgspec.MsgspecError):  # it died: nobody reads, or the line is cut
                self.process.stdin.write(asked + "\n")
                self.process.stdin.flush()
                return msgspec.json.decode(self.line(2 * seconds + SLACK), type=Judged)
            self.close()
        return UNJUDGED

    def start(self) -> None:
        """Start the process, unless it runs. Raises BootcourseError where it does not start."""
        if self.process is not None:
            return
        self.folder = tempfile.mkdtemp(prefix="bootcourse-judge-")
        # -P: a folder in which somebody works, or whose files were handed in, is not one to import from
        command = [sys.executable, "-P", "-m", "bootcourse.course.classroom.judging", self.folder]
        self.process = subprocess.Popen(
            command, env=environment(self.folder), cwd=self.folder, stdin=subprocess.PIPE, stdout=subprocess.PIPE,
            stderr=subprocess.DEVNULL, encoding="utf-8", start_new_session=True,
        )  # fmt: skip
        holds = self.line(START)
        if not holds:
            self.close()
            raise BootcourseError("The process that judges answers does not start: run `bootcourse doctor`.")
        self.holds = json.loads(holds)

    def line(self, seconds: float) -> str:
        """The process's next line; it is killed if none comes in time."""
        clock = threading.Timer(seconds, self.process.kill)
        clock.start()
        try:
            return self.process.stdout.readline()
        finally:
            clock.cancel()

    def close(self) -> None:
        """End the process, with all that it started, and remove its folder."""
        if self.process is not None:
            self.process.kill()
            self.process.communicate()
            shutil.rmtree(self.folder, ignore_errors=True)
        self.process = None


def environment(folder: str) -> dict[str, str]:
    """What the process knows of this one's surroundings: where Python, the package and the temporary folder are."""
    from bootcourse.road.compiled import CACHE_FOLDER

    caches = Path(folder) / "numba"
    if CACHE_FOLDER is not None:  # a copy: what a stranger may write to is not executed by anybody else
        shutil.copytree(CACHE_FOLDER, caches / CACHE_FOLDER.name)
    system = {name: os.environ[name] for name in ("PATH", "LANG", "LC_ALL", "SYSTEMROOT") if name in os.environ}
    own = dict.fromkeys(("HOME", "TMPDIR", "TEMP", "TMP", "MPLCONFIGDIR"), folder)
    places = [place for place in sys.path if place and Path(place).resolve() != Path.cwd()]
    package = str(Path(bootcourse.__file__).resolve().parents[1])  # it may be the present folder
    python = {"PYTHONPATH": os.pathsep.join([*places, package]), "PYTHONDONTWRITEBYTECODE": "1"}
    return system | own | python | {"NUMBA_CACHE_DIR": str(caches), "OMP_NUM_THREADS": "1"}


if __name__ == "__main__":
    main()
