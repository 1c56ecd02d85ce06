"""Which names a cell makes and uses, and that no cell changes what another made when it runs twice."""

import ast

import pytest

from bootcourse.course.names import names_made, names_used
from tools.course.problems import of_order
from tools.course.source import Cell


def test_the_names_that_a_cell_makes_are_its_imports_definitions_and_variables():
    cell = "import numpy as np\nfrom os import path as place\nlater, (a, b) = 1, (2, 3)\ndef helper():\n    inside = 1"
    assert names_made(cell) == {"np", "place", "later", "a", "b", "helper"}
    assert names_made("later = [i for i in range(3)]") == {"later"} and names_made("later = (") == set()


def test_the_names_that_a_cell_uses_are_those_that_it_reads_inside_functions_too():
    cell = "def helper(x):\n    inside = SHARE * x\n    return np.exp(inside)\nprint(later)"
    assert names_used(cell) == {"SHARE", "np", "print", "later"}


TWICE = {
    "x = 1\nx += 1": [],
    "rows = []\nrows.append(1)": [],
    "def f(rows):\n    rows.append(1)": [],
    "settings.update(a=1)": [],
    "settings |= {1: 2}": [],
    "x += 1": ["x"],
    "rows.append(1)": ["rows"],
    "for i in range(3):\n    learner.update(i)": ["learner"],
}


@pytest.mark.parametrize("code", TWICE, ids=lambda code: code.splitlines()[-1].strip())
def test_a_cell_that_would_change_another_s_work_twice_is_found(code):
    ast.parse(code)
    said = of_order([Cell("code", code, code, {})])
    assert [sentence.split("`")[1] for sentence in said] == TWICE[code]
