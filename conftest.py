"""For the notebooks that nbval runs: each must leave nothing behind (tests/leftovers.py). And who runs which tests."""

import pytest

from tests.leftovers import LeavesNothing, files, survey

collect_ignore = ["notebooks/solved"]  # what `make solved` writes
# These files use the numbers in the text of all lessons: one worker computes and keeps them.
TOGETHER = {f"tests/test_{name}.py" for name in ("book", "claims", "course", "teaching")}


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


@pytest.hookimpl(optionalhook=True)
def pytest_xdist_make_scheduler(config, log):
    """As --dist=loadfile: the tests of a file stay in one process, and those of the files above in the same."""
    from xdist.scheduler import LoadFileScheduling

    class ByFile(LoadFileScheduling):
        def _split_scope(self, nodeid):
            file = super()._split_scope(nodeid)
            return "the lessons' text" if file in TOGETHER else file

    return ByFile(config, log) if config.getvalue("dist") == "loadfile" else None
