"""A notebook that leaves something behind fails (tests/leftovers.py), and a tidy one does not."""

import subprocess
import sys

import nbformat
import pytest

from tests.leftovers import ROOT, left_behind

LEAVES = """
import socket, subprocess, threading, time
threading.Thread(target=time.sleep, args=(60,), name="a sleeper", daemon=True).start()
server = socket.create_server(("127.0.0.1", 0))
child = subprocess.Popen(["sleep", "60"])
"""
TIDY = """
import socket, subprocess, threading
thread = threading.Thread(target=print)
thread.start(), thread.join(), socket.create_server(("127.0.0.1", 0)).close()
subprocess.run(["true"], check=True)
"""
NOTHING = {"threads": [("Thread", "MainThread")], "ports": [5000], "children": []}


def cell(folder, name: str, code: str) -> str:
    """A notebook with this cell; its path."""
    cells = [nbformat.v4.new_code_cell("1 + 1"), nbformat.v4.new_code_cell(code)]
    nbformat.write(nbformat.v4.new_notebook(cells=cells), folder / f"{name}.ipynb")
    return str(folder / f"{name}.ipynb")


@pytest.mark.skipif(sys.platform != "linux", reason="only Linux says which ports and children are a process's own")
def test_a_thread_a_server_and_a_process_are_found_and_a_notebook_that_closes_what_it_opens_passes(tmp_path):
    """What nbval says, with the course's own hooks."""
    notebooks = [cell(tmp_path, "leaves", LEAVES), cell(tmp_path, "tidy", TIDY)]
    options = ["--nbval-lax", "--nbval-current-env", "-q", "-n", "0", "-p", "conftest", "-p", "no:cacheprovider"]
    command = [sys.executable, "-m", "pytest", *notebooks, *options]
    said = subprocess.run(command, cwd=ROOT, capture_output=True, text=True, timeout=120).stdout
    assert "1 failed, 5 passed" in said and "leaves.ipynb::it leaves nothing behind" in said
    assert all(part in said for part in ("the thread a sleeper", "a server on port", "the process"))


def test_what_was_there_before_is_nobody_s_fault():
    assert left_behind(NOTHING, NOTHING) == []
    assert left_behind(NOTHING, NOTHING | {"ports": [5000, 6000]}) == ["a server on port 6000"]
    assert left_behind(NOTHING, NOTHING | {"threads": [*NOTHING["threads"], ("TMonitor", "Thread-9")]}) == []
