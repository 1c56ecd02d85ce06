"""The grades as CSV: a wide table to import, with one column an exercise, and a long one with one row an answer."""

import csv
import io
from collections.abc import Sequence
from pathlib import Path

from bootcourse.classroom.grading import Graduate
from bootcourse.files import write_bytes
from bootcourse.lessons.exercises import registry

LONG = ("student", "exercise", "lesson", "result", "passed", "points", "named mistake", "version")


def wide(graduates: Sequence[Graduate]) -> list[list]:
    """id, name, points, then the points of each exercise."""
    exercises = [grade.exercise for grade in graduates[0].grades] if graduates else []
    rows = [["id", "name", "points", *exercises]]
    return rows + [
        [one.submission.student, one.submission.name, number(one.points), *(number(g.points) for g in one.grades)]
        for one in graduates
    ]


def long(graduates: Sequence[Graduate]) -> list[list]:
    """One row for each student and exercise. version: of the kit that the submission names."""
    rows = [list(LONG)]
    for one in graduates:
        version = one.submission.versions.get("bootcourse", "")
        for grade in one.grades:
            lesson = registry()[grade.exercise].lesson
            rows.append([one.submission.student, grade.exercise, lesson, grade.kind, int(grade.passed),
                         number(grade.points), grade.belief and grade.sentence, version])  # fmt: skip
    return rows


def number(value: float) -> str:
    return f"{value:g}"


def write(rows: list[list], path: Path) -> None:
    """A CSV file, in UTF-8, which spreadsheets also read. Raises BootcourseError if it cannot be written."""
    text = io.StringIO()
    csv.writer(text, lineterminator="\r\n").writerows([[harmless(cell) for cell in row] for row in rows])
    write_bytes(path, text.getvalue().encode("utf-8-sig", "replace"))


def harmless(cell: object) -> object:
    """A text that a spreadsheet would take for a formula gets an apostrophe."""
    return f"'{cell}" if isinstance(cell, str) and cell.startswith(("=", "+", "-", "@", "\t", "\r")) else cell
