"""A notebook's cell that runs before the cell it builds on."""

import IPython
import pytest
from IPython.core.interactiveshell import InteractiveShell

from bootcourse.course.too_early import hint_at_names


@pytest.fixture
def shell(monkeypatch):
    shell = InteractiveShell()
    shell.kernel = None  # as in a notebook
    monkeypatch.setattr(IPython, "get_ipython", lambda: shell)
    hint_at_names()
    return shell


@pytest.mark.parametrize("cell", ["study.rows", "def rows():\n    return study.rows\nrows()"])
def test_an_unknown_name_is_said_with_what_to_run_and_is_still_an_error(shell, capsys, cell):
    result = shell.run_cell(cell)
    assert isinstance(result.error_in_exec, NameError)
    assert "No cell that has run defines `study`. Run the cells above first" in capsys.readouterr().out


def test_other_errors_come_without_it(shell, capsys):
    assert shell.run_cell("1 / 0").error_in_exec
    out = capsys.readouterr().out
    assert "ZeroDivisionError" in out and "No cell" not in out


def test_nothing_happens_outside_a_notebook(monkeypatch):
    monkeypatch.setattr(IPython, "get_ipython", lambda: None)
    hint_at_names()
