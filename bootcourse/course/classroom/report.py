"""All files of a grading: two tables as CSV, a feedback page for each student, the page about the class.

The wide table is one to import, with one column an exercise; the long one has one row an answer.
"""

import csv
import io
import sys
from collections.abc import Sequence
from pathlib import Path

from bootcourse.course.classroom.grading import Graduate
from bootcourse.course.classroom.pages import class_page, feedback, file_names
from bootcourse.course.lessons import registry
from bootcourse.files import write_bytes

ALL = {"network", "processes", "files"}
LONG = ("student", "exercise", "lesson", "result", "passed", "points", "named mistake", "version")


def write_report(graduates: Sequence[Graduate], points: dict[str, float], out: Path, holds: list[str]) -> list[Path]:
    """Write them beside `out`, the wide table. Returns the main files."""
    answers, pages = out.with_name(f"{out.stem}-answers.csv"), out.with_name(f"{out.stem}-pages")
    write(wide(graduates), out)
    write(long(graduates), answers)
    names = file_names(graduates)
    for one in graduates:
        write_bytes(pages / names[one.submission.student], feedback(one, points).encode("utf-8", "replace"))
    index = pages / "class" / "index.html"
    links = {student: f"../{file}" for student, file in names.items()}
    write_bytes(index, class_page(graduates, points, links, shut_in(holds)).encode("utf-8", "replace"))
    return [out, answers, index]


def shut_in(holds: list[str]) -> str:
    """A sentence about what the answers could reach while they were judged; nothing if nothing was judged."""
    missing = sorted(ALL - set(holds))
    if not holds and sys.platform == "linux":
        return ""
    if not missing:
        return "Answers were judged without network, with files and processes of their own."
    return f"On this system an answer could reach your {' and '.join(missing)} while it was judged."


def wide(graduates: Sequence[Graduate]) -> list[list]:
    """id, name, points, then the points of each exercise."""
    exercises = [grade.exercise for grade in graduates[0].grades] if graduates else []
    rows = [["id", "name", "points", *exercises]]
    return rows + [
        [one.submission.student, one.submission.name, f"{one.points:g}", *(f"{g.points:g}" for g in one.grades)]
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
                         f"{grade.points:g}", grade.sentence if grade.known else "", version])  # fmt: skip
    return rows


def write(rows: list[list], path: Path) -> None:
    """A CSV file, in UTF-8, which spreadsheets also read. Raises BootcourseError if it cannot be written."""
    text = io.StringIO()
    csv.writer(text).writerows([[harmless(cell) for cell in row] for row in rows])
    write_bytes(path, text.getvalue().encode("utf-8-sig", "replace"))


def harmless(cell: object) -> object:
    """A text that a spreadsheet would take for a formula gets an apostrophe."""
    return f"'{cell}" if isinstance(cell, str) and cell.startswith(("=", "+", "-", "@", "\t", "\r")) else cell
