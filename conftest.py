"""For the notebooks that nbval runs: each must leave nothing behind (tests/leftovers.py)."""

import os
import tempfile
import uuid

import pytest

from tests.leftovers import LeavesNothing, files, survey

collect_ignore = ["notebooks/solved"]  # what `make solved` writes


def pytest_configure(config):
    """Kernels talk by files: a port that is found free for one may be taken by another before it is used."""
    if config.pluginmanager.hasplugin("nbval") and os.name == "posix":
        from nbval import kernel

        manager = kernel.KernelManager
        kernel.KernelManager = lambda **options: manager(transport="ipc", ip=new_socket(), **options)


def new_socket() -> str:
    """Where a kernel's sockets are: their names begin so. A socket's name may have 107 characters."""
    return os.path.join(tempfile.gettempdir(), f"kernel-{uuid.uuid4().hex}")


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
