"""A slice of `python -m tests.hostile`: damaged files of every kind, and scripts in every text of a rollout."""

import pytest

from bootcourse.errors import BootcourseError
from tests.browser import needs_browser
from tests.hostile import damage, payloads


@pytest.fixture(scope="module")
def outcomes():
    return damage.damage(153, seed=0)


def test_a_damaged_file_is_read_right_or_refused_in_one_sentence_that_names_it(outcomes):
    for kind, by in outcomes.items():
        assert by["traceback"] == [] and by["refused"], kind


def test_damage_by_chance_is_never_read_as_something_else(outcomes):
    assert {kind: by["wrong"] for kind, by in outcomes.items() if by["wrong"]} == {}


def test_text_where_a_number_belongs_is_refused_in_every_field_of_every_file(tmp_path):
    tried = 0
    for kind in damage.kinds(tmp_path):
        whole = kind.path.read_bytes()
        for field, changed in damage.with_text_for_numbers(kind.path):
            kind.path.write_bytes(changed)
            kind.resealed(kind.path)
            with pytest.raises(BootcourseError):
                kind.read(kind.path)
                pytest.fail(f"{kind.name}: {field} was read")
            tried += 1
        kind.path.write_bytes(whole)
        kind.resealed(kind.path)
    assert tried > 200


@needs_browser
def test_no_text_of_a_rollout_runs_in_a_page_that_shows_it():
    found = payloads.shown()
    assert found.pop("control"), "the payload runs nowhere: this test sees nothing"
    assert found == {"recording": [], "export": [], "live replay": []}
