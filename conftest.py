"""For all tests: the longest files start first, and each notebook leaves nothing behind (tests/leftovers.py)."""

import pytest

from tests.leftovers import LeavesNothing, files, survey

# A file stays in one process: one that takes a minute and starts last would keep the other process waiting.
LONGEST = ("13_your_teacher.ipynb", "05_the_barrier.ipynb", "07_soft_constraint.ipynb", "test_book.py")
# The tests of tests/test_notebooks.py execute of the solved ones what the student's notebooks have not.
collect_ignore = ["notebooks/solved"]


def is_notebook_cell(item) -> bool:
    return type(item.parent).__name__ == "IPyNbFile"


def pytest_collection_modifyitems(items):
    """The longest files first; one more test after the last cell of each notebook."""
    items.sort(key=lambda item: LONGEST.index(item.path.name) if item.path.name in LONGEST else len(LONGEST))
    for place in reversed(range(len(items))):
        item, later = items[place], items[place + 1] if place + 1 < len(items) else None
        if is_notebook_cell(item) and (later is None or later.parent is not item.parent):
            items.insert(place + 1, LeavesNothing.from_parent(item.parent, name="it leaves nothing behind"))


@pytest.hookimpl(tryfirst=True)
def pytest_runtest_call(item):
    """Look around before the first cell of a notebook."""
    if is_notebook_cell(item) and not hasattr(item.parent, "before"):
        item.parent.before, item.parent.files = survey(item.parent.kernel), files()
