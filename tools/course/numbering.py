"""Where a text names a lesson: its number and its file follow from the place of its name in `LESSONS`.

    lesson [[the_rule]]          lesson 3, in a page of the book as a link
    [the rule](the_rule.ipynb)   [the rule](03_the_rule.ipynb)
    [](the_rule.ipynb)           [The rule](03_the_rule.ipynb)

Rows of a table that begin with the number of a lesson are put in the order of the lessons. README's table of lessons is
made: what a lesson offers stands in its folder's `__init__.py`, its title and its time in its text.
"""

import ast
import re
from functools import cache
from itertools import groupby
from pathlib import Path

from bootcourse.course.lessons import LESSONS, number, stem

ROOT = Path(__file__).resolve().parent.parent.parent
NOTEBOOKS = ROOT / "notebooks"
LESSON_FOLDERS = ROOT / "bootcourse/course/lessons"
KEPT = ("README.md", "book/cloud.md", "tests/check.txt")  # read as they are, so they hold the numbers themselves
NAMED = re.compile(r"\[\[(\w+)\]\]")
NAME = "|".join(sorted(LESSONS, key=len, reverse=True))
FILE = re.compile(rf"(?<=[/(])({NAME})(?=\.(?:ipynb|md|html)\b)")
UNTITLED = re.compile(rf"\[\](?=\(({NAME})\.ipynb\))")
ROW = re.compile(r"\| \[\[(\w+)\]\]")
# By hand: "lesson 3", "Lessons 4 and 7" or "03_the_rule.ipynb".
BY_HAND = re.compile(rf"(?<!-)\b[Ll]essons?\s+\d|\b\d\d_(?:{NAME})\b")


def text_file(lesson: str) -> Path:
    """The file of a lesson's text, which people edit."""
    return LESSON_FOLDERS / lesson / "text.py"


def resolved(text: str, folder: str | None = None) -> str:
    """A text with the numbers, titles and files of the lessons that it names. Raises ValueError for no lesson.

    folder: where a page of the book finds the lessons, "lessons/"; there each number is a link.
    """
    text = "".join(in_order(list(rows)) for _, rows in groupby(text.splitlines(keepends=True), is_row))
    text = FILE.sub(lambda match: stem(match[1]), UNTITLED.sub(lambda match: f"[{title(match[1])}]", text))
    link = "{0}" if folder is None else f"[{{0}}]({folder}{{1}}.ipynb)"
    return NAMED.sub(lambda match: link.format(number(known(match[1])), stem(match[1])), text)


def is_row(line: str) -> bool:
    return bool(ROW.match(line))


def in_order(lines: list[str]) -> str:
    """These lines; if they are rows that begin with a lesson, sorted."""
    if is_row(lines[0]):
        lines.sort(key=lambda line: LESSONS.index(known(ROW.match(line)[1])))
    return "".join(lines)


def known(lesson: str) -> str:
    if lesson not in LESSONS:
        raise ValueError(f"[[{lesson}]]: there is no such lesson")
    return lesson


@cache
def title(lesson: str) -> str:
    """A lesson's title, as the first heading of its text says it."""
    return re.search(r"^# # (.+)", text_file(lesson).read_text(encoding="utf-8"), re.M)[1]


def minutes(lesson: str) -> int:
    """The time of a lesson, as it states it at its top."""
    return int(re.search(r"^# \*\*Time\*\* (\d+) minutes", text_file(lesson).read_text(encoding="utf-8"), re.M)[1])


def offer(lesson: str) -> str:
    """What a student will do in a lesson: the docstring of its folder. Raises ValueError for a folder without one."""
    said = ast.get_docstring(ast.parse((LESSON_FOLDERS / lesson / "__init__.py").read_text(encoding="utf-8"))) or ""
    if not said.startswith("You will "):
        raise ValueError(f'{lesson}/__init__.py says {said!r}: write one sentence there, """You will ...""".')
    return " ".join(said.split()).removeprefix("You will ").removesuffix(".")


def table_row(lesson: str) -> str:
    """A lesson's row in README's table."""
    file = f"notebooks/{stem(lesson)}.ipynb"
    return f"| {number(lesson)} | [{title(lesson)}]({file}) | {offer(lesson)} | {minutes(lesson)} |\n"


def refreshed(text: str) -> str:
    """A page that holds the numbers itself, brought up to date: names of files, and README's table of lessons."""
    text = re.sub(rf"\b\d\d_({NAME})(?=\.ipynb)", lambda match: stem(match[1]), text)
    rows = "".join(table_row(lesson) for lesson in LESSONS)
    return re.sub(r"(^\| \d+ \| \[[^]]*\]\(notebooks/\w+\.ipynb\).*\n)+", lambda _: rows, text, flags=re.M)


def refresh_kept() -> None:
    """Bring the pages of `KEPT` up to date."""
    for path in (ROOT / name for name in KEPT):
        text = path.read_text(encoding="utf-8")
        if text != (new := refreshed(text)):
            path.write_text(new, encoding="utf-8")
