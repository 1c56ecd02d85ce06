"""What the book's reference pages share: what a lesson says, and how to link to it.

The pages are book/paper_map.md (made by `paper_map.py`), left_open.md, glossary.md and bibliography.md.
The book puts a lesson's notebook beside them as lessons/NAME.ipynb; its build finds dead links.
"""

import re
from functools import cache
from pathlib import Path

from tools.course.source import NOTEBOOKS, read, sources

BOOK = NOTEBOOKS.parent / "book"


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


def text_of(page: Path) -> str:
    return page.read_text(encoding="utf-8")
