"""The paper map, book/paper_map.md, made from book/paper_map.toml: `python -m tools.course.paper_map`.

The data lists the paper's equations, tables, figures and its algorithm in the order of its LaTeX source,
section by section. Numbers are those that LaTeX gives them.
"""

import math
import pkgutil
import re
import tomllib
from dataclasses import dataclass
from functools import cache

from bootcourse.course.lessons import registry
from tools.course.problems import exists
from tools.course.reference import BOOK, everything, link, mentions
from tools.course.source import read, sources

DATA, PAGE = BOOK / "paper_map.toml", BOOK / "paper_map.md"
HEADINGS = ("in the paper", "what it is, and where it is in the kit", "taught in", "note")
SPACE = "&nbsp;"  # so that a narrow column keeps "Equation 7" in one line


@dataclass(frozen=True)
class Taught:
    """A lesson that teaches an item, and what in it does: an exercise, or some words or code that stand there."""

    lesson: str  # "07_soft_constraint"
    exercise: str = ""
    words: str = ""


@dataclass(frozen=True)
class Item:
    """A numbered thing of the paper, and where it is in the kit."""

    section: str
    kind: str
    number: int
    what: str
    code: list[str]
    taught: list[Taught]
    note: str = ""  # how the kit deviates
    see: str = ""  # where left_open.md says more

    @property
    def label(self) -> str:
        return f"{self.kind.capitalize()} {self.number}"


@dataclass(frozen=True)
class Value:
    """A number that the paper prints, and the settings that hold it (their product, where it is several)."""

    where: str
    symbol: str
    what: str
    printed: float | list  # a list is a range
    unit: str
    code: list[str]


@cache
def data() -> dict:
    return tomllib.loads(DATA.read_text(encoding="utf-8"))


def items() -> list[Item]:
    """All items, in the order of the paper."""
    return [
        Item(**entry | {"section": section["title"], "taught": [Taught(**each) for each in entry["taught"]]})
        for section in data()["section"]
        for entry in section["item"]
    ]


def values() -> list[Value]:
    """The printed numbers, in the order of the paper."""
    return [Value(**entry) for entry in data()["value"]]


def in_code(value: Value):
    """What the kit takes for a printed number by default."""
    found = [pkgutil.resolve_name(name) for name in value.code]
    return list(found[0]) if isinstance(found[0], tuple) else math.prod(found)


# What is wrong with it ------------------------------------------------------------------------------


def problems() -> list[str]:
    """What the data says and the kit does not hold, as sentences; an empty list if all is well."""
    found = []
    for item in items():
        found += [f"{item.label}: `{name}` does not exist." for name in item.code if not exists(name)]
        found += [f"{item.label}: {problem}" for taught in item.taught for problem in of_taught(item, taught)]
        if not item.code or not item.taught:
            found.append(f"{item.label}: it needs code and a lesson.")
        if bool(item.note) != bool(item.see):
            found.append(f"{item.label}: a note goes with a heading of left_open.md, and it with a note.")
    return found


def of_taught(item: Item, taught: Taught) -> list[str]:
    """Is the lesson there, and does it teach the item by what the data says that it does?"""
    if not (paths := sources([taught.lesson])):
        return [f"there is no lesson {taught.lesson}."]
    text = everything(paths[0])
    if taught.exercise and not exercise_number(taught.lesson, taught.exercise):
        return [f"{taught.lesson} has no exercise {taught.exercise}."]
    if taught.words and not mentions(text, taught.words):
        return [f"'{taught.words}' does not stand in {taught.lesson}."]
    names = [name.rsplit(".", 1)[1] for name in item.code]
    if not taught.exercise and not taught.words and not any(mentions(text, name) for name in [*names, item.label]):
        return [f"{taught.lesson} mentions none of {', '.join(names)}."]
    return []


@cache
def exercise_number(lesson: str, exercise: str) -> str:
    """ "7.2" of an exercise, from the cell that announces it; "" if this lesson has no such exercise."""
    if exercise not in registry() or registry()[exercise].lesson != lesson:
        return ""
    announced = ""
    for cell in read(sources([lesson])[0]):
        number = re.findall(r"\*\*Exercise (\d+\.\d+)", cell.student)
        announced = number[-1] if number else announced
        if exercise in cell.checks:
            return announced
    return ""


# The page -------------------------------------------------------------------------------------------


def page() -> str:
    """The whole page, as Markdown."""
    parts = ["# Where the paper is in the kit", data()["introduction"].strip()]
    for title in dict.fromkeys(item.section for item in items()):
        rows = [row(item) for item in items() if item.section == title]
        parts += [f"## {title}", table(HEADINGS, rows)]
    parts += ["## Every printed number", data()["about_values"].strip()]
    for where in dict.fromkeys(value.where for value in values()):
        rows = [value_row(value) for value in values() if value.where == where]
        parts += [f"### {where}", table(("symbol", "what it is", "printed", "in the kit"), rows)]
    return "\n\n".join(["<!-- Made by tools/course/paper_map.py from paper_map.toml: change that. -->", *parts]) + "\n"


def row(item: Item) -> list[str]:
    """One line of a table: the code stands under the words, since a column of its own would take half of the page."""
    taught = []
    for each in item.taught:
        number = exercise_number(each.lesson, each.exercise) if each.exercise else ""
        taught.append(link(each.lesson, f"exercise {number}" if number else None))
    note = f"{item.note} ([more](#{item.see}))" if item.note else ""
    label, lessons = (text.replace(" ", SPACE) for text in (item.label, "<br>".join(taught)))
    return [f"**{label}**", "<br>".join([item.what, *(f"`{name}`" for name in item.code)]), lessons, note]


def value_row(value: Value) -> list[str]:
    printed = value.printed if isinstance(value.printed, list) else [value.printed]
    text = " to ".join(f"{number:g}".replace("-", "−") for number in printed)
    return [value.symbol, value.what, f"{text} {value.unit}".strip(), " × ".join(f"`{name}`" for name in value.code)]


def table(headings, rows) -> str:
    lines = [headings, ["---"] * len(headings), *rows]
    return "\n".join("| " + " | ".join(" ".join(cell.split()) for cell in line) + " |" for line in lines)


if __name__ == "__main__":
    PAGE.write_text(page(), encoding="utf-8")
