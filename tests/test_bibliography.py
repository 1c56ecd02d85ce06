"""The bibliography: what is cited is in it, with a number that leads to it, and what is in it is used."""

from itertools import pairwise

import pytest

from tools.course.bibliography import (
    ARXIV,
    CITED_YEAR,
    cited_numbers,
    cited_years,
    citing,
    entries,
    lesson_text,
)
from tools.course.reference import lessons

ENTRIES = entries()


def ids(entry):
    return f"{entry.first_author} {entry.year}"


def test_every_arxiv_number_that_is_cited_is_in_the_bibliography():
    known = {number for entry in ENTRIES for number, _ in entry.numbers}
    assert len(cited_numbers()) > 20 and [cited for cited in cited_numbers() if cited[0] not in known] == []


def test_every_year_that_is_cited_with_a_name_is_in_the_bibliography():
    missing = [
        f"{year} in {where}, after: {before[-60:]}"
        for year, before, where in cited_years()
        if not any(entry.year == year and entry.first_author in before for entry in ENTRIES)
    ]
    assert len(cited_years()) > 10 and missing == []


@pytest.mark.parametrize("entry", ENTRIES, ids=ids)
def test_an_entry_has_a_number_that_leads_to_it(entry):
    assert entry.can_be_found
    assert all(printed == linked for printed, linked in entry.numbers)


@pytest.mark.parametrize("entry", ENTRIES, ids=ids)
def test_an_entry_is_used_where_it_says(entry):
    assert entry.lessons or "`bootcourse." in entry.text or entry.group == "The paper"
    for lesson in entry.lessons:
        (path,) = [path for path in lessons().values() if path.stem == lesson]
        assert entry.first_author in lesson_text(path)


def test_the_entries_of_a_group_are_sorted_and_none_is_twice():
    for one, next_one in pairwise(ENTRIES):
        if one.group == next_one.group and one.group != "The paper":
            assert (one.first_author.casefold(), one.year) <= (next_one.first_author.casefold(), next_one.year)
    numbers = [number for entry in ENTRIES for number, _ in entry.numbers]
    assert len(numbers) == len(set(numbers))


# Pieces ---------------------------------------------------------------------------------------------


def test_numbers_and_years_are_found_in_the_forms_that_the_course_uses():
    assert ARXIV.findall("(arXiv 1801.01290), arXiv\n1812.05905, arXiv: 1910.07207 and 2020.12345") == [
        "1801.01290",
        "1812.05905",
        "1910.07207",
    ]
    found = CITED_YEAR.findall("Efron (1979); Ross and Bagnell 2010). In 2000 steps, (2000 * 3), Pomerleau 1991, yes")
    assert [one or two for one, two in found] == ["1979", "2010", "1991"]


def test_the_library_s_docstrings_and_the_instructor_s_notes_may_cite():
    assert "1606.03476" in citing()["bootcourse/learn/gail.py"] and "Sugiyama" in citing()["02_traffic"]
