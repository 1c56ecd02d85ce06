"""A lesson's text, text.py in its folder (percent format), as cells with a student's and a solved text.

The title, the exercises and the lessons that a text names get their numbers here (numbering.py). Lines between
`# solution` and `# end solution` are the student's to write: the student gets `...` for them.
`# solution: the exercise's own` stands for the one that the exercise itself holds. A markdown cell tagged "instructor"
goes to the instructor's page only.
"""

import ast
import inspect
import re
from dataclasses import dataclass
from functools import cache
from pathlib import Path

import jupytext

from bootcourse.course.lessons import LESSONS, number, registry
from tools.course.numbering import resolved, text_file

SAME = "# NBVAL_CHECK_OUTPUT"  # in a text; nbval reads it as a tag, which students do not see
BEGIN, END = "# solution", "# end solution"
OWN = re.compile(rf"^( +){BEGIN}: the exercise's own$", re.M)
NUMBER = re.compile(r"\{\{\s+(.+?)(?:\s+\|\s+([\w.,+%]+))?\s+\}\}", re.S)
CLAIM = re.compile(r"\s*<!-- claim:\s+(.+?)\s+-->", re.S)


@dataclass(frozen=True)
class Cell:
    """One cell of a source, before anything is executed."""

    kind: str  # "code" or "markdown"
    student: str
    solved: str
    metadata: dict

    @property
    def for_instructor(self) -> bool:
        return "instructor" in self.metadata.get("tags", [])

    @property
    def is_exercise(self) -> bool:
        return self.student != self.solved

    @property
    def checks(self) -> list[str]:
        """The exercises that it checks: `check.NAME(...)`."""
        return re.findall(r"^check\.(?!hint\b|solution\b|strict\b)(\w+)\(", self.solved, re.M) if self.is_code else []

    @property
    def is_code(self) -> bool:
        return self.kind == "code"

    @property
    def text(self) -> str:
        """The text of a markdown cell; of code, none."""
        return "" if self.is_code else self.student


def sources(names: list[str] = ()) -> list[Path]:
    """The sources of these lessons, or of all, in their order. Raises ValueError for what is no lesson."""
    if strange := set(names) - set(LESSONS):
        raise ValueError(f"There is no lesson {min(strange)}: choose from {', '.join(LESSONS)}.")
    return [text_file(name) for name in LESSONS if not names or name in names]


def lesson_of(path: Path) -> str:
    """The name of the lesson whose text this is: that of its folder."""
    return path.parent.name


def read(path: Path) -> list[Cell]:
    """All cells of a source, numbered. Raises ValueError where the marks of a solution do not come in pairs."""
    cells, exercises = [], 0
    for kind, source, metadata in parsed(path.read_text(encoding="utf-8")):
        metadata = dict(metadata)
        if kind == "code":
            text, same = re.subn(rf"^{SAME}\n", "", source, flags=re.M)
            if same:
                metadata["tags"] = [*metadata.get("tags", []), "nbval-check-output"]
            text = with_solutions(text)
            both = without_solution(text), without_marks(text)
        else:
            text, exercises = numbered(source, lesson_of(path), exercises)
            both = text, text
        cells.append(Cell(kind, *both, metadata))
    return cells


@cache
def parsed(text: str) -> list[tuple[str, str, dict]]:
    """Each cell of a source in jupytext's percent format: its kind, its text, its metadata."""
    return [(cell.cell_type, cell.source, cell.metadata) for cell in jupytext.reads(text, fmt="py:percent").cells]


def numbered(text: str, lesson: str, exercises: int) -> tuple[str, int]:
    """A text with its numbers, and how many exercises the lesson has had so far."""
    title, *parts = re.split(r"(?<=\*\*Exercise) (?=\()", re.sub(r"\A# ", f"# {number(lesson)} · ", text))
    for part in parts:
        exercises += 1
        title += f" {number(lesson)}.{exercises} {part}"
    return resolved(title), exercises


def title(cells: list[Cell]) -> str:
    return next(heading[1] for cell in cells if (heading := re.search(r"^# (.+)", cell.text, re.M)))


def with_solutions(text: str) -> str:
    """A cell with the exercise's own solution, between marks, where the text asks for it."""

    def written_out(mark: re.Match) -> str:
        name = re.search(r"^check\.(\w+)\(", text, re.M)[1]
        function = re.findall(r"def (\w+)", text[: mark.start()])[-1]  # the exercise's, or a method of its class
        return f"{mark[1]}{BEGIN}\n{own_solution(name, function)}\n{mark[1]}{END}"

    return OWN.sub(written_out, text)


def own_solution(name: str, function: str) -> str:
    """The body, without its docstring, of an exercise's solution; of a class, that of the method `function`."""
    text = inspect.getsource(registry()[name].solution)
    node = ast.parse(text).body[0]
    if isinstance(node, ast.ClassDef):
        node = next(each for each in node.body if getattr(each, "name", "") == function)
    first = node.body[0]
    before = first.end_lineno if ast.get_docstring(node) is not None else first.lineno - 1
    return "\n".join(text.splitlines()[before : node.end_lineno])


def without_solution(text: str) -> str:
    """The stub: `...` in place of each solution."""
    marks = [line.strip() for line in text.splitlines() if line.strip() in (BEGIN, END)]
    if marks != [BEGIN, END] * (len(marks) // 2):
        what = f"`{BEGIN}` has no `{END}`" if marks[-1] == BEGIN else f"`{BEGIN}` and `{END}` do not come in pairs"
        raise ValueError(f"{what} in the cell that begins with {text[:60]!r}")
    return re.sub(rf"^( *){BEGIN} *$.*?^ *{END} *$", r"\1...", text, flags=re.M | re.S)


def without_marks(text: str) -> str:
    return "\n".join(line for line in text.splitlines() if line.strip() not in (BEGIN, END))


def one_folder_down(text: str) -> str:
    """Markdown whose relative links still lead to the same place from a folder inside notebooks/."""
    return re.sub(r"(\]\()(?![a-z]+:|#|/)", r"\1../", text)


def function_in(text: str, name: str) -> ast.FunctionDef | ast.ClassDef | None:
    """The function or class of that name that a cell defines."""
    kinds = (ast.FunctionDef, ast.ClassDef)
    return next((node for node in ast.parse(text).body if isinstance(node, kinds) and node.name == name), None)


def arguments_of(function: ast.FunctionDef | ast.ClassDef) -> list[str]:
    """The names of the arguments of a call; a class is called as its `__init__` says."""
    if isinstance(function, ast.FunctionDef):
        return [argument.arg for argument in function.args.args]
    return next(arguments_of(each)[1:] for each in function.body if getattr(each, "name", "") == "__init__")


def body(function: ast.FunctionDef | ast.ClassDef) -> list[str]:
    """What it does, for comparison: without docstring, annotations and comments."""
    statements = function.body[1:] if ast.get_docstring(function) is not None else function.body
    return [ast.dump(statement) for statement in statements]
