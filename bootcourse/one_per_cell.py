"""Closing a notebook cell's replay or panel, with its server and threads, when the cell runs again."""

_shown: dict[object, object] = {}  # cell -> the replay or panel that it shows, which has a method `close`


def this_cell() -> str | None:
    """The id of the running notebook cell ("" if Jupyter does not give one); None outside a notebook."""
    try:
        from IPython import get_ipython

        parent = get_ipython().kernel.get_parent()
    except (ImportError, AttributeError):
        return None
    return str(parent.get("metadata", {}).get("cellId", ""))


def replace_with(shown: object) -> None:
    """Register what the running cell shows, and close what of its kind this cell showed before."""
    cell = this_cell()
    place = None if cell is None else (cell, type(shown).__name__)
    close_shown_by(place)
    note(place, shown)


def close_shown_by(cell: object) -> None:
    """Close the replay or panel that this cell (or this place in a cell with several) showed when it last ran."""
    if (before := _shown.pop(cell, None)) is not None:
        before.close()


def note(cell: object, shown: object) -> None:
    """Register the replay or panel that a cell shows."""
    _shown[cell if cell is not None else object()] = shown


def forget(shown: object) -> None:
    """Remove a closed replay or panel from the register."""
    for cell, other in list(_shown.items()):
        if other is shown:
            _shown.pop(cell, None)


def running() -> list:
    """All open replays and panels of this process."""
    return list(_shown.values())
