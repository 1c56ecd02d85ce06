"""All files of a grading: the tables, a feedback page for each student, the page about the class."""

import sys
from collections.abc import Sequence
from pathlib import Path

from bootcourse.classroom import tables
from bootcourse.classroom.grading import Graduate
from bootcourse.classroom.pages import class_page, feedback, file_names
from bootcourse.files import write_bytes

ALL = {"network", "processes", "files"}


def write_report(graduates: Sequence[Graduate], points: dict[str, float], out: Path, holds: list[str]) -> list[Path]:
    """Write them beside `out`, the wide table. Returns the main files."""
    answers, pages = out.with_name(f"{out.stem}-answers.csv"), out.with_name(f"{out.stem}-pages")
    tables.write(tables.wide(graduates), out)
    tables.write(tables.long(graduates), answers)
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
