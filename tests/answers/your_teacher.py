"""Answers to the exercises of the lesson on a teacher of your own."""

import numpy as np

from bootcourse.learn import teachers as teacher
from bootcourse.road.state import EGO, LANE, SPEED, X, Y
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


@wrong("watchful_rule", "branch without `return`")
def nothing_in_the_middle_lane(cars, scenario):
    if cars[EGO, LANE] != 1:
        return teacher.toward(cars, 9.0, max(int(cars[EGO, LANE]) - 1, 0), scenario)


wrong_lines("""watchful_rule
    waits for ever: teacher.toward(cars, 8.0, 2, scenario)  # stays in its lane
    a float in the left lane: action = watchful(cars, scenario)
        float(action) if cars[EGO, LANE] == 0 else action  # whole number
    changes at random: int(np.random.default_rng().integers(9))  # differently each time
    looks ahead only: lane = int(cars[EGO, LANE])
        if lane == 0:
            return teacher.toward(cars, 12.0, 0, scenario)
        free = teacher.ahead(cars, lane - 1, scenario)[0] > 8
        teacher.toward(cars, 9.0, lane - 1 if free else lane, scenario)  # collides
""")


@right("watchful_rule")
def by_the_time_until_they_meet(cars, scenario):
    """Changes where neither the car ahead nor the one behind on the left comes within 4 m in the next 4 s."""
    lane, x, v = int(cars[EGO, LANE]), cars[EGO, X], cars[EGO, SPEED]
    gap, front = teacher.ahead(cars, lane, scenario)
    if lane == 0:
        return teacher.toward(cars, 14.0 if gap > 45 else min(14.0, front - 1), 0, scenario)
    others = cars[cars[:, LANE] == lane - 1]
    apart, closing = others[:, X] - x, others[:, SPEED] - v
    now = np.abs(apart) - 5
    later = np.where(apart > 0, apart + 4 * np.minimum(closing, 0), -apart - 4 * np.maximum(closing, 0)) - 5
    free = bool((np.minimum(now, later) > 4).all())
    arrived = cars[EGO, Y] - 4 * lane < 0.5
    speed = 8.5 if lane == 2 else min(front - 0.5, 14.0) if gap > 12 else front - 1
    return teacher.toward(cars, max(6.5, speed), lane - 1 if free and arrived else lane, scenario)


wrong_lines("""my_rule
    at the traps' speed: lane = int(cars[EGO, LANE])
        teacher.toward(cars, 9.5 if lane == 0 else 9.0, max(lane - 1, 0), scenario)  # faster there than the traps
""")
