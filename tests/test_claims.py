"""The numbers in the lessons' text are computed when the lessons are made, and their claims hold.

That the lessons themselves are made from what the expressions yield now is tested in test_course.py.
"""

import pytest

from tools.course.claims import check_claims, entry, fill_in, paragraphs

TEXT = """\
The rule falls back at {{ 8.2479 | .2f }} m/s, and pays {{ 999.6 | ,.0f }} times,
{{ -10.0 }} each. It never stops.
<!-- claim: len(range(9)) ==
  9 -->
"""


def test_numbers_are_filled_in_and_claims_taken_out():
    check_claims(TEXT)
    filled = "The rule falls back at 8.25 m/s, and pays 1,000 times,\n−10 each. It never stops."
    assert fill_in(TEXT).strip() == filled


@pytest.mark.parametrize(
    "text, printed",
    [("{{ 10.0 }}", "10"), ("{{ 0.25 }}", "0.25"), ("{{ 23.4375 | .1f }}", "23.4"), ("{{ 1000 | , }}", "1,000"),
     ("{{ -1 }} or {{\n2 }}", "−1 or 2"), ("{{ {1: 'a | b'}[1] }}", "a | b"), (r"\sqrt{a_{\max}}", r"\sqrt{a_{\max}}")],
)  # fmt: skip
def test_a_value_is_printed_as_its_format_says(text, printed):
    assert fill_in(text) == printed


@pytest.mark.parametrize(
    "text, words",
    [
        ("<!-- claim: 8 > 9 -->", "`8 > 9` is False"),
        ("<!-- claim: 8 -->", "`8` is 8"),
        ("{{ SPED }}", r"`SPED` has no value \(NameError"),
        ("{{ (3 }}", r"`\(3` has no value \(SyntaxError"),
        ("{{ 3 | .2q }}", "`3` cannot be printed as .2q"),
        ("{{ 3 }", "neither a number nor a claim"),
        ("<!-- claim 3 -->", "neither a number nor a claim"),
    ],
)
def test_what_is_wrong_with_an_expression_is_said(text, words):
    with pytest.raises(ValueError, match=words):
        check_claims(text)
        fill_in(text)


def test_the_page_of_claims_has_no_links_to_lessons_and_a_list_is_not_printed_twice():
    page = entry("Lessons:\n\n{{ way('evening') }}", "start")
    assert "](" not in page and "- `way('evening')`: the list above" in page


def test_an_expression_with_a_minus_at_the_beginning_of_a_line_is_no_list():
    text = "It gains {{ 28\n- 3 }}.\n<!-- claim: 28\n  - 3 > 0 -->\n- a point"
    assert paragraphs(text) == ["It gains {{ 28 - 3 }}.<!-- claim: 28 - 3 > 0 -->", "- a point"]
