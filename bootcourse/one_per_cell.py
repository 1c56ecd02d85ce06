"""Closing a notebook cell's replay or panel, with its server and threads, when the cell runs again."""

import threading
from typing import Protocol


class Closable(Protocol):
    """A replay or a panel."""

    def close(self) -> None:
        """Stop its server and threads."""


_shown: dict[object, Closable] = {}  # cell -> what it shows
_lock = threading.Lock()


def this_cell() -> str | None:
    """The id of the running notebook cell ("" if Jupyter does not give one); None outside a notebook."""
    try:
        from IPython import get_ipython

        parent = get_ipython().kernel.get_parent()
    except (ImportError, AttributeError):
        return None
    return str(parent.get("metadata", {}).get("cellId", ""))


def close_shown_by(cell: object) -> None:
    """Close the replay or panel that this cell (or this place in a cell with several) showed when it last ran."""
    with _lock:
        before = _shown.pop(cell, None)
    if before is not None:
        before.close()


def note(cell: object, shown: Closable) -> None:
    """Register the replay or panel that a cell shows."""
    with _lock:
        _shown[cell if cell is not None else object()] = shown


def forget(shown: Closable) -> None:
    """Remove a closed replay or panel from the register."""
    with _lock:
        for cell in [cell for cell, other in _shown.items() if other is shown]:
            del _shown[cell]


def running() -> list[Closable]:
    """All open replays and panels of this process."""
    with _lock:
        return list(_shown.values())
