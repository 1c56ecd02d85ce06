"""A new version of a notebook and what a student wrote in the old one, merged cell by cell.

A student's cell is one whose text the handout did not have. It stays; where it has the id of one of the lesson's cells,
it stands in that cell's place. All other cells are the new version's.
"""

import hashlib


def text_of(cell: dict) -> str:
    """A cell's text, which may be a list of lines."""
    source = cell.get("source", "")
    return source if isinstance(source, str) else "".join(source)


def digest(cell: dict) -> str:
    """The same for cells of the same text."""
    return hashed(text_of(cell).encode("utf-8", "replace"))


def hashed(data: bytes) -> str:
    return hashlib.sha256(data).hexdigest()[:16]


def texts(notebook: dict) -> dict[str, str]:
    """id -> digest, of every cell."""
    return {str(cell.get("id", place)): digest(cell) for place, cell in enumerate(notebook["cells"])}


def merge(mine: dict, base: dict[str, str], new: dict) -> tuple[dict, str]:
    """The merged notebook, and a sentence about the cells of the student's, with those that the lesson changed, too.

    mine: the student's notebook; base: `texts` of the one that was handed out; new: the one to hand out now.
    """
    own = {place: cell for place, cell in enumerate(mine["cells"]) if digest(cell) not in base.values()}
    in_place = {str(own[place].get("id")): own[place] for place in reversed(own)}  # of several with one id, the first
    ran = {digest(cell): cell for cell in mine["cells"]}
    lesson, cells = {str(cell["id"]): cell for cell in new["cells"]}, []
    for name, cell in lesson.items():
        outputs = {key: ran[digest(cell)][key] for key in ("outputs", "execution_count")
                   if key in cell and key in ran.get(digest(cell), {})}  # fmt: skip
        cells.append(in_place.get(name, cell | outputs))
    for place, cell in own.items():  # what the student added stands behind what stood before it
        if str(cell.get("id")) not in lesson or in_place[str(cell.get("id"))] is not cell:
            there = [digest(other) for other in cells]
            above = [there.index(digest(other)) for other in mine["cells"][:place] if digest(other) in there]
            cells.insert(above[-1] + 1 if above else 0, cell)
    both = [cell for name, cell in in_place.items() if name in lesson and base.get(name) != digest(lesson[name])]
    first_lines = (text_of(cell).strip().partition("\n")[0][:80] for cell in both)
    also = "".join(f"; changed in the lesson, too, and kept: “{line}”" for line in first_lines)
    return new | {"cells": cells}, f"{len(own)} cells of the student's kept{also}."
