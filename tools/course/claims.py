"""The numbers and the claims in a text, and the page that shows those of the lessons to readers.

In a markdown cell of a source `{{ expression }}` or `{{ expression | .1f }}` (a format of Python's) becomes a
number, and `<!-- claim: expression -->` behind a sentence must be true. Expressions name what known.py has, and what
numbers.py in the lesson's folder has.
"""

import re
import runpy
from dataclasses import replace
from functools import cache
from pathlib import Path

from tools.course.numbering import LESSON_FOLDERS
from tools.course.source import CLAIM, NUMBER, Cell, lesson_of, read, sources, title
from tools.course.stressed import HEAD as HEAD_OF_LAST
from tools.course.stressed import survived

HEAD = """# Where the numbers come from

Numbers in the text of a lesson are computed when the lesson is made, from the library and from the results that ship
with it. Behind some sentences stand claims, which must be true or the lesson is not made. Here is each paragraph that
has either, with the expressions; they name what `tools/course/known.py`
and `numbers.py` in the lesson's folder have. Numbers that are not here are shown by
a cell of their lesson, quoted from a publication that the text names, or invented for a question."""


def filled(path: Path) -> list[Cell]:
    """The cells of a source with their numbers. Raises ValueError: what has no value, what is claimed and not true."""
    cells, lesson = read(path), lesson_of(path)
    check_claims("\n".join(cell.text for cell in cells), lesson)
    both = ((cell, fill_in(cell.text, lesson)) for cell in cells)
    both = ((cell, text + survived(lesson) * text.startswith(HEAD_OF_LAST)) for cell, text in both)
    return [cell if cell.is_code else replace(cell, student=text, solved=text) for cell, text in both]


def check_claims(text: str, lesson: str = "") -> None:
    """Raises ValueError for each claim in a text that is not True: a number is not, the comparison is missing."""
    values = {claim: value(claim, lesson) for claim in claims(text)}
    if false := [claim for claim, result in values.items() if str(result) != "True"]:
        raise ValueError("\n".join(f"The claim `{claim}` is {values[claim]!r}" for claim in false))


def claims(text: str) -> list[str]:
    return [" ".join(expression.split()) for expression in CLAIM.findall(text)]


def fill_in(text: str, lesson: str = "") -> str:
    """The text with its numbers and without its claims. Raises ValueError where one of them is not closed."""
    text = NUMBER.sub(lambda match: printed(match[1], match[2], lesson), CLAIM.sub("", text))
    if left := re.search(r"(\{\{ |<!--).{,60}", text):
        raise ValueError(f"`{left[0]}` is neither a number nor a claim")
    return text


def printed(expression: str, form: str | None, lesson: str) -> str:
    """A value as the text prints it: 10.0 as 10, -1 with a true minus sign."""
    result = value(expression := " ".join(expression.split()), lesson)
    form = form or ("g" if isinstance(result, float) else "")
    try:
        return re.sub(r"(?<!\w)-(?=[\d.])", "−", format(result, form))
    except (TypeError, ValueError) as error:
        raise ValueError(f"`{expression}` cannot be printed as {form} ({error})") from error


@cache
def value(expression: str, lesson: str = ""):
    """What an expression is. Raises ValueError where it has no value."""
    try:
        return eval(expression, names(lesson))
    except Exception as error:  # whatever it raises is the writer's to see
        raise ValueError(f"`{expression}` has no value ({type(error).__name__}: {error})") from error


@cache
def names(lesson: str) -> dict:
    """What an expression in a lesson's text may name."""
    from tools.course import known

    own = LESSON_FOLDERS / lesson / "numbers.py"
    return vars(known) | (runpy.run_path(str(own)) if lesson and own.exists() else {})


def claims_page() -> str:
    """Each paragraph with numbers or claims, of all lessons, and what they come from, as Markdown."""
    parts = [HEAD]
    for path in sources():
        cells = read(path)
        parts_of_cells = [part for cell in cells for part in paragraphs(cell.text)]
        entries = [entry(part, lesson_of(path)) for part in parts_of_cells if NUMBER.search(part) or CLAIM.search(part)]
        parts += [f"## {title(cells)}", *entries] if entries else []
    return "\n\n".join(parts) + "\n"


def paragraphs(text: str) -> list[str]:
    """A text's paragraphs, list items and headings. An expression stays whole, though a line in it begins with `- `."""
    for expression in (NUMBER, CLAIM):
        text = expression.sub(lambda match: re.sub(r"\n\s*", " ", match[0].lstrip()), text)
    return re.split(r"\n\s*\n|\n(?=- |\d+\. |#)", text)


def without_links(text: str) -> str:
    """The text with the words of its links alone."""
    return re.sub(r"\[([^]]*)\]\([^)]*\)", r"\1", text)


def entry(paragraph: str, lesson: str) -> str:
    """A paragraph, quoted without its links, and a point for each of its expressions."""
    words = without_links(fill_in(paragraph, lesson))
    quoted = re.sub(r"^(?:> ?)?", "> ", words, flags=re.M)
    values = [(" ".join(match[1].split()), printed(*match.groups(), lesson)) for match in NUMBER.finditer(paragraph)]
    points = [f"- `{expression}` = {value}" if "\n" not in value else f"- `{expression}`: the list above"
              for expression, value in values]  # fmt: skip
    points += [f"- `{claim}` is true" for claim in claims(paragraph)]
    return "\n".join([quoted, "", *dict.fromkeys(points)])
