"""Which code cells only draw: the book folds them, so that the page shows the figure or the table first.

Such a cell ends with `bc.show(...)` or `table(...)`. It drives, trains and tests nobody, prints nothing, defines no
function, has no comment for a reader, and no later cell uses its names.
"""

import ast
import json

SHORT = 2  # lines that need no folding
RUNS = {"Training", "collect", "drive_episodes", "evaluate", "examine", "is_staying_optimal", "make", "print", "record",
        "run", "training"}  # fmt: skip


def folded(notebook: str) -> str:
    """A notebook, as JSON, whose code cells that only draw have the tag `hide-input`, which the book's pages fold."""
    found = json.loads(notebook)
    code = [cell for cell in found["cells"] if cell["cell_type"] == "code"]
    texts = ["".join(cell["source"]) for cell in code]
    for number, cell in enumerate(code):
        if only_draws(texts[number], texts[number + 1 :]):
            cell["metadata"].setdefault("tags", []).append("hide-input")
    return json.dumps(found)


def only_draws(text: str, later: list[str]) -> bool:
    """Does the cell with this text only draw? later: the texts of the cells that follow."""
    if len(text.splitlines()) <= SHORT or "#" in text:
        return False
    statements, nodes = ast.parse(text).body, list(ast.walk(ast.parse(text)))
    called = {name_of(node.func) for node in nodes if isinstance(node, ast.Call)}
    made = {node.id for node in nodes if isinstance(node, ast.Name) and isinstance(node.ctx, ast.Store)}
    draws = isinstance(statements[-1], ast.Expr) and name_of(getattr(statements[-1].value, "func", None))
    defines = any(isinstance(node, (ast.FunctionDef, ast.ClassDef, ast.Import, ast.ImportFrom)) for node in nodes)
    return draws in ("show", "table") and not (called & RUNS or defines or made & read_first(later))


def read_first(texts: list[str]) -> set[str]:
    """The names that cells read before one of them assigns them."""
    found, assigned = set(), set()
    for statement in (statement for text in texts for statement in ast.parse(text).body):
        names = [node for node in ast.walk(statement) if isinstance(node, ast.Name)]
        made = {node.id for node in names if isinstance(node.ctx, ast.Store)}
        read = {node.id for node in names if isinstance(node.ctx, ast.Load)}
        targets = statement.targets if isinstance(statement, ast.Assign) else []
        inner = made - {node.id for target in targets for node in ast.walk(target) if isinstance(node, ast.Name)}
        # x = x + 1 and x += 1 read x; `[x for x in y]` and `for x in y: print(x)` do not
        found |= (made | read if isinstance(statement, ast.AugAssign) else read - inner) - assigned
        assigned |= made
    return found


def name_of(called: ast.expr | None) -> str:
    """`show` of bc.show."""
    return getattr(called, "attr", getattr(called, "id", ""))
