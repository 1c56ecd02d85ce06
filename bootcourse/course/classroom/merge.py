"""A new version of a notebook and what a student wrote in the old one, merged cell by cell.

A student's cell is one whose text the handout did not have. It stays; where it has the id of one of the lesson's cells,
it stands in that cell's place. All other cells are the new version's.
"""

import hashlib
from dataclasses import dataclass

from bootcourse.course.classroom.answers import joined


@dataclass(frozen=True)
class Merged:
    """The merged notebook, and how many cells are the student's, are new, and were changed in the lesson."""

    notebook: dict
    kept: int
    new: int
    changed: int
    both: tuple[str, ...]  # the first lines of cells that the student and the lesson have changed

    def __str__(self) -> str:
        told = f"{self.kept} cells of the student's kept, {self.new} new, {self.changed} changed"
        also = "".join(f"; changed in the lesson, too, and kept: “{line}”" for line in self.both)
        return f"{told}{also}."


def digest(cell: dict) -> str:
    """The same for cells of the same text."""
    return hashed(joined(cell.get("source")).encode("utf-8", "replace"))


def hashed(data: bytes) -> str:
    return hashlib.sha256(data).hexdigest()[:16]


def texts(notebook: dict) -> dict[str, str]:
    """id -> digest, of every cell."""
    return {str(cell.get("id", place)): digest(cell) for place, cell in enumerate(notebook["cells"])}


def merge(mine: dict, base: dict[str, str], new: dict) -> Merged:
    """mine: the student's notebook; base: `texts` of the one that was handed out; new: the one to hand out now."""
    handed = set(base.values())
    own = {place for place, cell in enumerate(mine["cells"]) if digest(cell) not in handed}
    ids = [str(cell.get("id", place)) for place, cell in enumerate(mine["cells"])]
    by_id = {ids[place]: mine["cells"][place] for place in own}
    ran = {digest(cell): cell for place, cell in enumerate(mine["cells"]) if place not in own}
    cells, fresh = [], {str(cell["id"]): cell for cell in new["cells"]}
    changed = [name for name, cell in fresh.items() if base.get(name, digest(cell)) != digest(cell)]
    for name, cell in fresh.items():
        if name in by_id:
            cells.append(by_id[name])
        elif name in ids or base.get(name) != digest(cell):  # else the student has deleted it
            cells.append(cell | outputs(ran.get(digest(cell), {}), cell))
    for place in sorted(own):  # what the student added stands behind what stood before it
        if ids[place] not in fresh:
            cells.insert(after(mine["cells"], place, cells), mine["cells"][place])
    both = [by_id[name] for name in changed if name in by_id]
    return Merged(
        new | {"cells": cells},
        kept=len(own),
        new=sum(name not in base for name in fresh),
        changed=len(changed),
        both=tuple(joined(cell.get("source")).strip().partition("\n")[0][:80] for cell in both),
    )


def outputs(old: dict, cell: dict) -> dict:
    """The outputs of a cell that the student ran and did not change."""
    return {key: old[key] for key in ("outputs", "execution_count") if key in old and key in cell}


def after(before: list[dict], place: int, cells: list[dict]) -> int:
    """Where a student's cell belongs in the merged ones: behind the nearest cell above it that is there."""
    there = {digest(cell): number for number, cell in enumerate(cells)}
    above = [there[digest(cell)] for cell in before[:place] if digest(cell) in there]
    return above[-1] + 1 if above else 0
