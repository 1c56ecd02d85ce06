"""The three rooms: the library imports neither the research nor the course, the research nothing of the course."""

import ast
from pathlib import Path

import bootcourse

ROOT = Path(bootcourse.__file__).parent


def imported(path: Path) -> set[str]:
    """The modules that a file imports, wherever in it."""
    nodes = list(ast.walk(ast.parse(path.read_text(encoding="utf-8"))))
    names = {alias.name for node in nodes if isinstance(node, ast.Import) for alias in node.names}
    froms = [node for node in nodes if isinstance(node, ast.ImportFrom)]
    return names | {f"{node.module}.{alias.name}" for node in froms for alias in node.names}


CLOSED = {"research": ("bootcourse.course",), "course": ()}  # of the other parts of the package: both


def test_no_room_imports_from_one_behind_it():
    for path in ROOT.rglob("*.py"):
        closed = CLOSED.get(path.relative_to(ROOT).parts[0], ("bootcourse.course", "bootcourse.research"))
        assert [name for name in imported(path) if name.startswith(closed)] == [], path
