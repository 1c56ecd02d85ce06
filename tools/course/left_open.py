"""The gaps that book/left_open.md lists: each a heading with a target, and four parts."""

import re
from dataclasses import dataclass

from tools.course.reference import BOOK, text_of

PAGE = BOOK / "left_open.md"
KINDS = ("Misprint", "Silence", "Reading", "Result")
PARTS = ("In the paper.", "What follows.", "In the kit.", "Taught in")


@dataclass(frozen=True)
class Gap:
    """One gap in the paper, and what the kit does about it."""

    target: str  # "open-clock"
    kind: str
    title: str
    parts: dict[str, str]  # by the names in `PARTS`, with single spaces

    @property
    def code(self) -> list[str]:
        """The dotted names of what the kit does."""
        return re.findall(r"`(bootcourse[\w.]+)`", self.parts.get("In the kit.", ""))

    @property
    def lessons(self) -> list[str]:
        return re.findall(r"\]\(lessons/(\w+)\.ipynb\)", self.parts.get("Taught in", ""))


def gaps() -> list[Gap]:
    """All gaps, in the order of the page."""
    found = []
    pattern = r"^(?:\(([\w-]+)\)=\n)?### (?:(\w+): )?(.+)\n((?:(?!##|\([\w-]+\)=).*\n?)*)"
    for target, kind, title, body in re.findall(pattern, text_of(PAGE), re.M):
        pieces = re.split(r"^\*\*([^*]+)\*\*", body, flags=re.M)
        parts = {name: " ".join(text.split()) for name, text in zip(pieces[1::2], pieces[2::2], strict=True)}
        found.append(Gap(target, kind, title, parts))
    return found
