"""Which names a text of Python defines, and which it uses, without running it."""

import ast
import symtable
from collections.abc import Iterator


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
