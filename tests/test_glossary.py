"""The glossary: every new word of the lessons is in it, in order, once, with a lesson that uses it."""

import pytest

from tools.course.glossary import bold, entries, glossaries, introduced, letters, normalised, uses
from tools.course.reference import lessons

WORDS, SYMBOLS = glossaries()
EVERY = [(entry, entry in SYMBOLS) for entry in WORDS + SYMBOLS]


def ids(value):
    return value.terms[0] if hasattr(value, "terms") else ""


def test_every_word_that_a_lesson_introduces_is_in_the_glossary():
    known = {normalised(term) for entry in WORDS for term in entry.terms}
    missing = [f"{term} (lesson {number})" for term, number in introduced().items() if term not in known]
    assert introduced() and missing == [], "write an entry, or call it stressed in tools/course/glossary.py"


def test_the_paper_s_symbols_are_there():
    terms = {term for entry in SYMBOLS for term in entry.terms}
    assert terms >= set("p ξ c β η α γ μ π π̃ Q d_s d_e D_KL J_E l r s a θ T V v_target w_v r_v".split())


@pytest.mark.parametrize("glossary", (WORDS, SYMBOLS), ids=("words", "symbols"))
def test_the_entries_are_sorted_and_no_term_is_twice(glossary):
    first = [entry.terms[0].casefold() for entry in glossary]
    assert first == sorted(first)
    terms = [normalised(term) if glossary is WORDS else term for entry in glossary for term in entry.terms]
    assert len(terms) == len(set(terms))


@pytest.mark.parametrize("entry, symbol", EVERY, ids=ids)
def test_an_entry_explains_and_names_a_lesson_that_uses_it(entry, symbol):
    assert entry.terms and 15 < len(entry.text) < 260 and entry.text[-1] in ".)"
    assert entry.lesson in lessons(), "end it with the lesson, as in: Lesson 7."
    assert any(uses(entry.lesson, term, symbol) for term in entry.terms)


@pytest.mark.parametrize("entry", WORDS, ids=ids)
def test_an_entry_names_the_first_lesson_that_has_it_in_bold(entry):
    in_bold = [introduced()[normalised(term)] for term in entry.terms if normalised(term) in introduced()]
    assert not in_bold or entry.lesson == min(in_bold)


# Pieces ---------------------------------------------------------------------------------------------


def test_a_term_is_bold_inside_a_sentence_and_a_label_is_not():
    text = """# A **heading**

**Time** 5 minutes. **It builds on** nothing.

> **Predict.** What is **entropy**?

**See.** A **policy
gradient** is new, and **Success** begins no label. **Exercise 1.1 (5 min, ●○○).** Write it.

**Critics** are two.

**The actor's**: minus V.

- **Discount.** Perhaps.
- **rarest**: the smallest.
1. **drives** as well.
"""
    assert bold(text) == ["entropy", "policy gradient", "Success", "Critics"]


def test_capitals_and_plurals_do_not_make_another_term():
    assert normalised("Target networks") == normalised("target network")
    assert normalised("A loss") == "a loss" and normalised("agents") == "agent"


def test_an_entry_has_terms_a_text_and_a_lesson():
    (entry, other) = entries("KL\nKullback\n  A number,\n  in nats. Lesson 7.\n\nnat\n  A unit.\n")
    assert entry.terms == ("KL", "Kullback") and entry.text == "A number, in nats." and entry.lesson == 7
    assert other.lesson is None


def test_symbols_of_latex_are_read_as_letters():
    assert (
        letters(r"\tilde\pi(a|s) + v_\text{target} + \xi D_\mathrm{KL} + w_\theta")
        == "π̃(a|s) + v_target + ξ D_KL + w_θ"
    )
    assert uses(7, "ξ", True) and not uses(1, "J_E", True)
    assert uses(4, "target network", False) and not uses(4, "barrier", False)
