"""A slice of `python -m tests.hostile`: damaged files of every kind, and scripts in every text of a rollout."""

import pytest

from tests.browser import needs_browser
from tests.hostile import damage, payloads

UNSEALED = {"run: provenance.json", "manifest"}  # they hold hashes of other files, and none of their own


@pytest.fixture(scope="module")
def outcomes():
    return damage.damage(153, seed=0)


def test_a_damaged_file_is_read_right_or_refused_in_one_sentence_that_names_it(outcomes):
    for kind, by in outcomes.items():
        assert by["traceback"] == [] and by["refused"], kind


def test_damage_by_chance_is_never_read_as_something_else_where_a_file_has_a_checksum(outcomes):
    assert {kind for kind, by in outcomes.items() if by["wrong"]} <= UNSEALED


@needs_browser
def test_no_text_of_a_rollout_runs_in_a_page_that_shows_it():
    found = payloads.shown()
    assert found.pop("control"), "the payload runs nowhere: this test sees nothing"
    assert found == {"recording": [], "export": [], "live replay": []}
