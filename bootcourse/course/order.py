"""Cells run out of order: a NameError says which cell defines the missing name and has to be run first.

`install` is called when a notebook imports `bootcourse.course`, which the first cell of each lesson does.
"""

import ast
import json
import os
import symtable
import traceback
from collections.abc import Iterator
from pathlib import Path

RUN_ABOVE = "or all cells above this one (menu Run, Run All Above Selected Cell)"


def install(shell) -> None:
    """Let a notebook's shell (an IPython `InteractiveShell`) explain a NameError in its cells."""
    shell.set_custom_exc((NameError,), _explain)


def _explain(shell, kind, error, trace, tb_offset=None) -> None:
    """Show the sentence, or the usual traceback if no cell defines the name."""
    raised_in = traceback.extract_tb(trace)[-1].filename
    sentence = first_run(error, raised_in, code_cells(notebook_of(shell)))
    if sentence:
        shell._showtraceback(kind, error, [sentence])
    else:
        shell.showtraceback((kind, error, trace), running_compiled_code=True)


def notebook_of(shell) -> Path | None:
    """The notebook's file, which JupyterLab and VS Code tell the kernel; None in other editors."""
    told = shell.user_ns.get("__vsc_ipynb_file__") or os.environ.get("JPY_SESSION_NAME", "")
    return Path(told) if told.endswith(".ipynb") and Path(told).is_file() else None


def code_cells(notebook: Path | None) -> list[str]:
    """The text of a notebook's code cells; an empty list if it cannot be read."""
    if notebook is None:
        return []
    try:
        cells = json.loads(notebook.read_text(encoding="utf-8"))["cells"]
        return ["".join(cell["source"]) for cell in cells if cell["cell_type"] == "code"]
    except (OSError, ValueError, KeyError, TypeError):  # half-written, or of another format
        return []


def first_run(error: NameError, place: str, cells: list[str]) -> str | None:
    """A sentence that names the cell which defines the name. None if no cell does, or a library raised the error."""
    if Path(place).suffix == ".py" and "ipykernel" not in place:
        return None  # raised inside a library
    for text in cells:
        if error.name in names_made(text):
            begins = next(line for line in text.splitlines() if line.strip() and not line.startswith("#"))
            return f"`{error.name}` is not defined yet: first run the cell that begins with `{begins}`, {RUN_ABOVE}."
    return None


def names_made(text: str) -> set[str]:
    """The names a cell defines outside functions: variables, functions, classes, imports. Empty if it is not Python."""
    try:
        todo, made = list(ast.parse(text).body), set()
    except SyntaxError:
        return set()
    while todo:
        node = todo.pop()
        if isinstance(node, (ast.FunctionDef, ast.ClassDef)):
            made.add(node.name)
            continue
        if isinstance(node, (ast.Import, ast.ImportFrom)):
            made |= {(alias.asname or alias.name).partition(".")[0] for alias in node.names}
        if isinstance(node, ast.Name) and isinstance(node.ctx, ast.Store):
            made.add(node.id)
        if not isinstance(node, (ast.Lambda, ast.ListComp, ast.DictComp, ast.SetComp, ast.GeneratorExp)):
            todo += ast.iter_child_nodes(node)
    return made


def names_used(text: str) -> set[str]:
    """Every global variable that a text of Python reads, inside its functions, too."""
    return set(read_in(symtable.symtable(text, "a cell", "exec")))


def read_in(scope: symtable.SymbolTable) -> Iterator[str]:
    inside = scope.get_type() != "module"
    yield from (each.get_name() for each in scope.get_symbols() if each.is_referenced() and each.is_global() >= inside)
    for child in scope.get_children():
        yield from read_in(child)
