"""Judge every answer of a class again, in parallel, and keep each verdict: a grading can be stopped and resumed.

Two students with the same text get the same verdict from one judging.
"""

import hashlib
import json
import threading
from collections import defaultdict
from collections.abc import Sequence
from concurrent.futures import ThreadPoolExecutor, as_completed
from dataclasses import dataclass
from pathlib import Path

from tqdm import tqdm

from bootcourse.course.classroom.judging import Judge
from bootcourse.course.classroom.submission import Submission, fingerprint
from bootcourse.course.lessons import registry
from bootcourse.episodes.evaluate import drive_episodes
from bootcourse.policies import rule_policy
from bootcourse.scenario import DEFAULT

LONGER = 3  # times an exercise's own limit: here the imports count, too, and all cores are busy


@dataclass(frozen=True)
class Graded:
    """One answer of one student."""

    exercise: str
    kind: str  # of the verdict (passed, wrong, did_not_run, todo), missing, or unjudged
    points: float
    sentence: str = ""
    details: tuple[str, ...] = ()
    known: bool = False  # is the sentence that of a mistake which the exercise knows?

    @property
    def passed(self) -> bool:
        return self.kind == "passed"


@dataclass(frozen=True)
class Graduate:
    """A student's submission with its grades, one for each exercise, in the order of the lessons."""

    submission: Submission
    grades: tuple[Graded, ...]

    @property
    def points(self) -> float:
        return sum(grade.points for grade in self.grades)


def key(exercise: str, source: str) -> str:
    """The same for the same text judged by the same exercises."""
    return hashlib.sha256(f"{fingerprint()} {exercise} {source}".encode("utf-8", "replace")).hexdigest()[:24]


class Verdicts:
    """The verdicts so far, one JSON line each in a file that only grows; a line that was cut is judged again."""

    def __init__(self, path: Path):
        self.path, self.lock = path, threading.Lock()
        self.known: dict[str, dict] = {}
        for line in path.read_text(encoding="utf-8").splitlines() if path.exists() else ():
            try:
                told = json.loads(line)
                self.known[told["key"]] = told
            except (ValueError, KeyError, TypeError):
                continue

    def add(self, key: str, verdict: dict) -> None:
        with self.lock:
            self.known[key] = verdict | {"key": key}
            if verdict["kind"] == "unjudged":
                return  # the next grading tries again
            with self.path.open("a", encoding="utf-8") as file:
                file.write(json.dumps(self.known[key]) + "\n")


def judge_all(
    submissions: Sequence[Submission], wanted: Sequence[str], verdicts: Verdicts, workers: int, progress: bool = True
) -> list[str]:
    """Judge what has no verdict yet. Returns what shut the judging processes in; [] if there was nothing to judge.

    Raises BootcourseError if no process starts.
    """
    todo = {
        place: (name, text)
        for one in submissions for name, text in one.answers.items()
        if name in wanted and (place := key(name, text)) not in verdicts.known
    }  # fmt: skip
    if not todo:
        return []
    drive_episodes(rule_policy(DEFAULT), [0])  # compiles the road, of which each judging process gets a copy
    judges = [Judge() for _ in range(min(workers, len(todo)))]

    def judged(place: str, name: str, text: str) -> set[str]:
        judge = judges.pop()  # there is one for each thread
        try:
            verdicts.add(place, judge.ask(name, text, LONGER * registry()[name].seconds))
            return set(judge.holds)
        finally:
            judges.append(judge)

    pool = ThreadPoolExecutor(len(judges))
    try:
        asked = [pool.submit(judged, place, *pair) for place, pair in todo.items()]
        done = tqdm(as_completed(asked), total=len(asked), desc="answers", unit="", disable=not progress)
        return sorted(set.intersection(*(each.result() for each in done)))
    finally:  # also after Ctrl-C: each judge finishes its answer
        pool.shutdown(cancel_futures=True)
        for judge in judges:
            judge.close()


def graded(submission: Submission, points: dict[str, float], verdicts: Verdicts) -> Graduate:
    """A student's grades."""
    found = []
    for name, worth in points.items():
        source = submission.answers.get(name)
        if source is None:
            found.append(Graded(name, "missing", 0.0))
            continue
        told = verdicts.known[key(name, source)]
        passed, sentence = told["kind"] == "passed", str(told["sentence"])
        details = tuple(map(str, told["details"]))
        found.append(Graded(name, told["kind"], worth * passed, sentence, details, told["known"]))
    return Graduate(submission, tuple(found))


def did_not_run(graduate: Graduate) -> list[str]:
    """The exercises whose answer raised an error, took too long, or ended its process."""
    return [g.exercise for g in graduate.grades if g.kind == "did_not_run"]


def identical(submissions: Sequence[Submission]) -> list[list[str]]:
    """The groups of students whose written answers, three or more, are the same in all but spaces."""
    groups = defaultdict(list)
    for one in submissions:
        if len(one.written) >= 3:
            bare = sorted((name, "".join(text.split())) for name, text in one.written.items())
            groups[tuple(bare)].append(one.student)
    return [students for students in groups.values() if len(students) > 1]


def other_versions(submissions: Sequence[Submission]) -> list[str]:
    """The students whose answers were written with other exercises than those of this kit."""
    return [one.student for one in submissions if one.exercises not in ("", fingerprint())]
