"""What the book's reference pages share: what a lesson says, and what is wrong with a page's links and names.

The pages are book/paper_map.md (made by `paper_map.py`), left_open.md, glossary.md and bibliography.md.
The book puts a lesson's notebook beside them as lessons/NAME.ipynb, and the report as report/report.md.
"""

import re
from functools import cache
from pathlib import Path

from tools.course.problems import exists
from tools.course.source import NOTEBOOKS, read, sources

BOOK = NOTEBOOKS.parent / "book"
IN_THE_BOOK = {"lessons/": "notebooks/", "report/": "assets/report/"}  # folders that the book gets from elsewhere


@cache
def lessons() -> dict[int, Path]:
    """The lessons' sources by number: {7: .../07_soft_constraint.py}."""
    return {int(path.stem[:2]): path for path in sources()}


@cache
def prose(path: Path) -> str:
    """All text of a lesson that a student reads, its cells apart by empty lines."""
    return "\n\n".join(cell.words for cell in read(path) if not cell.is_code and not cell.for_instructor)


@cache
def everything(path: Path) -> str:
    """The text and the code of a lesson, solved."""
    return "\n\n".join(cell.solved if cell.is_code else cell.words for cell in read(path) if not cell.for_instructor)


def mentions(text: str, name: str) -> bool:
    """Does a name, or a few words, stand in a text as whole words?"""
    return re.search(rf"(?<!\w){re.escape(name)}(?!\w)", " ".join(text.split())) is not None


def link(lesson: str, words: str | None = None) -> str:
    """A link from a page of the book to a lesson: "07_soft_constraint" -> [lesson 7](lessons/...)."""
    return f"[{words or f'lesson {int(lesson[:2])}'}](lessons/{lesson}.ipynb)"


def targets() -> list[str]:
    """The names that a page can be linked to at: a line (NAME)= before a heading."""
    return [name for page in sorted(BOOK.glob("*.md")) for name in re.findall(r"^\(([\w-]+)\)=$", text_of(page), re.M)]


def text_of(page: Path) -> str:
    return page.read_text(encoding="utf-8")


def page_problems(page: Path) -> list[str]:
    """Links that lead nowhere and code that does not exist, as sentences; an empty list if there is none."""
    text, found = text_of(page), []
    for name in re.findall(r"`(bootcourse(?:\.\w+)+)", text):
        if not exists(name):
            found.append(f"{page.name}: the code that `{name}` names does not exist.")
    for address in re.findall(r"\]\(([^)\s]+)\)", text):
        file, _, target = address.partition("#")
        if re.match(r"[a-z]+:", address):
            continue
        if file and not leads_to(file).exists():
            found.append(f"{page.name}: the link {address} leads to no file.")
        if target and not file and target not in targets():
            found.append(f"{page.name}: the link {address} leads to no heading.")
    return found


def leads_to(file: str) -> Path:
    """Where a file that the book shows stands in the repository."""
    for folder, source in IN_THE_BOOK.items():
        if file.startswith(folder):
            return BOOK.parent / source / file.removeprefix(folder)
    return BOOK / file
