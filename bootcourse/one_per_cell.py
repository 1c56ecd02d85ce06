"""What a notebook cell shows and must close when it runs again: replays and panels, which hold servers and threads."""

import threading
from typing import Protocol


class Closable(Protocol):
    def close(self) -> None: ...


_shown: dict[object, Closable] = {}  # cell -> what it shows
_lock = threading.Lock()


def this_cell() -> str | None:
    """The notebook cell that is being run ("" where Jupyter does not tell which); None outside a notebook."""
    try:
        from IPython import get_ipython

        parent = get_ipython().kernel.get_parent()
    except (ImportError, AttributeError):
        return None
    return str(parent.get("metadata", {}).get("cellId", ""))


def close_shown_by(cell: object) -> None:
    """Close what this cell (and, of a cell with several, this place in it) showed when it ran before."""
    with _lock:
        before = _shown.pop(cell, None)
    if before is not None:
        before.close()


def note(cell: object, shown: Closable) -> None:
    """Remember what a cell shows."""
    with _lock:
        _shown[cell if cell is not None else object()] = shown


def forget(shown: Closable) -> None:
    with _lock:
        for cell in [cell for cell, other in _shown.items() if other is shown]:
            del _shown[cell]


def running() -> list[Closable]:
    """Everything that cells show in this process and that is not closed."""
    with _lock:
        return list(_shown.values())
