"""Judge every answer of a class again, in parallel, and keep each verdict: a grading can be stopped and resumed.

Answers are judged by processes that start in an empty folder; each answer runs in a process of its own again, shut in
by `sandbox.py`. Two students with the same text get the same verdict from one judging. No answer stops the others: if a
process that judges ends, the answers that it may have had are judged one by one.
"""

import functools
import hashlib
import json
import multiprocessing
import os
import signal
import subprocess
import sys
import tempfile
from collections import Counter
from collections.abc import Sequence
from concurrent.futures import ProcessPoolExecutor, as_completed
from concurrent.futures.process import BrokenProcessPool
from contextlib import chdir
from dataclasses import dataclass
from pathlib import Path

import msgspec
from tqdm import tqdm

import bootcourse
from bootcourse.course import runner
from bootcourse.course.answered import our_fault
from bootcourse.course.classroom.sandbox import shut_in
from bootcourse.course.classroom.submission import Submission, fingerprint
from bootcourse.course.judge import judge
from bootcourse.course.lessons import LESSONS, number, registry
from bootcourse.course.verdict import Verdict
from bootcourse.episodes.evaluate import drive_episodes
from bootcourse.errors import BootcourseError, described
from bootcourse.files import open_regular
from bootcourse.policies import rule_policy
from bootcourse.processes import check_semaphores
from bootcourse.scenario import DEFAULT

ENDED = "the process that judged it has ended"
LONGER = 3  # times an exercise's own limit: here the imports count, too, and all cores are busy
PASSED_ON = ("PATH", "LANG", "LC_ALL", "SYSTEMROOT", "PYTHONPATH", "NUMBA_CACHE_DIR")  # of the environment


class Judged(msgspec.Struct, frozen=True):
    """What the check says about an answer."""

    kind: str  # of a Verdict: passed, library, wrong, did_not_run, broke or todo; or missing
    sentence: str = ""
    details: tuple[str, ...] = ()
    is_known: bool = False  # is it one of the exercise's known mistakes?


MISSING = Judged("missing")


class Line(msgspec.Struct, frozen=True):
    """A line of the file of verdicts."""

    key: str  # see `key_of`
    judged: Judged


def key_of(exercise: str, source: str) -> str:
    """The same for the same text judged by the same exercises."""
    return hashlib.sha256(f"{fingerprint()} {exercise} {source}".encode("utf-8", "replace")).hexdigest()[:24]


class Verdicts:
    """The verdicts so far, one JSON line each in a file that only grows; a line that was cut is judged again."""

    def __init__(self, path: Path):
        self.path = path.absolute()
        self.known: dict[str, Judged] = {}
        check_own(path, '{"key":')
        for line in path.read_bytes().splitlines() if path.exists() else ():
            try:
                entry = msgspec.json.decode(line, type=Line)
            except (msgspec.MsgspecError, RecursionError, UnicodeDecodeError):
                continue
            self.known[entry.key] = entry.judged

    def add(self, key: str, judged: Judged) -> None:
        """Keep a verdict; in this run alone, if our check broke off: the next version may judge the answer."""
        self.known[key] = judged
        if judged.kind == "broke":
            return
        with self.path.open("ab") as file:
            file.write(msgspec.json.encode(Line(key, judged)) + b"\n")


def check_own(path: Path, mark: str) -> None:
    """Raise BootcourseError if a file is there that does not hold this mark of those which bootcourse writes."""
    if os.path.lexists(path):
        with open_regular(path) as file:
            if mark.encode() not in file.read():
                raise BootcourseError(f"{path} exists already, and bootcourse did not write it: choose another name.")


def judge_all(submissions: Sequence[Submission], wanted: Sequence[str], verdicts: Verdicts, workers: int) -> list[str]:
    """Judge what has no verdict yet. Returns what shut the answers in; [] if there was nothing to judge.

    Raises BootcourseError if no process that judges starts.
    """
    answers = {(name, text) for one in submissions for name, text in one.answers.items() if name in wanted}
    todo = [pair for pair in sorted(answers) if key_of(*pair) not in verdicts.known]
    if not todo:
        return []
    check_semaphores()
    drive_episodes(rule_policy(DEFAULT), [0])  # compiles the road, if nobody has yet
    # A folder in which somebody works, or whose files were handed in, is not one to start Python in.
    with tempfile.TemporaryDirectory(prefix="bootcourse-judge-", ignore_cleanup_errors=True) as folder, chdir(folder):
        environment = surroundings(folder)
        holds = barriers(folder, environment)
        processes = functools.partial(
            ProcessPoolExecutor,
            mp_context=multiprocessing.get_context("spawn"),
            initializer=begin,
            initargs=(folder, environment, bool(holds)),
        )
        at_once, before, ended = min(workers, len(todo), 60), len(verdicts.known), []
        with tqdm(total=len(todo), desc="answers", unit="") as bar:
            while todo:
                left = judge_together(todo, processes(at_once), verdicts, bar)
                for pair in left[:at_once]:  # answers are begun in their order: one of these ended a process
                    if judge_together([pair], processes(1), verdicts, bar):
                        ended.append(pair)
                        verdicts.add(key_of(*pair), said_by(our_fault(registry()[pair[0]], ENDED)))
                if left and len(verdicts.known) == before + len(ended):
                    raise BootcourseError("No process that judges starts: `bootcourse doctor` says what is wrong.")
                todo = left[at_once:]
    return holds


def judge_together(
    todo: list[tuple[str, str]], pool: ProcessPoolExecutor, verdicts: Verdicts, bar: tqdm
) -> list[tuple[str, str]]:
    """Judge (exercise, text) pairs by the processes of a pool. Returns those that are left if one of these ends."""
    left = dict.fromkeys(todo)
    try:
        asked = {pool.submit(judged, *pair, LONGER * registry()[pair[0]].seconds): pair for pair in todo}
        for done in as_completed(asked):
            error, pair = done.exception(), asked[done]
            if isinstance(error, BrokenProcessPool):
                break
            failed = error and said_by(our_fault(registry()[pair[0]], described(error)))
            verdicts.add(key_of(*pair), failed or done.result())
            del left[pair]
            bar.update()
    except BrokenProcessPool:  # while answers are handed to it
        return list(left)
    finally:  # also after Ctrl-C: each process finishes its answer
        pool.shutdown(cancel_futures=True)
    return list(left)


def said_by(verdict: Verdict) -> Judged:
    return Judged(verdict.kind, verdict.sentence, verdict.details, verdict.mistake is not None)


def surroundings(folder: str) -> dict[str, str]:
    """What the processes that judge know of this one's environment."""
    known = {name: os.environ[name] for name in PASSED_ON if name in os.environ}
    known["PYTHONPATH"] = os.pathsep.join(filter(None, [known.get("PYTHONPATH"), str(package_folder())]))
    return known | dict.fromkeys(("HOME", "TMPDIR", "TEMP", "TMP", "MPLCONFIGDIR"), folder) | {"OMP_NUM_THREADS": "1"}


def package_folder() -> Path:
    return Path(bootcourse.__file__).resolve().parents[1]


def barriers(folder: str, environment: dict[str, str]) -> list[str]:
    """What shuts an answer in on this system: tried by a process that then ends."""
    command = [sys.executable, "-P", "-m", "bootcourse.course.classroom.sandbox", folder]
    tried = subprocess.run(command, env=environment, capture_output=True, text=True, check=False)
    return json.loads(tried.stdout) if tried.returncode == 0 else []


def begin(folder: str, environment: dict[str, str], is_shut_in: bool) -> None:
    """In a process that judges: what it knows is what the processes that run answers know."""
    signal.signal(signal.SIGINT, signal.SIG_IGN)  # Ctrl-C is for the process that started it
    os.environ.clear()
    os.environ.update(environment)
    runner.SHUT_IN = functools.partial(shut_in, Path(folder)) if is_shut_in else None


def judged(exercise: str, source: str, seconds: float) -> Judged:
    """In a process that judges: the verdict on an answer."""
    return said_by(judge(registry()[exercise], source, seconds))


# Points ---------------------------------------------------------------------------------------------


def points_of(lessons: set[int] | None) -> dict[str, int]:
    """Exercise -> points, its difficulty, of these lessons (None: of all)."""
    chosen = registry().items()
    return {name: each.difficulty for name, each in chosen if lessons is None or int(each.lesson[:2]) in lessons}


def handed_out(submissions: Sequence[Submission]) -> set[int] | None:
    """The lessons that most submissions were given, as numbers; None if they do not say."""
    given = Counter(frozenset(one.lessons) & set(LESSONS) for one in submissions)
    return next(({number(lesson) for lesson in lessons} for lessons, _ in given.most_common() if lessons), None)


@dataclass(frozen=True)
class Graduate:
    """A student's submission with a verdict on each exercise, in the order of the lessons."""

    submission: Submission
    verdicts: dict[str, Judged]
    worth: dict[str, int]  # the points of each exercise

    @property
    def points(self) -> dict[str, int]:
        """Those of each exercise that the student gets."""
        return {name: self.worth[name] * (judged.kind == "passed") for name, judged in self.verdicts.items()}

    def of_kind(self, kind: str) -> list[str]:
        """The exercises with such a verdict."""
        return [name for name, judged in self.verdicts.items() if judged.kind == kind]

    @property
    def total(self) -> int:
        return sum(self.points.values())


def graded(submission: Submission, worth: dict[str, int], verdicts: Verdicts) -> Graduate:
    """A student's verdicts, once `judge_all` has judged the answers."""
    answers = submission.answers
    each = {name: verdicts.known[key_of(name, answers[name])] if name in answers else MISSING for name in worth}
    return Graduate(submission, each, worth)
