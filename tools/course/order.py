"""May a cell run twice? Not if it changes what another cell made: the second time it would change it again."""

import ast
from collections.abc import Iterator

from tools.course.source import Cell

CHANGES = {"append", "extend", "insert", "pop", "remove"}
GROWS = (ast.Add, ast.Sub, ast.Mult, ast.Div, ast.Pow)


def of_order(cells: list[Cell]) -> list[str]:
    """The cells that do not do the same when they run again, as sentences."""
    found = []
    for cell in [cell for cell in cells if cell.is_code]:
        outside = list(outside_functions(ast.parse(cell.solved)))
        growing = [node.target for node in outside if grows(node)]
        names = [node for node in outside if isinstance(node, ast.Name) and isinstance(node.ctx, ast.Store)]
        own = {node.id for node in names if node not in growing}
        found += [
            f"A cell changes `{name}`, which another cell made: run twice, it does so twice. Make it in the same cell."
            for name in sorted({changed(node) for node in outside} - own - {""})
        ]
    return found


def outside_functions(tree: ast.AST) -> Iterator[ast.AST]:
    """Every node that runs when the cell does: what is inside a function waits for its call."""
    for node in ast.iter_child_nodes(tree):
        if not isinstance(node, (ast.FunctionDef, ast.Lambda)):
            yield node
            yield from outside_functions(node)


def grows(node: ast.AST) -> bool:
    """`x += 1` and the like, for a variable."""
    return isinstance(node, ast.AugAssign) and isinstance(node.target, ast.Name) and isinstance(node.op, GROWS)


def changed(node: ast.AST) -> str:
    """The variable that this node changes; "" if it changes none."""
    if grows(node):
        return node.target.id
    method = node.func if isinstance(node, ast.Call) and isinstance(node.func, ast.Attribute) else None
    if method is None or not isinstance(method.value, ast.Name):
        return ""
    learns = method.attr == "update" and not any(keyword.arg for keyword in node.keywords)
    return method.value.id if method.attr in CHANGES or learns else ""
