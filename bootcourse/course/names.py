"""Which names a text of Python defines, changes and uses, without running it."""

import ast
import symtable
from collections.abc import Iterator


def names_made(text: str) -> set[str]:
    """The names a cell defines outside functions: variables, functions, classes, imports ("*" for all of a module's).

    Empty if it is not Python.
    """
    try:
        todo, names = list(ast.parse(text).body), set()
    except SyntaxError:
        return set()
    while todo:
        node = todo.pop()
        if isinstance(node, (ast.FunctionDef, ast.AsyncFunctionDef, ast.ClassDef)):
            names.add(node.name)
            continue
        if isinstance(node, (ast.Import, ast.ImportFrom)):
            names |= {(alias.asname or alias.name).partition(".")[0] for alias in node.names}
        if isinstance(node, ast.Name) and isinstance(node.ctx, ast.Store):
            names.add(node.id)
        if isinstance(node, (ast.MatchAs, ast.MatchStar, ast.MatchMapping)):
            names |= {getattr(node, "rest", getattr(node, "name", None))} - {None}
        if not isinstance(node, (ast.Lambda, ast.ListComp, ast.DictComp, ast.SetComp, ast.GeneratorExp)):
            todo += ast.iter_child_nodes(node)
    return names


def names_changed(text: str) -> set[str]:
    """The variables whose object a text changes: `x.a = 1`, `x[0] = 1`, `setattr(x, ...)`, or a statement `x.do()`."""
    nodes = list(ast.walk(ast.parse(text)))
    calls = [node.value for node in nodes if isinstance(node, ast.Expr) and isinstance(node.value, ast.Call)]
    places = [node for node in nodes if isinstance(getattr(node, "ctx", None), (ast.Store, ast.Del))]
    places += [call.func for call in calls]
    given = {root_of(call.args[0]) for call in calls if root_of(call.func) == "setattr" and call.args}
    return given | {root_of(node) for node in places if isinstance(node, (ast.Attribute, ast.Subscript))}


def root_of(node: ast.AST) -> str:
    """x of `x.a[0].b`; "" where it is no variable."""
    while isinstance(node, (ast.Attribute, ast.Subscript)):
        node = node.value
    return node.id if isinstance(node, ast.Name) else ""


def names_used(text: str, at_once: bool = False) -> set[str]:
    """Every global variable that a text of Python reads, inside its functions, too.

    at_once: or only those that it reads when it runs and calls nothing, such as in a function's defaults.
    """
    return set(read_in(symtable.symtable(text, "a cell", "exec"), at_once))


def read_in(scope: symtable.SymbolTable, at_once: bool) -> Iterator[str]:
    inside = scope.get_type() != "module"
    yield from (each.get_name() for each in scope.get_symbols() if each.is_referenced() and each.is_global() >= inside)
    for child in scope.get_children():
        if not at_once or child.get_type() == "class":
            yield from read_in(child, at_once)
