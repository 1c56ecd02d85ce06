"""The notebooks as files, student's and solved, and the solutions at work.

nbval executes the student's notebooks; test_course.py holds both to their sources.
"""

from pathlib import Path

import nbformat
import pytest

from bootcourse import one_per_cell
from bootcourse.course import check
from bootcourse.course.lessons import stem
from bootcourse.learn.training import Training
from tests.solved import cells_to_run, code_of
from tools.course.numbering import NOTEBOOKS

SOLVED = sorted(NOTEBOOKS.glob("solved/*.ipynb"))
NOTEBOOK_FILES = sorted(NOTEBOOKS.glob("*.ipynb")) + SOLVED


@pytest.fixture(
    scope="module", params=NOTEBOOK_FILES, ids=lambda path: str(path.relative_to(NOTEBOOKS).with_suffix(""))
)
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


# Solved ---------------------------------------------------------------------------------------------


def execute(cells: list[str]) -> None:
    """Run cells one after the other, as a kernel would. Raises what a cell raises, and where a check fails."""
    space = {"__name__": "__main__"}
    try:
        for cell in cells:
            exec(compile(cell, "a cell", "exec"), space)
    finally:
        check.strict(False)
        for shown in one_per_cell.running():  # a prediction's form
            shown.close()


@pytest.fixture
def short_trainings(monkeypatch):
    """A training ends after 500 updates. What the course's code learns in a whole one, nbval sees."""
    whole = Training.run

    def run(training, *arguments, stop=None, **more):
        return whole(training, *arguments, stop=lambda: training.updates >= 500 or bool(stop and stop()), **more)

    monkeypatch.setattr(Training, "run", run)


@pytest.mark.usefixtures("short_trainings")
@pytest.mark.parametrize("path", SOLVED, ids=lambda path: path.stem)
def test_in_a_solved_notebook_every_check_passes_and_what_uses_a_solution_runs(path, monkeypatch):
    monkeypatch.chdir(path.parent)
    cells = cells_to_run(code_of(path), code_of(path.parent.parent / path.name))
    assert any(cell.startswith("check.strict()") for cell in cells) and sum("\ncheck." in cell for cell in cells) > 0
    execute(cells)
