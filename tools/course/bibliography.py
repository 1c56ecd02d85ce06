"""The entries of book/bibliography.md, and what the lessons and the library cite."""

import ast
import re
from dataclasses import dataclass
from functools import cache
from pathlib import Path

from tools.course.reference import BOOK, text_of
from tools.course.source import read, sources

PAGE = BOOK / "bibliography.md"
LIBRARY = BOOK.parent / "bootcourse"
NUMBER = r"\d{4}\.\d{4,5}"
ARXIV = re.compile(rf"\barXiv[\s:]+({NUMBER})")
PROCEEDINGS = ("https://proceedings.mlr.press/", "https://proceedings.neurips.cc/")  # for what has no DOI
CITED_YEAR = re.compile(r"\(((?:19|20)\d\d)\)|(?<=[a-z] )((?:19|20)\d\d)(?=[,;:)])")
NEARBY = 250  # letters before a year in which its author's name must stand


@dataclass(frozen=True)
class Entry:
    """One entry of the bibliography."""

    group: str
    text: str

    @property
    def authors(self) -> str:
        return re.match(r"\*\*(.+?) \(\d{4}\)\.\*\*", self.text)[1]

    @property
    def first_author(self) -> str:
        """The surname of the first author."""
        return self.authors.split(",")[0]

    @property
    def year(self) -> str:
        return re.match(r"\*\*.+? \((\d{4})\)\.\*\*", self.text)[1]

    @property
    def arxiv(self) -> list[str]:
        """Its arXiv number, as printed and as linked to."""
        return re.findall(rf"\[arXiv ({NUMBER})\]\(https://arxiv\.org/abs/({NUMBER})\)", self.text)

    @property
    def doi(self) -> list[str]:
        """Its DOI, as printed and as linked to."""
        found = re.findall(r"\[DOI (\S+?)\]\(https://doi\.org/([^)\s]+)\)", self.text)
        return [(printed, linked.replace("%28", "(").replace("%29", ")")) for printed, linked in found]

    @property
    def isbn(self) -> list[str]:
        return [number.replace("-", "") for number in re.findall(r"\bISBN ([\dX-]+)", self.text)]

    @property
    def proceedings(self) -> list[str]:
        return [link for link in re.findall(r"\]\((https:[^)\s]+)\)", self.text) if link.startswith(PROCEEDINGS)]

    @property
    def lessons(self) -> list[str]:
        """The lessons that it is for: "07_soft_constraint"."""
        return re.findall(r"\]\(lessons/(\w+)\.ipynb\)", self.text)

    @property
    def code(self) -> list[str]:
        """The code that it is for, as dotted names."""
        return re.findall(r"`(bootcourse[\w.]+)`", self.text)


def entries() -> list[Entry]:
    """The entries in the order of the page, with the heading that each stands under."""
    found = []
    for group, body in re.findall(r"^## (.+)\n((?:(?!## ).*\n?)*)", text_of(PAGE), re.M):
        found += [Entry(group, " ".join(each.split())) for each in re.split(r"^- ", body, flags=re.M)[1:]]
    return found


def valid_isbn(number: str) -> bool:
    """Does the last figure of an ISBN check the others?"""
    if len(number) == 13:
        return sum(int(figure) * (3 if i % 2 else 1) for i, figure in enumerate(number)) % 10 == 0
    figures = [10 if figure == "X" else int(figure) for figure in number]
    return len(figures) == 10 and sum((10 - i) * figure for i, figure in enumerate(figures)) % 11 == 0


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


def cited_numbers() -> dict[str, list[str]]:
    """Every arXiv number that is cited, and where."""
    found: dict[str, list[str]] = {}
    for where, text in citing().items():
        for number in ARXIV.findall(text):
            found.setdefault(number, []).append(where)
    return found


def cited_years() -> list[tuple[str, str, str]]:
    """Every year that cites something: (the year, what stands before it, where)."""
    return [
        (match[1] or match[2], text[max(0, match.start() - NEARBY) : match.start()], where)
        for where, text in citing().items()
        for match in CITED_YEAR.finditer(text)
    ]
