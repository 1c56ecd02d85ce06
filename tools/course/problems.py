"""What is wrong with a lesson, as sentences: its exercises, predictions, names of code, freshness.

That no link is dead is for the book's build to find.
"""

import ast
import inspect
import pkgutil
import re
import textwrap
from pathlib import Path

from bootcourse.course.lessons import registry, stem
from tools.course.claims import filled
from tools.course.instructor import together
from tools.course.products import is_out_of_date, student_file
from tools.course.source import Cell, arguments_of, body, function_in, lesson_of

MISREAD = re.compile(r"^(?:%|\d+\) )", re.M)
SHOWN_AS_LAST = ("table", "predict", "compare_predictions", "progress", "source")  # they return what is shown


def problems(path: Path) -> list[str]:
    """Everything that is wrong with a source and what was made from it; an empty list if nothing is."""
    try:
        cells = filled(path)
    except ValueError as error:
        return [f"{error}."]
    wrong = [
        *of_exercises(cells, lesson_of(path)),
        *of_predictions(cells, lesson_of(path)),
        *of_references(cells),
        *of_lost(cells),
        *of_lines(cells),
        *of_minutes(cells),
    ]
    if wrong:
        return wrong
    return [f"{student_file(path).name} is out of date: run make notebooks."] if is_out_of_date(path) else []


def begins(text: str) -> str:
    return f"The cell that begins with `{text.strip().splitlines()[0]}`"


def of_minutes(cells: list[Cell]) -> list[str]:
    """The lesson's time is the sum of what its sections and exercises take."""
    said = [int(each) for cell in cells for each in re.findall(r"^\*\*Time\*\* (\d+) minutes", cell.text, re.M)]
    talk, work = together(cells)
    return [] if said == [talk + work] else [f"**Time** says {said}, and the rows add up to {talk + work} minutes."]


# Exercises ------------------------------------------------------------------------------------------


def of_exercises(cells: list[Cell], lesson: str) -> list[str]:
    """Used and registered exercises are the same; each stands as the writers' README says."""
    used = [name for cell in cells for name in cell.checks]
    own = [exercise.name for exercise in registry().values() if exercise.lesson == stem(lesson)]
    wrong = [f"check.{name}: no such exercise is registered." for name in used if name not in registry()]
    wrong += [f"check.{name} belongs to lesson {registry()[name].lesson}." for name in used
              if name in registry() and name not in own]  # fmt: skip
    wrong += [f"The exercise {name} of this lesson is not used in it." for name in own if name not in used]
    for before, cell in zip([None, *cells], cells, strict=False):
        if cell.is_exercise and len(cell.checks) != 1:
            wrong.append(f"{begins(cell.solved)} has a solution but not exactly one check.")
        for name in cell.checks:
            if name in own:
                wrong += of_exercise(name, cell, before)
    return wrong


def of_exercise(name: str, cell: Cell, before: Cell | None) -> list[str]:
    """The announcement, the stub and the solution of one exercise."""
    exercise, wrong = registry()[name], []
    heading = f"({exercise.minutes} min, {exercise.dots})"
    if before is None or "**Exercise" not in before.student or heading not in before.student:
        wrong.append(f"{name}: the markdown cell above has to announce it, **Exercise {heading}.**")
    stub, solved = function_in(cell.student, name), function_in(cell.solved, name)
    if stub is None or solved is None:
        return [*wrong, f"{name}: its cell defines no function of that name."]
    if arguments_of(stub) != exercise.arguments:
        wrong.append(f"{name}: its stub takes other arguments than `{exercise.call}`.")
    if not ast.get_docstring(stub):
        wrong.append(f"{name}: its stub has no docstring with shapes and units.")
    if not cell.is_exercise:
        wrong.append(f"{name}: its cell has no `# solution` ... `# end solution`.")
    return wrong + of_solution(exercise, solved)


def of_solution(exercise, solved: ast.FunctionDef | ast.ClassDef) -> list[str]:
    """A solution that stands beside the exercise, and is shown on request, is the one in the source."""
    if not exercise.solution.__module__.endswith(".exercises"):
        return []  # the library's own, or a helper's
    shown = ast.parse(textwrap.dedent(inspect.getsource(exercise.solution))).body[0]
    if not isinstance(shown, (ast.FunctionDef, ast.ClassDef)):
        return [f"{exercise.name}: write its solution with def or class, so that it can be shown."]
    if body(shown) != body(solved):
        return [f"{exercise.name}: the source's solution is not the one that check.solution shows."]
    return []


# Predictions ----------------------------------------------------------------------------------------


def of_predictions(cells: list[Cell], lesson: str) -> list[str]:
    """Each prediction has a name of its own that begins with the lesson's, and the lesson's end compares them all."""
    code = "\n".join(cell.solved for cell in cells if cell.is_code)
    asked = re.findall(r"(?<![\w.])predict\(\s*[\"']([^\"']*)", code)
    compared = code.rpartition("compare_predictions(")[2] if "compare_predictions(" in code else ""
    problems = [f"The prediction {name} does not begin with {lesson}." for name in asked
                if name.partition(".")[0] != lesson]  # fmt: skip
    problems += [f"There are two predictions {name}." for name in sorted(set(asked)) if asked.count(name) > 1]
    return problems + [f"No compare_predictions answers {name}." for name in asked
                       if not re.search(rf"\b{name.partition('.')[2]}: ", compared)]  # fmt: skip


def of_lines(cells: list[Cell]) -> list[str]:
    """Markdown takes a line that begins with % for a comment, which it leaves out, and one with `1)` for a list."""
    said = [(cell, line[0]) for cell in cells if not cell.is_code for line in MISREAD.finditer(cell.student)]
    return [f"{begins(cell.student)} has a line that begins with `{mark}`: Markdown reads it otherwise."
            for cell, mark in said]  # fmt: skip


def of_lost(cells: list[Cell]) -> list[str]:
    """A notebook shows a cell's last expression alone: a table or a form above it would be seen by nobody."""
    lost = [(cell, line.value.func.id) for cell in cells if cell.is_code for line in ast.parse(cell.solved).body[:-1]
            if isinstance(line, ast.Expr) and isinstance(line.value, ast.Call) and isinstance(line.value.func, ast.Name)
            and line.value.func.id in SHOWN_AS_LAST]  # fmt: skip
    return [f"{begins(cell.solved)} loses what {name}(...) returns: make it a cell's last line." for cell, name in lost]


# References -----------------------------------------------------------------------------------------


def of_references(cells: list[Cell]) -> list[str]:
    """Every `bootcourse.x.y` in the text, every source("bootcourse.x", "y") and every bc.x in a cell exists."""
    dead = [name for cell in cells for name in dead_names(cell.text)]
    for cell in (cell for cell in cells if cell.is_code):
        names = shown_sources(cell.solved) + [f"bootcourse.{name}" for name in re.findall(r"\bbc\.(\w+)", cell.solved)]
        dead += [name for name in dict.fromkeys(names) if not exists(name)]
    return [f"The code that `{name}` names does not exist." for name in dead]


def dead_names(text: str) -> list[str]:
    """The names of code in a text, `bootcourse.x.y`, that do not exist."""
    return [name for name in re.findall(r"`(bootcourse(?:\.\w+)+)", text) if not exists(name)]


def shown_sources(code: str) -> list[str]:
    """source("a", "b", "c") -> a.b, a.c"""
    wrong = []
    for call in re.findall(r"(?<![\w.])source\(([^)]*)\)", code):
        module, *functions = re.findall(r'"([\w.]+)"', call) or [""]
        wrong += [f"{module}.{function}" for function in functions]
    return wrong


def exists(name: str) -> bool:
    """Can it be imported: a module, or something inside one?"""
    try:
        pkgutil.resolve_name(name)
    except (ImportError, AttributeError):
        return False
    return True
