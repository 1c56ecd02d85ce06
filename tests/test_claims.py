"""The numbers in the lessons' text come from where their claims say, and a number without a claim is found."""

import json
from pathlib import Path

import pytest

from tools.course import known
from tools.course.claims import claims_file, claims_of, claims_page, claims_problems
from tools.course.prose import Line, Number, lines
from tools.course.source import NOTEBOOKS, sources

# The lessons ----------------------------------------------------------------------------------------


@pytest.mark.parametrize("path", sources(), ids=lambda path: path.stem)
def test_every_number_in_the_prose_has_its_evidence_and_agrees_with_it(path):
    assert claims_problems(path, vars(known)) == []


def test_every_file_of_claims_belongs_to_a_lesson():
    assert {file.stem for file in (NOTEBOOKS / "claims").iterdir()} <= {path.stem for path in sources()}


def test_the_page_tells_every_claim_of_every_lesson_and_what_it_computes_to():
    page = claims_page()
    rows = [row for row in page.splitlines() if row.startswith("| ") and row != "| the lesson says | how it is known |"]
    assert len(rows) == sum(len(claims_of(path)) for path in sources())
    assert "## 3 · The rule" in page and "| `DEFAULT.ego.speed` = 10 |" in page


# A tiny lesson, and what spoils it ------------------------------------------------------------------

TEXT = """
# %% [markdown]
# # 3 · A lesson of 2 cells
#
# The rule falls back at 8.25 m/s, and
# pays 1,000 times. It has nine actions.
#
# - Live it was 10.4 m/s, in SQIL it is 1.
#
# > **Predict.** Would 12 m be enough?

# %%
print("live: 10.38 m/s")
"""
CLAIMS = """
[[claim]]
says = "falls back at 8.25 m/s, and pays 1,000 times."
is = "(SPEED, 999.6)"

[[claim]]
says = "It has nine actions."
is = "9"

[[claim]]
says = "It has nine actions."
holds = "SPEED > 8"

[[claim]]
says = "Live it was 10.4 m/s"
shown = "live: 10.38 m/s"

[[claim]]
says = "in SQIL it is 1."
paper = "arXiv 1905.11108"
"""
KNOWN = {"SPEED": 8.2479}


def lesson(folder: Path, text: str = TEXT, claims: str = CLAIMS) -> Path:
    """The tiny lesson on disk: its source, its executed notebook, its claims."""
    path = folder / "notebooks/source/03_tiny.py"
    path.parent.mkdir(parents=True)
    path.write_text(text, encoding="utf-8")
    printed = {"output_type": "stream", "text": ["live: 10.38 m/s\n"]}
    cell = {"cell_type": "code", "source": ['print("live: ...")'], "outputs": [printed]}
    (path.parent.parent / "03_tiny.ipynb").write_text(json.dumps({"cells": [cell]}), encoding="utf-8")
    claims_file(path).parent.mkdir()
    claims_file(path).write_text(claims, encoding="utf-8")
    return path


def test_nothing_is_wrong_with_the_tiny_lesson(tmp_path):
    assert claims_problems(lesson(tmp_path), KNOWN) == []


SPOILT = {  # what changes in the text, what in the claims: old -> new
    "the text prints another number": ("8.25 -> 8.27", "", "is not in the text"),
    "text and claim print another number": ("8.25 -> 8.27", "8.25 -> 8.27", "8.27, 1,000; computed: 8.2479, 999.6"),
    "a word says another number": ("nine -> eight", "nine -> eight", "prints eight; computed: 9"),
    "a number has no claim": ("be enough? -> be enough?\n#\n# Then 31 m.", "", 'where 31 comes from in "Then 31 m."'),
    "half of a number is claimed": ("", "10.4 m/s -> 10", "where 10.4 comes from"),
    "a claim is not in the text": ("", "It has nine -> She has nine", '"She has nine actions." is not in the text'),
    "claims stand in another order": ("- Live -> - In SQIL it is 1. Live", "in SQIL -> In SQIL", "not behind the"),
    "an expression has a name that nobody knows": ("", "(SPEED -> (SPED", "NameError: name 'SPED'"),
    "an expression is none": ("", "(SPEED, -> (SPEED", "gives no answer (SyntaxError"),
    "an expression gives too few numbers": ("", "(SPEED, 999.6) -> SPEED", "prints 8.25, 1,000; computed: 8.2479."),
    "what should hold does not": ("", "SPEED > 8 -> SPEED > 9", "`SPEED > 9` does not hold"),
    "what should hold is a number": ("", "SPEED > 8 -> SPEED", "neither true nor false"),
    "what should hold is about another number": ("", 'shown = "live: 10.38 m/s" -> holds = "SPEED < 11"', "the 10.4"),
    "no cell shows what should be shown": ("", "10.38 -> 10.37", "no cell shows `live: 10.37 m/s`"),
    "what is shown has another number": ("10.4 -> 10.5", "10.4 -> 10.5", "the 10.5 is not in `live: 10.38 m/s`"),
    "a quotation says not where": ("", "arXiv 1905.11108 -> somewhere", '"somewhere" names no section'),
    "an example has no number": ("", 'holds = "SPEED > 8" -> example = "why"', "this one has none"),
    "a claim has two kinds of evidence": ("", 'is = "9" -> is = "9"\nexample = "why"', "A claim has `says` and one of"),
    "a claim has evidence of no kind": ("", 'is = "9" -> was = "9"', "A claim has `says` and one of"),
}  # fmt: skip


def changed(text: str, change: str) -> str:
    old, _, new = change.partition(" -> ")
    assert old in text
    return text.replace(old, new) if old else text


@pytest.mark.parametrize("in_text, in_claims, words", SPOILT.values(), ids=SPOILT)
def test_it_is_found_when(tmp_path, in_text, in_claims, words):
    problems = claims_problems(lesson(tmp_path, changed(TEXT, in_text), changed(CLAIMS, in_claims)), KNOWN)
    assert any(words in problem for problem in problems), problems


def test_a_lesson_without_a_file_of_claims_has_none(tmp_path):
    path = lesson(tmp_path)
    claims_file(path).unlink()
    assert claims_of(path) == [] and len(claims_problems(path, KNOWN)) == 2


# Numbers --------------------------------------------------------------------------------------------

PRINTED = {
    "Doing nothing earns 23.4 over 1,500 m": "23.4 1,500",
    "from −10 to +1, 0..8, (3–5), 200α, 1 − 1": "−10 1 0 8 3 5 200 1 1",
    "in 3D, H200, 4x, v_1 and x^2": "",
    "## Round 3: 4 m": "",
    "**Time** 60 minutes. **It builds on** the rule (3).": "",
    "**Exercise 3.1 (6 min, ●○○).** Write 7 lines.": "7",
    "3. The third of 4": "4",
    "lesson 3, 27 of them; lessons 6 to 8; Table 2; round 4": "27",
    "trap 1, lane 0, seed 7, car 2": "",
    "`UPDATES = 5000` and [the 2nd](02_traffic.ipynb)": "",
    "(arXiv 1801.01290), *a book* (2nd edition, 2018), *a journal* 10 (2008) 033001": "",
    "its 95 % interval holds 95 % of them": "95",
    "Is it 3 or 4? It is 5.": "5",
    "r + γ (1 − terminated) V, all T + 1 states": "",
    r"$$ v = 6 + \tfrac{i-1}{4}\,(15 - 6), \quad a \ge 0.5, \quad l = 0 $$": "6 0.5",
}  # fmt: skip


@pytest.mark.parametrize("text, printed", PRINTED.items())
def test_numbers_need_evidence_unless_their_form_excuses_them(text, printed):
    assert [number.printed for number in Line(text, quiet=False).numbers] == printed.split()


def test_predictions_and_the_three_questions_need_no_evidence():
    cell = "> **Predict.** 3 m\n> or 4?\n>\n> - 5 m\n\nIt is 6.\n\n**Three questions to think about**\n- 7 s\n- 8 s"
    assert [number.printed for line in lines(cell) for number in line.numbers] == ["6"]


def test_a_cell_is_cut_into_headings_paragraphs_points_and_rows():
    cell = "# 3\nOne\ntwo.\n- a\n  b\n- c\n1. d\n\n```python\ncode\n```\n| e | f |\n| g | h |"
    cut = ["# 3", "One two.", "- a b", "- c", "1. d", "| e | f |", "| g | h |"]
    assert [line.text for line in lines(cell)] == cut


@pytest.mark.parametrize(
    "printed, computed, agrees",
    [("8.25", 8.2549, True), ("8.25", 8.2551, False), ("23.4", 23.4375, True), ("1,000", 999.6, True),
     ("−10", -10, True), ("−10", 10, False), ("0.5", 0.45, True), ("600", 612, False), ("nine", 9, True)],
)  # fmt: skip
def test_a_number_agrees_with_what_is_computed_as_far_as_it_is_printed(printed, computed, agrees):
    assert Number(printed, 0, len(printed)).agrees(computed) == agrees
