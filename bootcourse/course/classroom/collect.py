"""The submissions of a class, read from a folder. Nothing is run.

What is read may come from anybody: each part is checked, what is too long is left out, and what remains is only text.
"""

import os
import re
from collections.abc import Iterable
from dataclasses import replace
from pathlib import Path

from bootcourse.course.classroom.answers import answers_in, verdicts_in
from bootcourse.course.classroom.submission import ASK, FORMAT, LONGEST, Submission, from_folder
from bootcourse.course.lessons import registry
from bootcourse.errors import BootcourseError
from bootcourse.files import read_json


def collect(folder: Path) -> list[Submission]:
    """The submissions of a class: each file or folder in `folder` is one student's. Raises BootcourseError if none is.

    What cannot be read is a submission with a problem and no answers.
    """
    if not Path(folder).is_dir():
        raise BootcourseError(f"{folder} is no folder: give the one with a file or folder for each student.")
    places = [
        path for path in sorted(Path(folder).iterdir()) if not path.name.startswith(".") and not path.is_symlink()
    ]
    places = [path for path in places if path.is_dir() or path.suffix in (".json", ".ipynb")]
    if not places:
        raise BootcourseError(f"{folder} holds no submissions: put in a .json file, a notebook or a folder a student.")
    stems = [path.stem if path.is_file() else path.name for path in places]
    return [read(path, stem if stems.count(stem) == 1 else path.name) for path, stem in zip(places, stems, strict=True)]


def read(path: Path, student: str) -> Submission:
    """One student's submission: a file that `submit` wrote, a notebook, or a folder with either."""
    try:
        if path.suffix == ".json" and path.is_file():
            return from_file(path, student)
        if path.is_file():
            return replace(one_notebook(path), student=student)
        files = [file for file in sorted(path.rglob("*.json")) if not file.is_symlink() and is_submission(file)]
        return from_file(files[-1], student) if files else replace(from_folder(path), student=student)
    except BootcourseError as error:
        return Submission(student=student, problems=(str(error).replace(f"{path.parent}{os.sep}", ""),))


def one_notebook(path: Path) -> Submission:
    notebook = read_json(path, dict, ASK)
    answers = {name: text[:LONGEST] for name, text in answers_in(notebook).items()}
    return Submission(answers=answers, verdicts=verdicts_in(notebook))


def is_submission(path: Path) -> bool:
    try:
        return read_json(path, dict, ASK).get("format") == FORMAT
    except BootcourseError:
        return False


def from_file(path: Path, student: str) -> Submission:
    """A file that `submit` wrote. Raises BootcourseError if it is none."""
    told = read_json(path, dict, ASK)
    if told.get("format") != FORMAT:
        raise BootcourseError(f"{path.name} is no submission: it does not say “{FORMAT}”.")
    answers = {name: text for name, text in texts(told.get("answers")) if name in registry()}
    long = [name for name, text in answers.items() if len(text) > LONGEST]
    return Submission(
        student=student,
        answers={name: text for name, text in answers.items() if name not in long},
        verdicts={name: text[:2000] for name, text in texts(told.get("verdicts")) if name in registry()},
        versions=dict(list(texts(told.get("versions")))[:50]),
        predictions=checked_predictions(told.get("predictions")),
        problems=(
            *(text[:500] for text in list(told.get("problems") or ())[:50] if isinstance(text, str)),
            *(f"The answer {name} is longer than {LONGEST} characters, and is left out." for name in long),
        ),
        **{key: str(told.get(key, ""))[:100] for key in ("name", "made", "deadline", "exercises")},
    )


def texts(value: object) -> Iterable[tuple[str, str]]:
    """The pairs of a JSON object whose values are texts."""
    return [(k, v) for k, v in value.items() if isinstance(v, str)] if isinstance(value, dict) else []


def checked_predictions(value: object) -> dict[str, dict]:
    """Those that have a number and an answer that is a text or a number."""
    pairs = value.items() if isinstance(value, dict) else ()
    return {
        number: {"question": str(one.get("question", ""))[:500], "unit": one.get("unit") and str(one["unit"])[:40],
                 "answer": one["answer"] if isinstance(one["answer"], float) else str(one["answer"])[:2000]}
        for number, one in pairs
        if re.fullmatch(r"\d{1,2}\.\d{1,2}", number) and isinstance(one, dict)
        and isinstance(one.get("answer"), (str, int, float))
    }  # fmt: skip
