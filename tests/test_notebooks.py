"""The notebooks as files: current with their sources, readable, and for everyone. (nbval executes them.)"""

import re
from pathlib import Path

import nbformat
import pytest

from tools.notebooks import NOTEBOOKS, is_current, sources

SOURCES = sources([])
NOTEBOOK_FILES = sorted(NOTEBOOKS.glob("*.ipynb"))


@pytest.mark.parametrize("source", SOURCES, ids=lambda path: path.stem)
def test_a_notebook_is_what_its_source_says(source):
    assert is_current(source), f"{source.stem}.ipynb is out of date: run make notebooks"


def test_every_notebook_has_a_source():
    assert [path.stem for path in NOTEBOOK_FILES] == [path.stem for path in SOURCES] and SOURCES


@pytest.fixture(params=NOTEBOOK_FILES, ids=lambda path: path.stem)
def notebook(request):
    return nbformat.read(request.param, as_version=4)


def test_a_code_cell_is_at_most_25_lines(notebook):
    long = [cell.source for cell in notebook.cells if cell.cell_type == "code" and cell.source.count("\n") >= 25]
    assert not long


def test_a_notebook_is_committed_with_outputs_and_without_errors(notebook):
    code = [cell for cell in notebook.cells if cell.cell_type == "code"]
    assert all(cell.execution_count for cell in code)
    kinds = [output.output_type for cell in code for output in cell.outputs]
    assert "error" not in kinds and kinds


def test_every_picture_has_alt_text(notebook):
    for cell in notebook.cells:
        for output in cell.get("outputs", []):
            data = output.get("data", {})
            assert "image/png" not in data, "show figures with bootcourse.study.drawing.show, which adds alt text"
            for tag in re.findall(r"<img [^>]*>", data.get("text/html", "")):
                assert re.search(r'alt="[^"]{40,}"', tag), tag[-200:]


def test_a_lesson_says_what_one_will_be_able_to_do_and_what_one_now_knows(notebook):
    text = "\n".join(cell.source for cell in notebook.cells if cell.cell_type == "markdown")
    parts = (
        "**What you will be able to do**",
        "**Predict.**",
        "## What you now know",
        "**Three questions",
        "**Read on**",
    )
    assert [part for part in parts if part not in text] == []


def test_a_notebook_names_no_place_on_the_machine_that_made_it(notebook):
    text = nbformat.writes(notebook)
    for place in (str(Path.home()), str(NOTEBOOKS.parent)):
        assert place == "/" or place not in text
