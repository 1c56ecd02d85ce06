"""Files of a user's own: `FILE.py:NAME` on the command line, and answers that a lesson kept."""

import sys
from pathlib import Path

import pytest

from bootcourse.cli.own_files import loaded
from bootcourse.course import answer_files
from bootcourse.errors import BootcourseError

WITH_DATACLASS = """from __future__ import annotations
from dataclasses import dataclass

@dataclass
class Limit:
    speed: float = 12.0

def rule():
    return Limit().speed
"""


@pytest.fixture(autouse=True)
def folder(tmp_path, monkeypatch):
    """A folder with files; what they import is forgotten afterwards."""
    monkeypatch.chdir(tmp_path)
    monkeypatch.setattr(sys, "path", [*sys.path])
    before = set(sys.modules)
    yield tmp_path
    for name in set(sys.modules) - before:
        del sys.modules[name]


def write(name: str, text: str) -> None:
    Path(name).parent.mkdir(exist_ok=True)
    Path(name).write_text(text)


def test_a_file_imports_its_neighbours_also_when_it_is_called():
    write("rules/limits_of_mine.py", "LIMIT = 7")
    write("rules/later_of_mine.py", "LIMIT = 3")
    rule = (
        "from limits_of_mine import LIMIT\ndef rule():\n    import later_of_mine\n    return LIMIT, later_of_mine.LIMIT"
    )
    write("rules/mine.py", rule)
    assert loaded("rules/mine.py:rule", "--teacher", "function")() == (7, 3)


def test_a_file_beside_it_does_not_replace_a_module_of_python(monkeypatch):
    monkeypatch.delitem(sys.modules, "colorsys", raising=False)
    write("rules/colorsys.py", "raise RuntimeError('the user has this file, too')")
    write("rules/mine.py", "def rule():\n    import colorsys\n    return colorsys.rgb_to_hsv(0, 0, 1)")
    assert loaded("rules/mine.py:rule", "--teacher", "function")() == (2 / 3, 1, 1)


def test_a_file_may_hold_dataclasses_with_postponed_annotations():
    write("mine.py", WITH_DATACLASS)
    assert loaded("mine.py:rule", "--teacher", "function")() == 12.0


def test_two_files_of_one_name_and_their_neighbours_of_one_name_do_not_meet():
    for number in (1, 2):
        write(f"rules{number}/mine.py", "import same_of_mine\ndef rule():\n    return same_of_mine.NUMBER")
        write(f"rules{number}/same_of_mine.py", f"NUMBER = {number}")
    first, second = (loaded(f"rules{number}/mine.py:rule", "--teacher", "function") for number in (1, 2))
    assert (first(), second()) == (1, 2) and first.__module__ != second.__module__
    assert sys.modules[first.__module__].rule is first, "a class is found by the name of its module"


def test_a_file_that_does_not_load_leaves_no_half_module():
    write("mine.py", "import nowhere_at_all")
    before = set(sys.modules)
    with pytest.raises(BootcourseError, match="mine.py cannot be loaded: ModuleNotFoundError"):
        loaded("mine.py:rule", "--teacher", "function")
    assert set(sys.modules) == before


def test_an_answer_that_was_kept_may_be_a_dataclass_with_postponed_annotations():
    write("answers/rule.py", WITH_DATACLASS)
    assert answer_files.read("rule")() == 12.0 and "answers_rule" not in sys.modules
