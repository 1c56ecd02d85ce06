"""The answers in a student's notebook, as texts, without running anything.

An answer is the last definition of the exercise's function, with the definitions, assignments and imports of other
cells that it uses: such a text can be judged by itself.
"""

import ast
import builtins
import re
from collections.abc import Iterable

from bootcourse.course.lessons import registry
from bootcourse.course.names import names_made, names_used

BUILT_IN = frozenset(vars(builtins))
COMMAND = re.compile(r"^\s*[%!].*$", re.M)  # %time, !pip: no Python
NO_PYTHON = (SyntaxError, ValueError, RecursionError, MemoryError)  # what a text raises that cannot be parsed


def code_cells(notebook: dict) -> list[dict]:
    """The code cells of a notebook that was read from JSON; cells of another form are left out."""
    cells = notebook.get("cells") if isinstance(notebook, dict) else None
    found = [cell for cell in cells if isinstance(cell, dict)] if isinstance(cells, list) else []
    return [cell for cell in found if cell.get("cell_type") == "code"]


def joined(text: object) -> str:
    """A text of a notebook, which may be a list of lines."""
    parts = text if isinstance(text, list) else [text]
    return "".join(part for part in parts if isinstance(part, str))


def answers_in(notebook: dict) -> dict[str, str]:
    """Exercise -> the text of its answer, stubs included, for every exercise that the notebook defines."""
    texts = [COMMAND.sub("", joined(cell.get("source"))) for cell in code_cells(notebook)]
    statements = [statement for text in texts for statement in pieces(text)]
    made = [names_in(text) for text in statements]
    found = {}
    for name in registry():
        places = [place for place, names in enumerate(made) if name in names and defines(statements[place], name)]
        if places:
            found[name] = with_needs(places[-1], statements, made)
    return found


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


def with_needs(answer: int, statements: list[str], made: list[set[str]]) -> str:
    """The answer's statement after the statements that make what it uses, in the notebook's order."""
    taken, todo = {answer}, [answer]
    while todo:
        try:
            used = names_used(statements[todo.pop()]) - BUILT_IN
        except NO_PYTHON:
            continue
        for name in used:
            makers = [place for place, names in enumerate(made) if name in names]
            before = [place for place in makers if place < answer] or makers
            if before and before[-1] not in taken:
                taken.add(before[-1])
                todo.append(before[-1])
    return "\n\n".join(statements[place] for place in [*sorted(taken - {answer}), answer]) + "\n"


def verdicts_in(notebook: dict) -> dict[str, str]:
    """Exercise -> what its check said when the student last ran it."""
    found = {}
    for cell in code_cells(notebook):
        for name in re.findall(r"^check\.(\w+)\(", joined(cell.get("source")), re.M):
            said = [text for text in map(printed, outputs(cell)) if text]
            if name in registry() and said:
                found[name] = said[-1][:2000]
    return found


def outputs(cell: dict) -> Iterable[dict]:
    found = cell.get("outputs")
    return [output for output in found if isinstance(output, dict)] if isinstance(found, list) else []


def printed(output: dict) -> str:
    """The plain text of an output."""
    data = output.get("data")
    return joined(data.get("text/plain")) if isinstance(data, dict) else ""


def errors_in(notebook: dict) -> int:
    """How many cells ended with an error when they last ran."""
    return sum(any(o.get("output_type") == "error" for o in outputs(cell)) for cell in code_cells(notebook))


def unfinished(text: str) -> bool:
    """Does a `...` still stand where an answer should? (A text that is not Python is no stub.)"""
    try:
        tree = ast.parse(text)
    except NO_PYTHON:
        return False
    found = [node.value for node in ast.walk(tree) if isinstance(node, ast.Expr)]
    return any(isinstance(value, ast.Constant) and value.value is ... for value in found)
