"""The entries of book/bibliography.md, and what the lessons and the library cite."""

import ast
import re
from dataclasses import dataclass
from functools import cache
from pathlib import Path
from urllib.parse import unquote

from tools.course.reference import BOOK, text_of
from tools.course.source import read, sources

PAGE = BOOK / "bibliography.md"
LIBRARY = BOOK.parent / "bootcourse"
ARXIV = re.compile(r"\barXiv[\s:]+(\d{4}\.\d{4,5})")
ADDRESSES = ("https://proceedings.mlr.press/", "https://proceedings.neurips.cc/", "https://github.com/")
CITED_YEAR = re.compile(r"\(((?:19|20)\d\d)\)|(?<=[a-z] )((?:19|20)\d\d)(?=[,;:)])")
NEARBY = 250  # letters before a year in which its author's name must stand


@dataclass(frozen=True)
class Entry:
    """One entry of the bibliography."""

    group: str
    text: str

    @property
    def first_author(self) -> str:
        """The surname of the first author."""
        return re.match(r"\*\*(.+?),", self.text)[1]

    @property
    def year(self) -> str:
        return re.match(r"\*\*.+? \((\d{4})\)\.\*\*", self.text)[1]

    @property
    def numbers(self) -> list[tuple[str, str]]:
        """Its arXiv number and its DOI, as printed and as linked to."""
        found = re.findall(r"\[(?:arXiv|DOI) (\S+)\]\(https://(?:arxiv\.org/abs|doi\.org)/([^)\s]+)\)", self.text)
        return [(printed, unquote(linked)) for printed, linked in found]

    @property
    def can_be_found(self) -> bool:
        """Has it a number, or the address of its proceedings or its code?"""
        return bool(self.numbers or re.search(rf"\bISBN [\dX-]{{10}}|{'|'.join(ADDRESSES)}", self.text))

    @property
    def lessons(self) -> list[str]:
        """The lessons that it is for: "07_soft_constraint"."""
        return re.findall(r"\]\(lessons/(\w+)\.ipynb\)", self.text)


def entries() -> list[Entry]:
    """The entries in the order of the page, with the heading that each stands under."""
    found = []
    for group, body in re.findall(r"^## (.+)\n((?:(?!## ).*\n?)*)", text_of(PAGE), re.M):
        found += [Entry(group, " ".join(each.split())) for each in re.split(r"^- ", body, flags=re.M)[1:]]
    return found


@cache
def citing() -> dict[str, str]:
    """What may cite something: {where: text}, the lessons' text and the strings of the library's files."""
    found = {path.stem: " ".join(lesson_text(path).split()) for path in sources()}
    for path in sorted(LIBRARY.rglob("*.py")):
        found[str(path.relative_to(LIBRARY.parent))] = " ".join(strings(path))
    return found


def lesson_text(path: Path) -> str:
    """All text of a lesson, the notes for its instructor included."""
    return "\n\n".join(cell.words for cell in read(path) if not cell.is_code)


def strings(path: Path) -> list[str]:
    """All strings of a Python file, its docstrings among them, with single spaces."""
    tree = ast.parse(path.read_text(encoding="utf-8"))
    texts = [node.value for node in ast.walk(tree) if isinstance(node, ast.Constant) and isinstance(node.value, str)]
    return [" ".join(text.split()) for text in texts]


def cited_numbers() -> list[tuple[str, str]]:
    """Every arXiv number that is cited, and where."""
    return [(number, where) for where, text in citing().items() for number in ARXIV.findall(text)]


def cited_years() -> list[tuple[str, str, str]]:
    """Every year that cites something: (the year, what stands before it, where)."""
    return [
        (match[1] or match[2], text[max(0, match.start() - NEARBY) : match.start()], where)
        for where, text in citing().items()
        for match in CITED_YEAR.finditer(text)
    ]
