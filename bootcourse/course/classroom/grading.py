"""Judge every answer of a class again, in parallel, and keep each verdict: a grading can be stopped and resumed.

Two students with the same text get the same verdict from one judging.
"""

import hashlib
import threading
from collections import defaultdict
from collections.abc import Sequence
from concurrent.futures import ThreadPoolExecutor, as_completed
from dataclasses import dataclass
from pathlib import Path

import msgspec
from tqdm import tqdm

from bootcourse.course.classroom.judging import Judge, Judged
from bootcourse.course.classroom.submission import Submission, fingerprint
from bootcourse.course.lessons import registry
from bootcourse.episodes.evaluate import drive_episodes
from bootcourse.files import check_own
from bootcourse.policies import rule_policy
from bootcourse.scenario import DEFAULT

LONGER = 3  # times an exercise's own limit: here the imports count, too, and all cores are busy
MISSING = Judged("missing", "")


class Kept(msgspec.Struct, frozen=True):
    """A line of the file of verdicts."""

    key: str  # see `key_of`
    judged: Judged


def key_of(exercise: str, source: str) -> str:
    """The same for the same text judged by the same exercises."""
    return hashlib.sha256(f"{fingerprint()} {exercise} {source}".encode("utf-8", "replace")).hexdigest()[:24]


class Verdicts:
    """The verdicts so far, one JSON line each in a file that only grows; a line that was cut is judged again."""

    def __init__(self, path: Path):
        self.path, self.lock = path, threading.Lock()
        self.known: dict[str, Judged] = {}
        check_own(path, '{"key":')
        for line in path.read_bytes().splitlines() if path.exists() else ():
            try:
                kept = msgspec.json.decode(line, type=Kept)
            except (msgspec.MsgspecError, RecursionError, UnicodeDecodeError):
                continue
            self.known[kept.key] = kept.judged

    def add(self, key: str, judged: Judged) -> None:
        with self.lock:
            self.known[key] = judged
            if judged.kind == "unjudged":
                return  # the next grading tries again
            with self.path.open("ab") as file:
                file.write(msgspec.json.encode(Kept(key, judged)) + b"\n")


def judge_all(submissions: Sequence[Submission], wanted: Sequence[str], verdicts: Verdicts, workers: int) -> list[str]:
    """Judge what has no verdict yet. Returns what shut the judging processes in; [] if there was nothing to judge.

    Raises BootcourseError if no process starts.
    """
    answers = {(name, text) for one in submissions for name, text in one.answers.items() if name in wanted}
    todo = [pair for pair in sorted(answers) if key_of(*pair) not in verdicts.known]
    if not todo:
        return []
    drive_episodes(rule_policy(DEFAULT), [0])  # compiles the road, of which each judging process gets a copy
    judges = [Judge() for _ in range(min(workers, len(todo)))]

    def judge(name: str, text: str) -> set[str]:
        mine = judges.pop()  # there is one for each thread
        try:
            verdicts.add(key_of(name, text), mine.ask(name, text, LONGER * registry()[name].seconds))
            return set(mine.holds)
        finally:
            judges.append(mine)

    pool = ThreadPoolExecutor(len(judges))
    try:
        asked = [pool.submit(judge, *pair) for pair in todo]
        done = tqdm(as_completed(asked), total=len(asked), desc="answers", unit="")
        return sorted(set.intersection(*(each.result() for each in done)))
    finally:  # also after Ctrl-C: each judge finishes its answer
        pool.shutdown(cancel_futures=True)
        for each in judges:
            each.close()


@dataclass(frozen=True)
class Graduate:
    """A student's submission with a verdict on each exercise, in the order of the lessons."""

    submission: Submission
    verdicts: dict[str, Judged]
    worth: dict[str, float]  # the points of each exercise

    @property
    def points(self) -> dict[str, float]:
        """Those of each exercise that the student gets."""
        return {name: self.worth[name] * (judged.kind == "passed") for name, judged in self.verdicts.items()}

    @property
    def total(self) -> float:
        return sum(self.points.values())


def graded(submission: Submission, worth: dict[str, float], verdicts: Verdicts) -> Graduate:
    """A student's verdicts, once `judge_all` has judged the answers."""
    answers = submission.answers
    judged = {name: verdicts.known[key_of(name, answers[name])] if name in answers else MISSING for name in worth}
    return Graduate(submission, judged, worth)


def identical(submissions: Sequence[Submission]) -> list[list[str]]:
    """The groups of students whose written answers, three or more, are the same in all but spaces."""
    groups = defaultdict(list)
    for one in submissions:
        if len(one.written) >= 3:
            bare = sorted((name, "".join(text.split())) for name, text in one.written.items())
            groups[tuple(bare)].append(one.student)
    return [students for students in groups.values() if len(students) > 1]
