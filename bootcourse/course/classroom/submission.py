"""What a student hands in, as one JSON file: answers, verdicts, predictions, versions, a name. Nothing is run."""

import hashlib
import os
import re
from dataclasses import asdict, dataclass, field
from datetime import UTC, datetime
from functools import cache
from pathlib import Path

from bootcourse.course import lessons as exercises
from bootcourse.course.classroom.answers import answers_in, errors_in, unfinished, verdicts_in
from bootcourse.course.edition import HANDOUT
from bootcourse.course.lessons import registry
from bootcourse.course.predictions import predictions
from bootcourse.errors import BootcourseError
from bootcourse.files import provenance, read_bytes, read_json, write_json

FORMAT = "bootcourse submission 1"

ASK = "ask for it again"  # the remedy for a damaged file
LONGEST = 50_000  # characters of an answer
SOLVED = "solved"  # the folder, beside the lessons, with the course's own answers


@dataclass(frozen=True)
class Submission:
    """student: the name of its file or folder, which the student did not choose; name: what the student calls it."""

    student: str = ""
    name: str = ""
    made: str = ""  # the time, UTC
    deadline: str = ""  # of the handout
    exercises: str = ""  # `fingerprint()` of the kit that made it
    versions: dict[str, str] = field(default_factory=dict)  # package -> version
    answers: dict[str, str] = field(default_factory=dict)  # exercise -> text
    verdicts: dict[str, str] = field(default_factory=dict)  # exercise -> what the check said to the student
    predictions: dict[str, dict] = field(default_factory=dict)
    problems: tuple[str, ...] = ()  # what could not be read, and cells that ended with an error

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
    files = sorted(Path(exercises.__file__).parent.glob("*.py"))
    return hashlib.sha256(b"".join(file.read_bytes() for file in files)).hexdigest()[:12]


def from_folder(folder: Path, name: str = "") -> Submission:
    """All that a student's folder holds: notebooks, kept answers, predictions. Raises BootcourseError if it is empty.

    A notebook that is damaged becomes one of the `problems`. What stands in a notebook goes before a kept answer.
    """
    notebooks = notebooks_in(folder)
    found, said, problems = {}, {}, []
    for path in sorted(folder.rglob("answers/*.py")):
        if path.stem in registry() and path.is_file() and not path.is_symlink():
            found[path.stem] = read_bytes(path).decode("utf-8", "replace")[:LONGEST]
    kept, made_by = dict(found), ""
    for path in notebooks:
        try:
            notebook = read_json(path, dict, ASK)
        except BootcourseError as error:
            problems.append(str(error).replace(f"{folder}{os.sep}", ""))
            continue
        here = {n: text[:LONGEST] for n, text in answers_in(notebook).items()}
        found |= {n: text for n, text in here.items() if n not in kept or not unfinished(text)}
        said |= verdicts_in(notebook)
        if wrong := errors_in(notebook):
            problems.append(f"{path.name}: {wrong} cell{'s' * (wrong > 1)} ended with an error.")
        told = notebook.get("metadata", {}).get("bootcourse", {}) if isinstance(notebook.get("metadata"), dict) else {}
        made_by = str(told.get("exercises", made_by))[:40] if isinstance(told, dict) else made_by
    if not (notebooks or found):
        raise BootcourseError(f"{folder} holds no notebook: run `bootcourse submit` in the folder of your notebooks.")
    try:
        places = [path.parents[1] for path in folder.rglob("answers/predictions.json") if not path.is_symlink()]
        foretold = predictions(places[0]) if places else {}
    except BootcourseError as error:
        foretold, problems = {}, [*problems, str(error)]
    return Submission(
        name=name, exercises=made_by, answers=found, verdicts=said, predictions=foretold, problems=tuple(problems),
        deadline=deadline_of(folder),
    )  # fmt: skip


def notebooks_in(folder: Path) -> list[Path]:
    """The notebooks of a folder and of those in it, in the order of their names.

    Hidden ones, links, and those that the course has solved are left out.
    """

    def left_out(path: Path) -> bool:
        return any(part.startswith(".") or part == SOLVED for part in path.relative_to(folder).parts)

    found = [path for path in Path(folder).rglob("*.ipynb") if path.is_file() and not path.is_symlink()]
    return sorted(path for path in found if not left_out(path))


def deadline_of(folder: Path) -> str:
    """The deadline that the handout in this folder, or in the one above, was given."""
    for path in (folder / HANDOUT, folder.parent / HANDOUT):
        if path.is_file():
            return str(read_json(path, dict).get("deadline", ""))[:40]
    return ""


def submit(folder: Path, name: str, out: Path | None = None) -> tuple[Path, Submission]:
    """Write a submission. Returns its file and what it holds. Raises BootcourseError for an empty name or folder."""
    if not name.strip():
        raise BootcourseError("The name is empty: give your name or student number, as in --name 'Ada Lovelace'.")
    made = from_folder(folder, " ".join(name.split())[:100])
    now = datetime.now(UTC).isoformat(timespec="seconds")
    told = asdict(made) | {"format": FORMAT, "made": now, "versions": provenance(), "exercises": fingerprint()}
    told.pop("student")
    path = out or folder / f"submission-{re.sub(r'[^A-Za-z0-9]+', '-', name).strip('-').lower() or 'mine'}.json"
    write_json(path, told)
    return path, made
