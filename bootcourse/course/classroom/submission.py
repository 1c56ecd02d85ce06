"""What a student hands in, as one JSON file: answers, predictions, versions, a name. Nothing is run.

Such a file may come from anybody: one reader checks every field, and what it returns is only text.
"""

import hashlib
import os
import re
import warnings
from collections.abc import Iterator
from contextlib import contextmanager
from datetime import UTC, datetime
from functools import cache
from pathlib import Path
from typing import Annotated, Any, ClassVar

from msgspec import Meta, Struct, convert, to_builtins
from msgspec.structs import replace

from bootcourse.course import lessons as exercises
from bootcourse.course.classroom.answers import LONGEST, Answers, Clock, Notebook, unfinished
from bootcourse.course.edition import HANDOUT
from bootcourse.course.lessons import registry
from bootcourse.course.predictions import FILE, predictions
from bootcourse.errors import BootcourseError
from bootcourse.files import decoding, provenance, read_bytes, read_json, write_json

ASK = "ask for it again"  # the remedy for a damaged file
MOST = 200  # predictions, and as many problems
MADE_WITH = "bootcourse_exercises"  # in the metadata of a handout's notebooks: the `fingerprint` of its exercises
KINDS = (".json", ".ipynb")  # of files that a student hands in
SOLVED = "solved"  # the folder, beside the lessons, with the course's own answers

Words = Annotated[str, Meta(max_length=200)]
Long = Annotated[str, Meta(max_length=2000)]
Answer = Annotated[str, Meta(max_length=LONGEST)]
Many = Meta(max_length=MOST)


class Handed(Struct):
    """What is read of a handout's record."""

    deadline: Words = ""
    cells: Annotated[dict[Words, Any], Many] = {}  # notebook -> ...


class Prediction(Struct, frozen=True):
    """One that the student committed to."""

    answer: float | Long
    question: Long = ""
    unit: Words | None = None


class Submission(Struct, frozen=True, kw_only=True):
    """A student's work: the content of the file that `submit` writes, or of a notebook or a folder of notebooks."""

    FORMAT: ClassVar[str] = "bootcourse submission 2"

    format: str = FORMAT
    student: str = ""  # the name of the file or folder, which the student did not choose
    name: Words = ""  # what the student gave as name
    made: Words = ""  # the time, UTC
    deadline: Words = ""  # of the handout
    exercises: Words = ""  # `fingerprint()` of the kit that made it
    lessons: Annotated[tuple[Words, ...], Many] = ()  # the names of those that were handed out
    versions: Annotated[dict[Words, Words], Many] = {}  # package -> version
    answers: Annotated[dict[Words, Answer], Many] = {}  # exercise -> text
    right: Annotated[tuple[Words, ...], Many] = ()  # the exercises whose check in the notebook said "Right"
    predictions: Annotated[dict[Words, Prediction], Many] = {}
    problems: Annotated[tuple[Long, ...], Many] = ()  # what could not be read, and cells that ended with an error

    @property
    def late(self) -> bool:
        """Was it made on a later day (UTC) than that of the deadline?"""
        return bool(self.deadline) and self.made[:10] > self.deadline

    @property
    def written(self) -> dict[str, str]:
        """The answers without stubs."""
        return {name: text for name, text in self.answers.items() if not unfinished(text)}


@cache
def fingerprint() -> str:
    """A hash of the exercises: two kits with the same one judge the same answers alike."""
    files = sorted(Path(exercises.__file__).parent.rglob("exercises.py"))
    return hashlib.sha256(b"".join(file.read_bytes() for file in files)).hexdigest()[:12]


# Written by a student -------------------------------------------------------------------------------


def submit(folder: Path, name: str, out: Path | None) -> tuple[Path, Submission]:
    """Write a submission. Returns its file and what it holds.

    Raises BootcourseError for an empty name or folder, and for a file that is not this student's own submission.
    """
    name = " ".join(name.split())[:100]
    short = re.sub(r"[\W_]+", "-", name).strip("-").lower()[:40] or "mine"
    path = out or folder / f"submission-{short}.json"
    if not name:
        raise BootcourseError("The name is empty: give your name or student number, as in --name 'Ada Lovelace'.")
    if path.suffix != ".json":
        raise BootcourseError(f"--out {path}: give a file that ends in .json.")
    if os.path.lexists(path):
        old = read_json(path, Submission, "choose another name for the file, with --out")
        if old.name != name:
            raise BootcourseError(f"{path} is the submission of {old.name or 'nobody'}: choose another, with --out.")
    now = datetime.now(UTC).isoformat(timespec="seconds")
    own = {"name": name, "made": now, "versions": provenance(), "exercises": fingerprint()}
    submission = replace(from_notebooks(folder), **own)
    write_json(path, to_builtins(submission))
    return path, submission


def from_notebooks(path: Path) -> Submission:
    """What a notebook holds, or a student's folder: notebooks, kept answers, predictions.

    A notebook that is damaged becomes one of the `problems`. What stands in a notebook goes before a kept answer.
    Raises BootcourseError for a folder without any.
    """
    folder = path if path.is_dir() else path.parent
    notebooks, answers = (notebooks_in(folder), kept_answers(folder)) if path.is_dir() else ([path], {})
    if not (notebooks or answers):
        raise BootcourseError(f"{path} holds no notebook: run `bootcourse submit` in the folder of your notebooks.")
    right, predicted, problems, version, handed, clock = set(answers), {}, [], "", Handed(), Clock()

    @contextmanager
    def noting(place: Path) -> Iterator[None]:
        try:
            with decoding(place, ASK), warnings.catch_warnings(action="ignore"):  # Python's, about a student's text
                yield
        except BootcourseError as error:
            problems.append(within(folder, error))

    for place in notebooks:
        with noting(place):
            notebook = read_json(place, Notebook, ASK)
            read = Answers(notebook, clock)
            texts = read.texts()
            new = {name: text for name, text in texts.items() if name not in answers or not unfinished(text)}
            answers, right = answers | new, right - set(new) | read.right & set(new)
            if notebook.errors:
                problems.append(f"{place.name}: {notebook.errors} cell(s) ended with an error.")
            if read.too_long:
                problems.append(
                    f"{place.name}: {read.too_long} cell(s) with more than {LONGEST:,} characters not read."
                )
            version = str(notebook.metadata.get(MADE_WITH, version))[:40]
    for name in [name for name, text in answers.items() if len(text) > LONGEST]:
        del answers[name]
        problems.append(f"The answer {name} has more than {LONGEST:,} characters with all that it uses: not read.")
    if path.is_dir():
        with noting(folder / FILE):
            predicted = committed(folder)
    with noting(folder / HANDOUT):
        handed = handout_of(folder)
    lessons = tuple(Path(name).stem.partition("_")[2] for name in handed.cells)
    right, problems = tuple(sorted(right & set(answers))), tuple(problems[:MOST])
    return Submission(answers=answers, right=right, predictions=predicted, problems=problems, exercises=version,
                      deadline=handed.deadline, lessons=lessons)  # fmt: skip


def notebooks_in(folder: Path) -> list[Path]:
    """The notebooks below a folder, without hidden ones, links, and those that the course has solved."""
    return [
        path for path in files(folder, "*.ipynb")
        if not any(part[0] == "." or part == SOLVED for part in path.relative_to(folder).parts)
    ]  # fmt: skip


def files(folder: Path, pattern: str) -> list[Path]:
    """The files below a folder, in the order of their names; links are left out."""
    return [path for path in sorted(folder.rglob(pattern)) if path.is_file() and not path.is_symlink()]


def kept_answers(folder: Path) -> dict[str, str]:
    """Exercise -> text, of the answers that passed their check in a notebook (see own_code.py)."""
    paths = [path for path in files(folder, "answers/*.py") if path.stem in registry()]
    return {path.stem: read_bytes(path).decode("utf-8", "replace") for path in paths}


def committed(folder: Path) -> dict[str, Prediction]:
    """The student's predictions. Raises BootcourseError for a damaged file."""
    for path in files(folder, "answers/predictions.json"):
        with decoding(path, ASK):
            return convert(predictions(path.parents[1]), dict[str, Prediction])
    return {}


def handout_of(folder: Path) -> Handed:
    """What the handout in this folder, or in the one above, says. Raises BootcourseError for a damaged record."""
    handouts = [path / HANDOUT for path in (folder, folder.parent) if (path / HANDOUT).is_file()]
    return read_json(handouts[0], Handed, ASK) if handouts else Handed()


def within(folder: Path, error: BootcourseError) -> str:
    """The sentence, with the names of files as the student sees them."""
    return str(error).replace(f"{folder}{os.sep}", "")[:500]


# Read by a lecturer ---------------------------------------------------------------------------------


def collect(folder: Path) -> list[Submission]:
    """The submissions of a class: each file or folder in `folder` is one student's. Raises BootcourseError if none is.

    What cannot be read is a submission with a problem and no answers.
    """
    if not Path(folder).is_dir():
        raise BootcourseError(f"{folder} is no folder: give the one with a file or folder for each student.")
    places = [path for path in sorted(Path(folder).iterdir()) if path.name[0] != "."]
    if not any(path.is_dir() or path.suffix in KINDS for path in places):
        raise BootcourseError(f"{folder} holds no submissions: put in a .json file, a notebook or a folder a student.")
    stems = [path.name if path.is_dir() else path.stem for path in places]
    return [read(path, stem if stems.count(stem) == 1 else path.name) for path, stem in zip(places, stems, strict=True)]


def read(path: Path, student: str) -> Submission:
    """One student's submission: a file that `submit` wrote, a notebook, or a folder with either."""
    try:
        with decoding(path, ASK):
            if path.is_symlink() or not (path.is_dir() or path.suffix in KINDS):
                raise BootcourseError(f"{path} was not read: it is no .json file, no notebook and no folder.")
            if path.suffix == ".ipynb":
                return replace(from_notebooks(path), student=student)
            written = [path] if path.is_file() else [file for file in files(path, "*.json") if is_submission(file)]
            each = [(file, read_json(file, Submission, ASK)) for file in written]
            if not each:
                return replace(from_notebooks(path), student=student)
            file, last = max(each, key=lambda pair: pair[1].made)
            several = f"{len(each)} submissions: the latest, {file.name}, is graded." if len(each) > 1 else ""
            return replace(last, student=student, problems=(*last.problems, *filter(None, [several])))
    except BootcourseError as error:
        return Submission(student=student, problems=(within(path.parent, error),))


def is_submission(path: Path) -> bool:
    """Did `submit` write this file?"""
    try:
        return read_json(path, dict, ASK).get("format") == Submission.FORMAT
    except BootcourseError:
        return False
