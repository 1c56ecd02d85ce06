"""The numbers in the lessons' text are computed when the lessons are made, and their claims hold.

That the lessons themselves are made from what the expressions yield now is tested in test_course.py.
"""

from functools import cache

import pytest

from tools.course import claims, known
from tools.course.claims import claims_page, fill_in, filled, unclaimed
from tools.course.problems import problems
from tools.course.products import documents, instructor_file, refresh_prose, student_file, write
from tools.course.source import read, sources

TEXT = """\
# %% [markdown]
# # 3 · A lesson
#
# The rule falls back at {{ SPEED | .2f }} m/s, and pays {{ 999.6 | ,.0f }} times,
# {{ -10.0 }} each. It has nine actions. It never stops.
# <!-- claim: SPEED > 8 -->
# <!-- claim: len(range(9)) ==
#   9 -->
#
# - Nobody overtakes it. No? It is a [rule](03_the_rule.ipynb).

# %% [markdown] tags=["instructor"]
# > **Predict.** Are all of {{ 3 * 4 }} enough?
"""


@pytest.fixture
def lesson(tmp_path, monkeypatch):
    """Write a tiny lesson's source and give its path; expressions know SPEED."""
    monkeypatch.setattr(known, "SPEED", 8.2479, raising=False)
    monkeypatch.setattr(claims, "value", cache(claims.value.__wrapped__))  # the real lessons' values are kept

    def written(text=TEXT):
        path = tmp_path / "notebooks/source/03_tiny.py"
        path.parent.mkdir(parents=True, exist_ok=True)
        path.write_text(text, encoding="utf-8")
        return path

    return written


def test_numbers_are_filled_in_and_claims_taken_out(lesson):
    first, second = filled(lesson())
    assert first.student == first.solved
    assert first.student == (
        "# 3 · A lesson\n\nThe rule falls back at 8.25 m/s, and pays 1,000 times,\n−10 each. It has nine actions. "
        "It never stops.\n\n- Nobody overtakes it. No? It is a [rule](03_the_rule.ipynb)."
    )
    assert "all of 12 enough" in second.student


def test_the_notebook_and_the_instructor_s_page_have_the_numbers(lesson):
    path = lesson()
    write(path, documents(path))
    for file, words in ((student_file(path), "back at 8.25 m/s"), (instructor_file(path), "all of 12 enough")):
        text = file.read_text(encoding="utf-8")
        assert words in text and "{{" not in text and "claim" not in text
    assert problems(path) == []


def test_a_result_that_has_changed_is_found_and_prose_takes_it_over(lesson, monkeypatch):
    path = lesson()
    write(path, documents(path))
    monkeypatch.setattr(known, "SPEED", 8.5)
    claims.value.cache_clear()
    assert problems(path) == ["notebooks/03_tiny.ipynb is out of date: run make notebooks."]
    assert refresh_prose(path) and problems(path) == []
    assert "back at 8.50 m/s" in student_file(path).read_text(encoding="utf-8")


SPOILT = {
    "a claim is false": ("SPEED > 8", "SPEED > 9", "`SPEED > 9` is False"),
    "a claim compares nothing": ("SPEED > 8", "SPEED", "`SPEED` is 8.2479"),
    "a name is unknown": ("{{ SPEED", "{{ SPED", "`SPED` has no value (NameError"),
    "an expression is none": ("{{ SPEED", "{{ (SPEED", "`(SPEED` has no value (SyntaxError"),
    "a format is none": ("| .2f", "| .2q", "`SPEED` cannot be printed as .2q"),
    "a number is not closed": ("-10.0 }}", "-10.0 }", "neither a number nor a claim"),
    "a claim has no colon": ("claim: SPEED", "claim SPEED", "neither a number nor a claim"),
}  # fmt: skip


@pytest.mark.parametrize("old, new, words", SPOILT.values(), ids=SPOILT)
def test_it_is_found_when(lesson, old, new, words):
    assert old in TEXT
    (problem,) = problems(lesson(TEXT.replace(old, new)))
    assert words in problem


@pytest.mark.parametrize(
    "text, printed",
    [("{{ 10.0 }}", "10"), ("{{ 0.25 }}", "0.25"), ("{{ 23.4375 | .1f }}", "23.4"), ("{{ 1000 | , }}", "1,000"),
     ("{{ -1 }} or {{\n2 }}", "−1 or 2"), ("{{ {1: 'a | b'}[1] }}", "a | b"), (r"\sqrt{a_{\max}}", r"\sqrt{a_{\max}}")],
)  # fmt: skip
def test_a_value_is_printed_as_its_format_says(text, printed):
    assert fill_in(text) == printed


def test_sentences_about_all_cases_are_reported_where_their_paragraph_has_no_claim(lesson):
    assert unclaimed(lesson()) == ["- Nobody overtakes it."]
    without = TEXT.replace("# <!-- claim: SPEED > 8 -->\n", "").replace(
        "# <!-- claim: len(range(9)) ==\n#   9 -->\n", ""
    )
    assert unclaimed(lesson(without)) == ["It never stops.", "- Nobody overtakes it."]


@pytest.mark.parametrize("path", sources(), ids=lambda path: path.stem)
def test_a_sentence_about_all_cases_has_a_claim_in(path):
    assert unclaimed(path) == [], "give each a claim, or say what was seen: see notebooks/source/README.md"


def test_the_page_has_every_paragraph_with_a_number_or_a_claim_and_what_it_comes_from(lesson):
    page = claims_page(lesson().parent.parent)
    assert "## 3 · A lesson" in page and "> −10 each. It has nine actions. It never stops.\n" in page
    assert "- `SPEED` = 8.25\n" in page and "- `len(range(9)) == 9` is true\n" in page
    assert "Nobody" not in page and "](03" not in page


def test_numbers_and_claims_are_not_searched_for_words(lesson):
    assert read(lesson())[0].words.startswith("# 3 · A lesson\n\nThe rule falls back at … m/s")
    assert "range" not in read(lesson())[0].words
