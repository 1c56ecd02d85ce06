"""The paper map: every numbered thing of the paper is there once, in the kit and in a lesson, and says so truly."""

import inspect
import pkgutil
import re

import pytest

from tools.course.paper_map import data, in_code, items, page

# The paper's structure, in the order of its LaTeX source: figures, equations, tables, an algorithm.
IN_ORDER = """
F1 F2 F3 E1 E2 T1 E3 E4 E5 T2 E6 E7 E8 E9 E10 E11 E12 T3 E13 A1 E14
E15 E16 E17 E18 E19 E20 F4 F5 F6 T4 F7 T5 E21 E22
""".split()
EQUATIONS = {item["number"]: item for item in items() if item["kind"] == "equation"}


def test_the_map_goes_through_the_whole_paper_in_its_own_order():
    assert [f"{item['kind'][0].upper()}{item['number']}" for item in items()] == IN_ORDER


def test_the_page_finds_all_that_the_map_names():
    assert page().startswith("# ")


@pytest.mark.parametrize("number", EQUATIONS)
def test_the_code_of_an_equation_names_it(number):
    code = [thing for thing in map(pkgutil.resolve_name, EQUATIONS[number]["code"]) if callable(thing)]
    assert any(re.search(rf"Equations? (\d+(, | and ))*{number}\b", inspect.getdoc(thing) or "") for thing in code)


@pytest.mark.parametrize("value", data()["value"], ids=lambda value: value["code"][0].removeprefix("bootcourse."))
def test_a_default_of_the_kit_is_what_the_paper_prints(value):
    assert in_code(value) == pytest.approx(value["printed"], rel=1e-12)
