"""The instructor's page of a lesson, made from its source and from what its exercises know.

Timings, the questions to ask before a cell is run, each exercise with a right answer, and the
changes that make it wrong, with what the check says.
"""

import re
from pathlib import Path

from bootcourse.course.exercise import Exercise
from bootcourse.course.lessons import registry, stem
from tools.course.claims import filled
from tools.course.source import Cell, lesson_of, one_folder_down, title


def page(path: Path) -> str:
    """The whole page, as markdown."""
    cells = filled(path)
    file = f"{stem(lesson_of(path))}.ipynb"
    solved = f" · [solved](../solved/{file})" if any(cell.is_exercise for cell in cells) else ""
    parts = [
        f"# For the instructor: {title(cells)}",
        f"[Notebook](../{file}){solved}. Made from `bootcourse/course/lessons/{lesson_of(path)}`: change it there.",
        timings(cells),
    ]
    for heading, inside in sections(cells):
        pieces = [piece for cell in inside for piece in of_cell(cell)]
        if pieces:
            parts += [f"## {heading}", *pieces]
    return "\n\n".join(part for part in parts if part) + "\n"


def sections(cells: list[Cell]) -> list[tuple[str, list[Cell]]]:
    """The cells under each `##` heading; what comes before the first is called the beginning."""
    parts = [("The beginning", [])]
    for cell in cells:
        heading = re.search(r"^## (.+)", cell.text, re.M)
        if heading:
            parts.append((heading[1], []))
        parts[-1][1].append(cell)
    return parts


def timings(cells: list[Cell]) -> str:
    """The lesson's own line about time, and a table: minutes of talk (metadata `minutes`) and of exercises."""
    own = [
        one_folder_down(m)
        for cell in cells
        for m in re.findall(r"^\*\*Time\*\*.*?(?=\n\n|\n\*\*|\Z)", cell.text, re.M | re.S)
    ]
    rows = []
    for heading, inside in sections(cells):
        talk, work = together(inside)
        if talk or work:
            rows.append(f"| {heading} | {talk or ''} | {work or ''} |")
    if not rows:
        return "\n\n".join(own)
    head = ["| part | talk (min) | exercises (min) |", "|---|---|---|"]
    talk, work = together(cells)
    return "\n\n".join([*own, "\n".join([*head, *rows, f"| **together** | **{talk}** | **{work}** |"])])


def together(cells: list[Cell]) -> tuple[int, int]:
    """The minutes of talk and of exercises."""
    talk = sum(cell.metadata.get("minutes", 0) for cell in cells)
    return talk, sum(exercise.minutes for cell in cells for exercise in exercises(cell))


def exercises(cell: Cell) -> list[Exercise]:
    return [registry()[name] for name in cell.checks if name in registry()]


def of_cell(cell: Cell) -> list[str]:
    """What a cell contributes: its predictions and questions, its exercises, or all of it if it is the instructor's."""
    if cell.is_code:
        return [of_exercise(exercise, cell) for exercise in exercises(cell)]
    if cell.for_instructor:
        return [one_folder_down(cell.student)]
    asked = [f"*Ask first:*\n\n{text.strip()}" for text in predictions(cell.student)]
    questions = re.findall(r"^\*\*Three questions.*?\n((?:[-\d] ?.*\n?(?:  .*\n?)*)+)", cell.student, re.M)
    return asked + [f"*To discuss:*\n\n{one_folder_down(text.strip())}" for text in questions]


def predictions(text: str) -> list[str]:
    """The quoted paragraphs that begin with **Predict.**"""
    return re.findall(r"^> \*\*Predict\.\*\*.*(?:\n>.*)*", text, re.M)


def of_exercise(exercise: Exercise, cell: Cell) -> str:
    rows = [f"| {code(mistake.change)} | {in_table(mistake.says)} |" for mistake in exercise.mistakes]
    return "\n".join(
        [
            f"### Exercise `{exercise.name}` ({exercise.minutes} min, {exercise.dots})",
            "",
            f"{exercise.equation}. A right answer:",
            "",
            "```python",
            re.sub(r"^check\..*", "", cell.solved, flags=re.M).rstrip(),
            "```",
            "",
            "| A wrong change of it | The check says |",
            "|---|---|",
            *rows,
            "",
            "Hints, on request:",
            "",
            *(f"{number}. {hint}" for number, hint in enumerate(exercise.hints, start=1)),
        ]
    )


def code(change: str) -> str:
    """A change of the solution, in a table."""
    return f"`{in_table(change)}`" if change else ""


def in_table(text: str) -> str:
    return " ".join(text.split()).replace("|", r"\|")
