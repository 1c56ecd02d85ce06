"""The paper map, a page of the book, made from book/paper_map.toml.

The data lists the paper's equations, tables, figures and its algorithm in the order of its LaTeX source, section by
section. Numbers are those that LaTeX gives them.
"""

import math
import pkgutil
import re
import tomllib
from functools import cache

from bootcourse.course.lessons import registry, stem
from tools.course.numbering import ROOT
from tools.course.source import read, sources

HEADINGS = ("in the paper", "what it is, and where it is in the kit", "taught in", "note")
SPACE = "&nbsp;"  # so that a narrow column keeps "Equation 7" in one line


@cache
def data() -> dict:
    return tomllib.loads((ROOT / "book/paper_map.toml").read_text(encoding="utf-8"))


def items() -> list[dict]:
    """All items, in the order of the paper, each with its section."""
    return [item | {"section": section["title"]} for section in data()["section"] for item in section["item"]]


def in_code(value: dict):
    """What the kit takes by default for a number that the paper prints."""
    defaults = [pkgutil.resolve_name(name) for name in value["code"]]
    return list(defaults[0]) if isinstance(defaults[0], tuple) else math.prod(defaults)


@cache
def exercise_numbers() -> dict[str, str]:
    """exercise -> its number, such as "7.2", from the cell that announces it."""
    numbers, announced = {}, ""
    for cell in (cell for path in sources() for cell in read(path)):
        announced = ([announced] + re.findall(r"\*\*Exercise (\d+\.\d+)", cell.text))[-1]
        numbers |= dict.fromkeys(cell.checks, announced)
    return numbers


def page() -> str:
    """The whole page, as Markdown. Raises ValueError where an item has no code, or names what does not exist."""
    parts = ["# Where the paper is in the kit", data()["introduction"].strip()]
    for title in dict.fromkeys(item["section"] for item in items()):
        rows = [row(item) for item in items() if item["section"] == title]
        parts += [f"## {title}", table(HEADINGS, rows)]
    parts += ["## Every printed number", data()["about_values"].strip()]
    for where in dict.fromkeys(value["where"] for value in data()["value"]):
        rows = [value_row(value) for value in data()["value"] if value["where"] == where]
        parts += [f"### {where}", table(("symbol", "what it is", "printed", "in the kit"), rows)]
    return "\n\n".join(parts) + "\n"


def row(item: dict) -> list[str]:
    """One line of a table: the code stands under the words, since a column of its own would take half of the page."""
    label = f"{item['kind'].capitalize()} {item['number']}"
    if not item["code"] or bool(item.get("note")) != bool(item.get("see")):
        raise ValueError(f"{label} needs code, and a note goes with a heading of left_open.md.")
    for name in item["code"]:
        pkgutil.resolve_name(name)  # raises if it is gone
    taught = [lesson_link(label, **each) for each in item["taught"]] or ["only in the code"]
    note = f"{item['note']} ([more](#{item['see']}))" if "note" in item else ""
    label, lessons = (text.replace(" ", SPACE) for text in (label, "<br>".join(taught)))
    return [f"**{label}**", "<br>".join([item["what"], *(f"`{name}`" for name in item["code"])]), lessons, note]


def lesson_link(label: str, lesson: str, exercise: str = "") -> str:
    """A link to the lesson that teaches an item. Raises ValueError where the exercise is another lesson's."""
    if not exercise:
        return f"lesson [[{lesson}]]"
    if registry()[exercise].lesson != stem(lesson):
        raise ValueError(f"{label}: {exercise} is no exercise of {lesson}.")
    return f"[exercise {exercise_numbers()[exercise]}](lessons/{lesson}.ipynb)"


def value_row(value: dict) -> list[str]:
    printed = value["printed"] if isinstance(value["printed"], list) else [value["printed"]]
    text = " to ".join(f"{number:g}".replace("-", "−") for number in printed)
    code = " × ".join(f"`{name}`" for name in value["code"])
    return [value["symbol"], value["what"], f"{text} {value['unit']}".strip(), code]


def table(headings, rows) -> str:
    lines = [headings, ["---"] * len(headings), *rows]
    return "\n".join("| " + " | ".join(" ".join(cell.split()) for cell in line) + " |" for line in lines)
