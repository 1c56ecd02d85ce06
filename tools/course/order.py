"""May a cell run twice? Not if it changes what another cell made: the second time it would change it again."""

import ast
from collections.abc import Iterator

from tools.course.source import Cell

CHANGES = {"append", "extend", "insert", "pop", "remove", "update"}


def of_order(cells: list[Cell]) -> list[str]:
    """The cells that do not do the same when they run again, as sentences."""
    found = []
    for cell in (cell for cell in cells if cell.is_code):
        nodes = list(outside_functions(ast.parse(cell.solved)))
        grown = [
            node.target for node in nodes if isinstance(node, ast.AugAssign) and not isinstance(node.op, ast.BitOr)
        ]
        grown += [node.func.value for node in nodes if isinstance(node, ast.Call) and changes(node)]
        own = {node.id for node in nodes if isinstance(node, ast.Name) and node not in grown and stores(node)}
        found += [
            f"A cell changes `{name}`, which another cell made: run twice, it does so twice. Make it in the same cell."
            for name in sorted({node.id for node in grown if isinstance(node, ast.Name)} - own)
        ]
    return found


def outside_functions(tree: ast.AST) -> Iterator[ast.AST]:
    """Every node that runs when the cell does: what is inside a function waits for its call."""
    for node in ast.iter_child_nodes(tree):
        if not isinstance(node, ast.FunctionDef | ast.Lambda):
            yield node
            yield from outside_functions(node)


def changes(call: ast.Call) -> bool:
    """`rows.append(1)` or `learner.update(batch)`; `settings.update(a=1)` does the same each time."""
    return isinstance(call.func, ast.Attribute) and call.func.attr in CHANGES and not call.keywords


def stores(node: ast.Name) -> bool:
    return isinstance(node.ctx, ast.Store)
