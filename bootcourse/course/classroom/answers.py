"""The answers in a student's notebook, as texts, without running anything.

An answer is the last definition of the exercise's function, with the definitions, assignments and imports of other
cells that it uses: such a text can be judged by itself.
"""

import ast
import builtins
import re
from typing import Any

from msgspec import Struct

from bootcourse.course.lessons import registry
from bootcourse.course.names import names_made, names_used

BUILT_IN = frozenset(vars(builtins))
COMMAND = re.compile(r"^\s*[%!].*$", re.M)  # %time, !pip: no Python
NO_PYTHON = (SyntaxError, ValueError, RecursionError, MemoryError)  # what a text raises that cannot be parsed


class Output(Struct):
    output_type: str = ""


class Cell(Struct):
    cell_type: str
    source: str | list[str]  # a text, or its lines
    outputs: list[Output] = []

    @property
    def text(self) -> str:
        return self.source if isinstance(self.source, str) else "".join(self.source)


class Notebook(Struct):
    """What is read of a notebook's file."""

    cells: list[Cell]
    metadata: dict[str, Any] = {}

    @property
    def code(self) -> list[Cell]:
        return [cell for cell in self.cells if cell.cell_type == "code"]

    @property
    def errors(self) -> int:
        """How many cells ended with an error when they last ran."""
        return sum(any(output.output_type == "error" for output in cell.outputs) for cell in self.code)


def answers_in(notebook: Notebook) -> dict[str, str]:
    """Exercise -> the text of its answer, stubs included, for every exercise that the notebook defines."""
    statements = [statement for cell in notebook.code for statement in pieces(COMMAND.sub("", cell.text))]
    defined = [names_in(text) for text in statements]
    answers = {}
    for name in registry():
        places = [place for place, names in enumerate(defined) if name in names and defines(statements[place], name)]
        if places:
            answers[name] = with_needs(places[-1], statements, defined)
    return answers


def pieces(text: str) -> list[str]:
    """The top-level statements of a cell; of a cell that is not Python, its text without the check."""
    try:
        nodes = ast.parse(text).body
    except NO_PYTHON:
        return [re.sub(r"^check\..*$", "", text, flags=re.M)]
    lines = text.splitlines()
    first = [min(part.lineno for part in (node, *getattr(node, "decorator_list", ()))) for node in nodes]
    return ["\n".join(lines[start - 1 : node.end_lineno]) for start, node in zip(first, nodes, strict=True)]


def defines(text: str, name: str) -> bool:
    """Does the text define a function or a class of that name? (A broken text may, too.)"""
    return bool(re.search(rf"^(?:async )?(?:def|class) {name}\b", text, re.M))


def names_in(text: str) -> set[str]:
    """`names_made`, and of a text that is not Python the functions and classes that it begins."""
    return names_made(text) or set(re.findall(r"^(?:def|class) (\w+)", text, re.M))


def with_needs(answer: int, statements: list[str], defined: list[set[str]]) -> str:
    """The answer's statement after the statements that make what it uses, in the notebook's order."""
    taken, todo = {answer}, [answer]
    while todo:
        try:
            used = names_used(statements[todo.pop()]) - BUILT_IN
        except NO_PYTHON:
            continue
        for name in used:
            makers = [place for place, names in enumerate(defined) if name in names]
            before = [place for place in makers if place < answer] or makers
            if before and before[-1] not in taken:
                taken.add(before[-1])
                todo.append(before[-1])
    return "\n\n".join(statements[place] for place in [*sorted(taken - {answer}), answer]) + "\n"


def unfinished(text: str) -> bool:
    """Does a `...` still stand where an answer should? (A text that is not Python is no stub.)"""
    try:
        tree = ast.parse(text)
    except NO_PYTHON:
        return False
    values = [node.value for node in ast.walk(tree) if isinstance(node, ast.Expr)]
    return any(isinstance(value, ast.Constant) and value.value is ... for value in values)
