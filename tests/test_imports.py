"""The tree in bootcourse/__init__.py: it names every part of the package, and each uses only what stands above it."""

import ast
import re
from pathlib import Path

import bootcourse

PACKAGE = Path(bootcourse.__file__).parent


def tree() -> dict[str, int]:
    """part of the package -> the line of the tree that it stands in."""
    lines = re.findall(r"^(\w[\w, ]*?)  +\S", bootcourse.__doc__, re.M)
    return {part: number for number, line in enumerate(lines) for part in line.split(", ")}


def part_of(module: str) -> str | None:
    """The part that a module of the package belongs to; None for the package itself and for others."""
    first, _, rest = module.partition(".")
    return rest.partition(".")[0] or None if first == "bootcourse" else None


def uses() -> list[tuple[str, str, str]]:
    """(part, part that it imports, where), imports inside functions included."""
    found = []
    for path in sorted(PACKAGE.rglob("*.py")):
        own = path.relative_to(PACKAGE).with_suffix("").parts[0]
        for node in ast.walk(ast.parse(path.read_text(encoding="utf-8"))):
            if isinstance(node, ast.Import):
                names = [alias.name for alias in node.names]
            elif isinstance(node, ast.ImportFrom):
                assert node.level == 0, f"{path} imports relatively"
                names = [f"{node.module}.{alias.name}" for alias in node.names]
            else:
                continue
            where = f"{path.relative_to(PACKAGE)}, line {node.lineno}"
            found += [(own, other, where) for other in map(part_of, names) if other and other != own]
    return found


def test_the_tree_names_every_part_of_the_package():
    there = {path.stem for path in PACKAGE.iterdir() if path.suffix == ".py" or (path / "__init__.py").exists()}
    assert tree().keys() == there - {"__init__", "__main__"}


def test_each_part_uses_only_what_stands_above_it():
    line = {"__init__": -1, **tree(), "__main__": 99}
    wrong = [f"{where}: {own} uses {other}" for own, other, where in uses() if line.get(other, -1) >= line[own] > -1]
    assert wrong == []


def test_the_library_imports_nothing_of_the_rooms_and_the_research_nothing_of_the_course():
    rooms = {"research": {"course"}, "course": set()}
    wrong = [place for own, other, place in uses() if other in rooms.get(own, rooms)]
    assert wrong == []


def test_the_front_door_itself_imports_only_what_raises_errors():
    assert {other for own, other, _ in uses() if own == "__init__"} == {"errors"}
