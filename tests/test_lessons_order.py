"""Cells run out of order or twice: a sentence says which to run first, and no cell changes what another made."""

import ast
import json

import pytest
from IPython.core.interactiveshell import InteractiveShell

from bootcourse.course import order
from tools.course.problems import of_order
from tools.course.source import Cell

CELLS = [
    "import numpy as np\nfrom os import path as place",
    "# a note\nlater = np.ones(3)",
    "def helper():\n    inside = 1",
]


@pytest.fixture
def shell(tmp_path, monkeypatch):
    """A shell whose notebook has the cells above."""
    notebook = tmp_path / "lesson.ipynb"
    cells = [{"cell_type": "code", "source": text.splitlines(keepends=True)} for text in CELLS]
    notebook.write_text(json.dumps({"cells": [{"cell_type": "markdown", "source": ["later = 5"]}, *cells]}))
    monkeypatch.setenv("JPY_SESSION_NAME", str(notebook))
    shell = InteractiveShell()
    shell.colors = "nocolor"
    order.install(shell)
    return shell


def run(shell, code: str) -> str:
    """What is shown of a cell's error."""
    shown = []
    shell._showtraceback = lambda kind, error, lines: shown.append("\n".join(lines))  # as a kernel does, which sends it
    shell.run_cell(code)
    return "\n".join(shown)


def test_a_name_of_a_cell_that_did_not_run_yet_is_answered_with_that_cell(shell):
    said = run(shell, "print(later)")
    assert "`later` is not defined yet: first run the cell that begins with `later = np.ones(3)`" in said
    assert "Traceback" not in said and "Run All Above Selected Cell" in said


@pytest.mark.parametrize("name", ["np", "place", "helper"])
def test_an_import_and_a_function_are_found_too(shell, name):
    assert f"`{name}` is not defined yet" in run(shell, f"{name}.shape")


@pytest.mark.parametrize("code", ["print(latter)", "print(inside)", "import statistics; statistics.mean(nothing)"])
def test_a_name_that_no_cell_makes_gets_the_usual_traceback(shell, code):
    said = run(shell, code)
    assert "NameError" in said and "Traceback" in said and "is not defined yet" not in said


def test_an_error_inside_a_library_is_not_explained_away(shell, tmp_path):
    (tmp_path / "broken_library.py").write_text("def f():\n    return later\n")
    said = run(shell, f"import sys; sys.path.insert(0, {str(tmp_path)!r}); import broken_library; broken_library.f()")
    assert "Traceback" in said and "is not defined yet" not in said


def test_without_a_notebook_the_usual_traceback_stays(shell, monkeypatch):
    monkeypatch.delenv("JPY_SESSION_NAME")
    assert "Traceback" in run(shell, "print(later)")


@pytest.mark.parametrize("text", ["{", '{"cells": 3}', '{"cells": [{"cell_type": "code", "source": ["(((\\n"]}]}'])
def test_a_notebook_that_cannot_be_read_does_no_harm(shell, tmp_path, text):
    (tmp_path / "lesson.ipynb").write_text(text)
    assert "Traceback" in run(shell, "print(later)")


TWICE = {
    "x = 1\nx += 1": [],
    "rows = []\nrows.append(1)": [],
    "def f(rows):\n    rows.append(1)": [],
    "settings.update(a=1)": [],
    "settings |= {1: 2}": [],
    "x += 1": ["x"],
    "rows.append(1)": ["rows"],
    "for i in range(3):\n    learner.update(i)": ["learner"],
}


@pytest.mark.parametrize("code", TWICE, ids=lambda code: code.splitlines()[-1].strip())
def test_a_cell_that_would_change_another_s_work_twice_is_found(code):
    ast.parse(code)
    said = of_order([Cell("code", code, code, {})])
    assert [sentence.split("`")[1] for sentence in said] == TWICE[code]
