"""For the notebooks that nbval runs: each must leave nothing behind (tests/leftovers.py)."""

import pytest

from tests.leftovers import LeavesNothing, files, survey

# tests/test_notebooks.py executes these, without the cells that the student's notebooks have, too.
collect_ignore = ["notebooks/solved"]


def is_notebook_cell(item) -> bool:
    return type(item.parent).__name__ == "IPyNbFile"


def pytest_collection_modifyitems(items):
    """One more test after the last cell of each notebook."""
    for place in reversed(range(len(items))):
        item, later = items[place], items[place + 1] if place + 1 < len(items) else None
        if is_notebook_cell(item) and (later is None or later.parent is not item.parent):
            items.insert(place + 1, LeavesNothing.from_parent(item.parent, name="it leaves nothing behind"))


@pytest.hookimpl(tryfirst=True)
def pytest_runtest_call(item):
    """Look around before the first cell of a notebook."""
    if is_notebook_cell(item) and not hasattr(item.parent, "before"):
        item.parent.before, item.parent.files = survey(item.parent.kernel), files()
