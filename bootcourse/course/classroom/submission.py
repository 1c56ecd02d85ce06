"""What a student hands in, as one JSON file: answers, predictions, a name. Nothing is run.

Such a file may come from anybody: one reader checks every field, and what it returns is only text.
"""

import hashlib
import os
import re
import unicodedata
import warnings
from collections.abc import Iterator, Sequence
from contextlib import contextmanager
from datetime import UTC, datetime
from functools import cache
from pathlib import Path
from typing import Annotated, ClassVar

from msgspec import Meta, Struct, convert, to_builtins
from msgspec.structs import replace

from bootcourse.course import lessons as exercises
from bootcourse.course.classroom.answers import LONGEST, Answers, Clock, read_notebook, unfinished
from bootcourse.course.lessons import LESSONS
from bootcourse.course.predictions import FILE, predictions
from bootcourse.errors import BootcourseError
from bootcourse.files import decoding, read_json, unix_lines, write_json

ASK = "ask for it again"  # a lecturer's remedy for a damaged file
SAVE = "open it in JupyterLab, save it, and submit again"  # a student's
MOST = 200  # predictions, and as many problems
KINDS = (".json", ".ipynb")  # of files that a student hands in
SOLVED = "solved"  # the folder, beside the lessons, with the course's own answers

Words = Annotated[str, Meta(max_length=200)]
Long = Annotated[str, Meta(max_length=2000)]
Answer = Annotated[str, Meta(max_length=LONGEST)]
Many = Meta(max_length=MOST)


class Prediction(Struct, frozen=True):
    """One that the student committed to."""

    answer: float | Long
    question: Long = ""
    unit: Words | None = None


class Submission(Struct, frozen=True, kw_only=True):
    """A student's work: the content of the file that `submit` writes, or of a notebook or a folder of notebooks."""

    FORMAT: ClassVar[str] = "bootcourse submission 3"

    format: str = FORMAT
    student: str = ""  # the name of the file or folder, which the student did not choose
    name: Words = ""  # what the student gave as name
    time: Words = ""  # UTC
    exercises: Words = ""  # `fingerprint()` of the kit that made it
    lessons: Annotated[tuple[Words, ...], Many] = ()  # the names of those whose notebooks the student has
    answers: Annotated[dict[Words, Answer], Many] = {}  # exercise -> text
    right: Annotated[tuple[Words, ...], Many] = ()  # the exercises whose check in the notebook said "Right"
    predictions: Annotated[dict[Words, Prediction], Many] = {}
    problems: Annotated[tuple[Long, ...], Many] = ()  # what could not be read

    @property
    def written(self) -> dict[str, str]:
        """The answers without stubs."""
        return {name: text for name, text in self.answers.items() if not unfinished(text)}


@cache
def fingerprint() -> str:
    """A hash of the exercises and of what judges them: two kits with the same one judge the same answers alike."""
    lessons = Path(exercises.__file__).parent
    files = sorted([*lessons.rglob("*.py"), *lessons.parent.glob("*.py")])
    return hashlib.sha256(b"".join(unix_lines(file.read_bytes()) for file in files)).hexdigest()[:12]


# Written by a student -------------------------------------------------------------------------------


def submit(folder: Path, name: str, out: Path | None) -> tuple[Path, Submission]:
    """Write a submission. Returns its file and what it holds.

    Raises BootcourseError for an empty name, for no folder or one without notebooks, and for a file that is not this
    student's own submission.
    """
    name = " ".join(composed(name.encode("utf-8", "replace").decode()).split())[:100]
    short = re.sub(r"[\W_]+", "-", name).strip("-").lower()[:40] or "mine"
    path = out or (folder.parent if folder.is_file() else folder) / f"submission-{short}.json"
    if not name:
        raise BootcourseError("The name is empty: give your name or student number, as in --name 'Ada Lovelace'.")
    if path.suffix != ".json":
        raise BootcourseError(f"--out {path}: give a file that ends in .json.")
    if not folder.exists():
        raise BootcourseError(f"{folder} is not there: give the folder with your notebooks.")
    if os.path.lexists(path):
        old = read_json(path, Submission, "choose another name for the file, with --out")
        if composed(old.name) != name:
            raise BootcourseError(f"{path} is the submission of {old.name or 'nobody'}: choose another, with --out.")
    now = datetime.now(UTC).isoformat(timespec="seconds")
    submission = replace(from_notebooks(folder, around(folder), SAVE), name=name, time=now, exercises=fingerprint())
    write_json(path, to_builtins(submission))
    return path, submission


def composed(name: str) -> str:
    """A name whose accents are part of their letters, however it was typed: macOS often gives them apart."""
    return unicodedata.normalize("NFC", name)


def from_notebooks(path: Path, others: Sequence[Path] = (), remedy: str = ASK) -> Submission:
    """What a notebook holds, or a student's folder: notebooks and predictions.

    others: folders that may hold predictions, too. A notebook that is damaged becomes one of the `problems`, with the
    remedy. Raises BootcourseError for a folder without any.
    """
    folder = path if path.is_dir() else path.parent
    notebooks = notebooks_in(folder) if path.is_dir() else [path]
    if not notebooks:
        raise BootcourseError(f"{path} holds no notebook: run `bootcourse submit` in the folder of your notebooks.")
    answers, right, predicted, problems, clock = {}, set(), {}, [], Clock()

    @contextmanager
    def noting(place: Path) -> Iterator[None]:
        try:
            with decoding(place, remedy), warnings.catch_warnings(action="ignore"):  # Python's, about a student's text
                yield
        except BootcourseError as error:
            problems.append(within(folder, error))

    for place in notebooks:
        with noting(place):
            read = Answers(read_notebook(place, remedy), clock)
            texts = read.texts()
            new = {name: text for name, text in texts.items() if name not in answers or not unfinished(text)}
            answers, right = answers | new, right - set(new) | read.right & set(new)
    for name in [name for name, text in answers.items() if len(text) > LONGEST]:
        del answers[name]
        problems.append(f"The answer {name} has more than {LONGEST:,} characters with all that it uses: not read.")
    for place in prediction_files(path, others):
        with noting(place):
            kept = predictions(place.parents[1])
            for question, one in convert(kept, dict[str, Prediction]).items():  # the first answer to a question stays
                dated = str(kept[question].get("time", "")), one
                predicted[question] = min(predicted.get(question, dated), dated, key=lambda pair: pair[0])
    predicted = {question: one for question, (_, one) in predicted.items()}
    right, problems = tuple(sorted(right & set(answers))), tuple(problems[:MOST])
    named = {notebook.stem.partition("_")[2] for notebook in notebooks}  # its number may have been another one
    lessons = tuple(name for name in LESSONS if name in named)
    return Submission(answers=answers, right=right, predictions=predicted, problems=problems, lessons=lessons)


def around(path: Path) -> list[Path]:
    """The folders where a student's predictions may be: this one, the one above, and where the student is now.

    A kernel that is not told where its notebook lies keeps them where it works: in the folder that was opened.
    """
    folder = (path if path.is_dir() else path.parent).resolve()
    return list(dict.fromkeys([folder, folder.parent, Path.cwd()]))


def prediction_files(path: Path, others: Sequence[Path] = ()) -> list[Path]:
    """The files of predictions: below a student's folder, not beside a single notebook, and in the other folders."""
    found = files(path, str(FILE)) if path.is_dir() else []
    found += [place for each in others if (place := each / FILE).is_file()]
    return list({place.resolve(): place for place in reversed(found)}.values())[::-1]


def notebooks_in(folder: Path) -> list[Path]:
    """The notebooks below a folder, without hidden ones, links, and those that the course has solved."""
    return [
        path for path in files(folder, "*.ipynb")
        if not any(part[0] == "." or part == SOLVED for part in path.relative_to(folder).parts)
    ]  # fmt: skip


def files(folder: Path, pattern: str) -> list[Path]:
    """The files below a folder, in the order of their names; what a link leads to is left out."""
    here = folder.resolve()
    found = [path for path in sorted(folder.rglob(pattern)) if path.is_file()]
    return [path for path in found if path.resolve() == here / path.relative_to(folder)]


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
    names = [path.name if path.is_dir() else path.stem for path in places]
    while len(set(names)) < len(names):  # such as of ada.ipynb and the folder ada
        names = [path.name if names.count(name) > 1 else name for path, name in zip(places, names, strict=True)]
    return [read(path, name) for path, name in zip(places, names, strict=True)]


def read(path: Path, student: str) -> Submission:
    """One student's submission: a file that `submit` wrote, a notebook, or a folder with either."""
    try:
        with decoding(path, ASK):
            if path.is_symlink() or not (path.is_dir() or path.suffix in KINDS):
                raise BootcourseError(f"{path} was not read: it is no .json file, no notebook and no folder.")
            written = [path] if path.is_file() else filter(is_submission, files(path, "*.json"))
            each = [read_json(file, Submission, ASK) for file in written if file.suffix == ".json"]
            latest = max(each, key=lambda one: one.time) if each else from_notebooks(path)
            return replace(latest, student=student)
    except BootcourseError as error:
        return Submission(student=student, problems=(within(path.parent, error),))


def is_submission(path: Path) -> bool:
    """Did `submit` write this file?"""
    try:
        return read_json(path, dict, ASK).get("format") == Submission.FORMAT
    except BootcourseError:
        return False
