"""Which names a cell makes and uses."""

from bootcourse.course.names import names_made, names_used


def test_the_names_that_a_cell_makes_are_its_imports_definitions_and_variables():
    cell = "import numpy as np\nfrom os import path as place\nlater, (a, b) = 1, (2, 3)\ndef helper():\n    inside = 1"
    assert names_made(cell) == {"np", "place", "later", "a", "b", "helper"}
    assert names_made("later = [i for i in range(3)]") == {"later"} and names_made("later = (") == set()


def test_the_names_that_a_cell_uses_are_those_that_it_reads_inside_functions_too():
    cell = "def helper(x):\n    inside = SHARE * x\n    return np.exp(inside)\nprint(later)"
    assert names_used(cell) == {"SHARE", "np", "print", "later"}
