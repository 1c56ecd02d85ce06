"""What of a solved notebook is executed: the student's notebook, which nbval executes whole, has most of its cells.

Executed are the cells that only the solved notebook has (the solutions with their checks, and the cell that makes
checks strict), every later cell that uses what a solution made, and of the cells above all that these need.
"""

import ast
from pathlib import Path

import nbformat

from bootcourse.course.names import names_changed, names_made, names_used


def code_of(notebook: Path) -> list[str]:
    return [cell.source for cell in nbformat.read(notebook, as_version=4).cells if cell.cell_type == "code"]


def cells_to_run(solved: list[str], student: list[str]) -> list[str]:
    """Those of the solved notebook's code cells, in their order. Both as `code_of` gives them."""
    made, changed, used = ([names(text) for text in solved] for names in (names_made, names_changed, names_used))
    imported = set().union(*map(names_imported, solved))  # `bc.show(x)` is about x, and changes no `bc`
    changed = [names - imported for names in changed]
    run, of_solutions = set(), set()
    for place, text in enumerate(solved):
        if text not in student or used[place] & of_solutions:
            run.add(place)
            of_solutions |= made[place] | changed[place]
        else:
            of_solutions -= made[place]
    needed = set()
    for place in reversed(range(len(solved))):
        if place in run or (made[place] | changed[place]) & needed:
            run.add(place)
            needed |= used[place]
    return [solved[place] for place in sorted(run)]


def names_imported(text: str) -> set[str]:
    """The names that a cell imports."""
    imports = [node for node in ast.walk(ast.parse(text)) if isinstance(node, (ast.Import, ast.ImportFrom))]
    return {(name.asname or name.name).partition(".")[0] for node in imports for name in node.names}
