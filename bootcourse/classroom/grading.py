"""Judge every answer of a class again, in parallel, and keep each verdict: a grading can be stopped and resumed.

Two students with the same text get the same verdict from one judging.
"""

import hashlib
import json
import queue
import threading
from collections import defaultdict
from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path

from tqdm import tqdm

from bootcourse.classroom.judging import Judge
from bootcourse.classroom.submission import Submission, fingerprint
from bootcourse.errors import BootcourseError
from bootcourse.lessons.exercises import registry

TROUBLE = ("raises an error", "was stopped after", "crash", "memory", "ended Python")
LONGER = 3  # times an exercise's own limit: here the imports count, too, and all cores are busy


@dataclass(frozen=True)
class Graded:
    """One answer of one student."""

    exercise: str
    kind: str  # passed, wrong, todo (a stub), missing, or unjudged
    points: float
    sentence: str = ""
    details: tuple[str, ...] = ()
    belief: str = ""  # what the student probably thinks, where the mistake is a known one

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
        key(name, text): (name, text)
        for one in submissions for name, text in one.answers.items() if name in wanted
    }  # fmt: skip
    todo = {k: pair for k, pair in todo.items() if k not in verdicts.known}
    jobs, holds, stop, errors = queue.SimpleQueue(), set(), threading.Event(), []
    for item in todo.items():
        jobs.put(item)
    bar = tqdm(total=len(todo), desc="answers", unit="", disable=not (progress and todo))
    if todo:
        compile_the_road()
    arguments = (jobs, verdicts, holds, stop, errors, bar)
    threads = [threading.Thread(target=work, args=arguments) for _ in range(min(workers, len(todo)))]
    for thread in threads:
        thread.start()
    try:
        while any(thread.is_alive() for thread in threads):
            for thread in threads:
                thread.join(0.1)
    finally:  # also after Ctrl-C: each judge finishes its answer
        stop.set()
        for thread in threads:
            thread.join()
        bar.close()
    if errors:
        raise errors[0]
    return sorted(set.intersection(*map(set, holds))) if holds else []


def compile_the_road() -> None:
    """Once, here: the judging processes begin with a copy of what is compiled."""
    from bootcourse.episodes.evaluate import drive_episodes
    from bootcourse.policies import rule_policy
    from bootcourse.scenario import DEFAULT

    drive_episodes(rule_policy(DEFAULT), [0])


def work(
    jobs: queue.SimpleQueue, verdicts: Verdicts, holds: set, stop: threading.Event, errors: list, bar: tqdm
) -> None:
    """Judge until nothing is left, or one of the threads has an error."""
    judge = Judge()
    try:
        while not stop.is_set():
            place, (name, text) = jobs.get_nowait()
            verdicts.add(place, judge.ask(name, text, LONGER * registry()[name].seconds))
            holds.add(tuple(judge.holds))
            bar.update()
    except queue.Empty:
        return
    except BootcourseError as error:
        errors.append(error)
        stop.set()
    finally:
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
        beliefs = [m.belief for m in registry()[name].mistakes if m.says == sentence]
        found.append(
            Graded(name, told["kind"], worth * passed, sentence, tuple(map(str, told["details"])), "".join(beliefs[:1]))
        )
    return Graduate(submission, tuple(found))


def did_not_run(graduate: Graduate) -> list[str]:
    """The exercises whose answer raised an error, took too long, or ended its process."""
    return [g.exercise for g in graduate.grades if g.kind == "wrong" and any(words in g.sentence for words in TROUBLE)]


def identical(submissions: Sequence[Submission], least: int = 3) -> list[list[str]]:
    """The groups of students whose written answers, at least so many, are the same in all but spaces."""
    groups = defaultdict(list)
    for one in submissions:
        if len(one.written) >= least:
            bare = sorted((name, "".join(text.split())) for name, text in one.written.items())
            groups[tuple(bare)].append(one.student)
    return [students for students in groups.values() if len(students) > 1]


def other_versions(submissions: Sequence[Submission]) -> list[str]:
    """The students whose answers were written with other exercises than those of this kit."""
    return [one.student for one in submissions if one.exercises not in ("", fingerprint())]
