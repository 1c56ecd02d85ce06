"""The numbers and the claims in a lesson's text, and the page that shows them to readers.

In a markdown cell of a source `{{ expression }}` or `{{ expression | .1f }}` (a format of Python's) becomes a
number, and `<!-- claim: expression -->` behind a sentence must be true. Expressions name what known.py has.
"""

import re
from dataclasses import replace
from functools import cache
from pathlib import Path

from tools.course.source import CLAIM, NUMBER, Cell, read, sources, title

HEAD = """# Where the numbers come from

Numbers in the text of a lesson are computed when the lesson is made, from the library and from the results that ship
with it. Behind some sentences stand claims, which must be true or the lesson is not made. Here is each paragraph that
has either, with the expressions; they name what `tools/course/known.py` lists. Numbers that are not here are shown by
a cell of their lesson, quoted from a publication that the text names, or invented for a question."""


def filled(path: Path) -> list[Cell]:
    """The cells of a source with their numbers. Raises ValueError: what has no value, what is claimed and not true."""
    cells = read(path)
    if false := [claim for cell in cells for claim in claims(cell.text) if not holds(claim)]:
        raise ValueError("\n".join(f"The claim `{claim}` is {value(claim)!r}" for claim in false))
    texts = [fill_in(cell.text) for cell in cells]
    both = zip(cells, texts, strict=True)
    return [cell if cell.is_code else replace(cell, student=text, solved=text) for cell, text in both]


def fill_in(text: str) -> str:
    """The text with its numbers and without its claims. Raises ValueError where one of them is not closed."""
    text = NUMBER.sub(lambda match: printed(match[1], match[2]), CLAIM.sub("", text))
    if left := re.search(r"(\{\{ |<!--).{,60}", text):
        raise ValueError(f"`{left[0]}` is neither a number nor a claim")
    return text


def claims(text: str) -> list[str]:
    return [" ".join(expression.split()) for expression in CLAIM.findall(text)]


def holds(claim: str) -> bool:
    """Is it true? A number is not, whatever it is: the comparison is missing."""
    return str(value(claim)) == "True"


def printed(expression: str, form: str | None) -> str:
    """A value as the text prints it: 10.0 as 10, -1 with a true minus sign."""
    result = value(expression := " ".join(expression.split()))
    form = form or ("g" if isinstance(result, float) else "")
    try:
        return format(result, form).replace("-", "−")
    except (TypeError, ValueError) as error:
        raise ValueError(f"`{expression}` cannot be printed as {form} ({error})") from error


@cache
def value(expression: str):
    """What an expression is. Raises ValueError where it has no value."""
    from tools.course import known

    try:
        return eval(expression, vars(known))
    except Exception as error:  # whatever it raises is the writer's to see
        raise ValueError(f"`{expression}` has no value ({type(error).__name__}: {error})") from error


def blocks(text: str) -> list[str]:
    """The paragraphs, points and tables of a markdown cell, each with its claims."""
    return [block for block in re.split(r"\n\s*\n|\n(?=- |\d+\. |#)", text) if block.strip()]


def claims_page() -> str:
    """Each paragraph with numbers or claims, of all lessons, and what they come from, as Markdown."""
    parts = [HEAD]
    for path in sources():
        cells = read(path)
        entries = [entry(block) for cell in cells for block in blocks(cell.text) if is_computed(block)]
        parts += [f"## {title(cells)}", *entries] if entries else []
    return "\n\n".join(parts) + "\n"


def entry(block: str) -> str:
    """A paragraph, quoted, and a point for each of its expressions."""
    words = re.sub(r"\[([^]]*)\]\([^)]*\)", r"\1", fill_in(block))  # without links: the page stands elsewhere
    quoted = re.sub(r"^(?:> ?)?", "> ", words, flags=re.M)
    points = [f"- `{' '.join(match[1].split())}` = {printed(*match.groups())}" for match in NUMBER.finditer(block)]
    points += [f"- `{claim}` is true" for claim in claims(block)]
    return "\n".join([quoted, "", *dict.fromkeys(points)])


def is_computed(block: str) -> bool:
    return bool(NUMBER.search(block) or CLAIM.search(block))
