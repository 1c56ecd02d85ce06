"""A solution that is changed in one place is refused, unless a reason says why the change gives the same answers."""

import pytest

from bootcourse.course.lessons import registry
from tests.answers import EQUIVALENT
from tests.mutants import left_out, surviving


@pytest.mark.parametrize("exercise", [e for e in registry().values() if not left_out(e)], ids=lambda e: e.name)
def test_the_cases_of_an_exercise_refuse_its_solution_with_one_place_changed(exercise):
    tried, accepted = surviving(exercise)
    assert set(accepted) == set(EQUIVALENT[exercise.name])
    assert tried > 1  # something was changed, whatever the solution looks like
