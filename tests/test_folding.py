"""Which code cells the book folds: those that only draw."""

import json

import pytest

from tools.course.folding import folded, only_draws
from tools.course.source import NOTEBOOKS

DRAWS = "rows = []\nfor name in names:\n    rows.append([name])\ntable(['name'], rows)"


def test_a_cell_that_only_draws_is_folded():
    assert only_draws(DRAWS, [])
    assert only_draws("title = 'A'\nlook = 'b'\nbc.show(charts.lines(x, title, look))", ["title = 'B'\nbc.show(title)"])


@pytest.mark.parametrize(
    "text, later, why",
    [
        (DRAWS, ["print(rows)"], "a later cell uses its rows"),
        (DRAWS, ["rows = rows + [1]"], "a later cell goes on with its rows"),
        (DRAWS.replace("rows = []", "rows = []  # change it"), [], "it speaks to the reader"),
        (DRAWS.replace("[name]", "[bc.evaluate(name)]"), [], "it tests"),
        (f"def twice(x):\n    return 2 * x\n\n\n{DRAWS}", [], "it defines a function"),
        ("bc.show(a)\nbc.show(b)", [], "it is short"),
        (f"{DRAWS}\nx = 1", [], "it ends with something else"),
    ],
)
def test_a_cell_stays_open(text, later, why):
    assert not only_draws(text, later), why


def test_the_book_folds_some_cells_of_the_lessons_and_no_exercise_or_prediction():
    found = [json.loads(folded(path.read_text(encoding="utf-8"))) for path in sorted(NOTEBOOKS.glob("*.ipynb"))]
    texts = ["".join(cell["source"]) for each in found for cell in each["cells"]
             if "hide-input" in cell["metadata"].get("tags", [])]  # fmt: skip
    assert len(texts) > 20 and not any("check." in text or "predict(" in text for text in texts)
