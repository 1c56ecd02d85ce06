"""The notebooks as files. nbval executes them; test_course.py holds them to the lessons' texts."""

import ast
import re
from pathlib import Path

import nbformat
import pytest

from bootcourse.course.lessons import stem
from tools.course.numbering import NOTEBOOKS


@pytest.fixture(scope="module", params=sorted(NOTEBOOKS.glob("*.ipynb")), ids=lambda path: path.stem)
def notebook(request):
    return nbformat.read(request.param, as_version=4)


def test_a_notebook_is_committed_with_outputs_and_without_errors(notebook):
    code = [cell for cell in notebook.cells if cell.cell_type == "code"]
    assert all(cell.execution_count for cell in code)
    kinds = [output.output_type for cell in code for output in cell.outputs]
    assert "error" not in kinds and kinds


def test_a_lesson_says_what_one_will_be_able_to_do_and_what_one_now_knows(notebook, request):
    text = "\n".join(cell.source for cell in notebook.cells if cell.cell_type == "markdown")
    parts = (
        "**What you will be able to do**",
        "**Predict.**",
        "## What you now know",
        "**Three questions",
        "**Read on**",
    )
    if request.node.callspec.id == stem("start"):  # ten minutes to choose a route: it teaches nothing yet
        parts = ("**What you will be able to do**", "**Predict.**", "**Read on**")
    assert [part for part in parts if part not in text] == []


def test_a_notebook_names_no_place_on_the_machine_that_made_it(notebook):
    text = nbformat.writes(notebook)
    assert str(NOTEBOOKS.parent) not in text and (str(Path.home()) == "/" or str(Path.home()) not in text)


def test_a_picture_says_what_a_reader_should_see(notebook):
    data = [output.get("data", {}) for cell in notebook.cells for output in cell.get("outputs", [])]
    assert not any(kind.startswith("image/") for each in data for kind in each), "JupyterLab drops their alt text"
    pictures = [tag for each in data for tag in re.findall(r"<img [^>]*>", each.get("text/html", ""))]
    assert [tag[:80] for tag in pictures if not re.search(r'alt="[^"]{40,}"', tag)] == []
    assert not any(re.search(r"!\[\s*\]\(", cell.source) for cell in notebook.cells if cell.cell_type == "markdown")


def test_each_row_of_a_table_is_one_line(notebook):
    text = "\n\n".join(cell.source for cell in notebook.cells if cell.cell_type == "markdown")
    assert re.findall(r"^\|.*\n(?!\||\n).+", text, re.M) == []
    assert [line for line in text.splitlines() if line.startswith("|") and not line.rstrip().endswith("|")] == []


def test_the_code_that_answers_a_prediction_does_not_say_the_answer(notebook):
    """It is read before it is run: a title that is a sentence stands in the lesson's figures, not in the cell."""
    answering = [cell.source for cell in notebook.cells if "predicted(" in cell.source and cell.cell_type == "code"]
    parts = [node for source in answering for node in ast.walk(ast.parse(source)) if isinstance(node, ast.Constant)]
    strings = [part.value for part in parts if isinstance(part.value, str) and "\n" not in part.value]
    sentences = [words for words in strings if words[:1].isupper() and len(words.split()) >= 8]
    assert [words for words in sentences if not words.endswith(".")] == []  # what stands below a table does
