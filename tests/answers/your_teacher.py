"""Answers to the exercises of the lesson on a teacher of your own."""

import numpy as np

from bootcourse.learn import teachers as teacher
from bootcourse.road.state import EGO, LANE, X, Y
from tests.answers import right, wrong, wrong_lines


@right("my_rule")
def the_course_s(cars, scenario):
    return teacher.course_rule(cars[None], scenario)[0]


wrong_lines("""my_rule
    a float: float(the_course_s(cars, scenario))  # whole number
    left at once: teacher.toward(cars, 10.0, max(int(cars[EGO, LANE]) - 1, 0), scenario)  # collides
    speed and lane: 9.0, 1  # returns
    moves the traps: cars[1:3, X] -= 50; 4  # changes its argument
""")


@wrong("my_rule", "branch without `return`")
def nothing_in_the_free_lane(cars, scenario):
    if cars[EGO, LANE] > 0:
        return the_course_s(cars, scenario)


@right("my_rule")
def late_and_slow(cars, scenario):
    """Waits until 12 m are free ahead on the left, and keeps 30 m distance there; whole numbers of NumPy's."""
    lane = int(cars[EGO, LANE])
    gap, speed = teacher.ahead(cars, lane, scenario)
    if lane == 0:
        return np.int64(teacher.toward(cars, 14.0 if gap > 30 else min(14.0, speed - 1), 0, scenario))
    free = teacher.ahead(cars, lane - 1, scenario)[0] > 12 and abs(cars[EGO, Y] - 4 * lane) < 0.5
    return np.int64(teacher.toward(cars, 8.0, lane - free, scenario))


@right("watchful_rule")
def very_patient(cars, scenario):
    """Waits until the left lane is empty for 30 m on both sides."""
    lane = int(cars[EGO, LANE])
    gap, v = teacher.ahead(cars, lane, scenario)
    if lane == 0:
        return teacher.toward(cars, 14.0 if gap > 50 else min(14.0, v - 1), 0, scenario)
    near = 30 if lane == 1 else 12
    apart = cars[cars[:, LANE] == lane - 1][:, X] - cars[EGO, X]
    free = not (np.abs(apart) < near).any()
    late = cars[EGO, Y] - 4 * lane > 0.5  # still on the way into this lane
    return teacher.toward(cars, 9.0, lane if late or not free else lane - 1, scenario)


wrong_lines("""watchful_rule
    looks ahead only: lane = int(cars[EGO, LANE])
        if lane == 0:
            return teacher.toward(cars, 12.0, 0, scenario)
        free = teacher.ahead(cars, lane - 1, scenario)[0] > 8
        teacher.toward(cars, 9.0, lane - 1 if free else lane, scenario)  # collides
""")
