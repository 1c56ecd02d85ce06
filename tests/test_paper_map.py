"""The paper map: every numbered thing of the paper is there once, in the kit and in a lesson, and says so truly."""

import inspect
import pkgutil
import re
from dataclasses import replace

import pytest

from tools.course import paper_map
from tools.course.paper_map import PAGE, Taught, exercise_number, in_code, items, page, problems, values

# The paper's structure, in the order of its LaTeX source: figures, equations, tables, an algorithm.
IN_ORDER = """
F1 F2 F3 E1 E2 T1 E3 E4 E5 T2 E6 E7 E8 E9 E10 E11 E12 T3 E13 A1 E14
E15 E16 E17 E18 E19 E20 F4 F5 F6 T4 F7 T5 E21 E22
""".split()
COUNTS = {"equation": 22, "table": 5, "figure": 7, "algorithm": 1}
ROWS = {"Table 1, simulation settings": 5, "Table 2, traffic": 8, "Table 3, the learner and the reward": 13}


@pytest.mark.parametrize("kind", COUNTS)
def test_nothing_of_the_paper_is_missing_or_twice(kind):
    numbers = [item.number for item in items() if item.kind == kind]
    assert sorted(numbers) == list(range(1, COUNTS[kind] + 1))


def test_the_map_goes_through_the_paper_in_its_own_order():
    assert [f"{item.kind[0].upper()}{item.number}" for item in items()] == IN_ORDER
    titles = [item.section for item in items()]
    assert list(dict.fromkeys(titles)) == sorted(set(titles), key=titles.index) and len(set(titles)) == 11


def test_all_code_exists_and_every_lesson_teaches_what_the_map_says():
    assert problems() == []


def test_the_page_is_what_the_data_says():
    assert PAGE.read_text(encoding="utf-8") == page(), "run python -m tools.course.paper_map"


@pytest.mark.parametrize("number", range(1, COUNTS["equation"] + 1))
def test_the_code_of_an_equation_names_it(number):
    item = next(item for item in items() if (item.kind, item.number) == ("equation", number))
    told = [inspect.getdoc(thing) or "" for thing in map(pkgutil.resolve_name, item.code) if callable(thing)]
    assert any(re.search(rf"Equations? (\d+(, | and ))*{number}\b", text) for text in told)


@pytest.mark.parametrize("value", values(), ids=lambda value: value.code[0].removeprefix("bootcourse."))
def test_a_default_of_the_kit_is_what_the_paper_prints(value):
    assert in_code(value) == pytest.approx(value.printed, rel=1e-12)


@pytest.mark.parametrize("where", ROWS)
def test_every_row_of_a_table_of_settings_is_there(where):
    assert len([value for value in values() if value.where == where]) == ROWS[where]


def test_the_number_of_an_exercise_is_the_lesson_s_own():
    assert exercise_number("07_soft_constraint", "soft_constraint") == "7.2"
    assert exercise_number("08_learning_from_demonstrations", "q_filter") == "8.4"
    assert exercise_number("03_the_rule", "soft_constraint") == "", "it belongs to another lesson"


SPOILT = {
    "code is gone": ({"code": ("bootcourse.rule.unsafety_distance",)}, "does not exist"),
    "no code is named": ({"code": ()}, "it needs code and a lesson"),
    "there is no such lesson": ({"taught": (Taught("99_nothing"),)}, "there is no lesson 99_nothing"),
    "the exercise is another lesson's": (
        {"taught": (Taught("04_discrete_sac", exercise="safety_distance"),)},
        "04_discrete_sac has no exercise safety_distance",
    ),
    "the lesson does not say it": (
        {"taught": (Taught("03_the_rule", words="Markov decision process"),)},
        "'Markov decision process' does not stand in 03_the_rule",
    ),
    "the lesson never mentions the code": (
        {"taught": (Taught("02_traffic"),)},
        "02_traffic mentions none of safety_distance",
    ),
    "a note has no heading": ({"see": ""}, "a note goes with a heading"),
}


@pytest.mark.parametrize("changes, words", SPOILT.values(), ids=SPOILT)
def test_it_is_found_when(monkeypatch, changes, words):
    spoilt = [replace(item, **changes) if item.label == "Equation 13" else item for item in items()]
    monkeypatch.setattr(paper_map, "items", lambda: spoilt)
    assert any(words in problem for problem in problems()), problems()


def test_every_line_of_a_table_has_as_many_cells_as_its_heading():
    for block in re.findall(r"(?:^\|.*\n)+", page(), re.M):
        cells = {line.count("|") for line in block.splitlines()}
        assert len(cells) == 1, block
