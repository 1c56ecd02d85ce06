"""Answers to the exercises of the lesson on a teacher of your own."""

import numpy as np

from bootcourse.learn import teachers as teacher
from bootcourse.road.state import EGO, LANE, SPEED, X, Y
from tests.answers import equivalent, right, right_lines, wrong, wrong_lines

asked = []  # of the rules with a memory


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


@wrong("my_rule", "on 1 it collides")
def at_a_place_of_its_own(cars, scenario):
    """Changes lane where it has come 60 m and 120 m far, whatever is beside it."""
    lane = int(cars[EGO, LANE])
    gap, speed = teacher.ahead(cars, lane, scenario)
    if lane == 0:
        return teacher.toward(cars, 15.0 if gap > 25 else min(15.0, speed - 0.5), 0, scenario)
    beside = teacher.ahead(cars, lane - 1, scenario)[1]
    goes = abs(cars[EGO, Y] - 4 * lane) < 0.5 and cars[EGO, X] > 60 * (3 - lane)
    return teacher.toward(cars, min(speed, beside, 14.0) - 1.5, lane - goes, scenario)


@right("my_rule")
def late_and_slow(cars, scenario):
    """Waits until 12 m are free ahead on the left, and keeps 30 m distance there; whole numbers of NumPy's."""
    lane = int(cars[EGO, LANE])
    gap, speed = teacher.ahead(cars, lane, scenario)
    if lane == 0:
        return np.int64(teacher.toward(cars, 14.0 if gap > 30 else min(14.0, speed - 1), 0, scenario))
    free = teacher.ahead(cars, lane - 1, scenario)[0] > 12 and abs(cars[EGO, Y] - 4 * lane) < 0.5
    return np.int64(teacher.toward(cars, 8.0, lane - free, scenario))


wrong_lines("""my_rule
    with a memory: asked.append(1)
        teacher.toward(cars, 9.0, 2, scenario) if len(asked) < 40 else the_course_s(cars, scenario)  # or remembers
""")

right_lines("""my_rule
    an array without axes: np.where(True, the_course_s(cars, scenario), 4)
""")


def queue(cars):
    """How far ahead of the ego the cars of the next lane on the left are."""
    return cars[cars[:, LANE] == int(cars[EGO, LANE]) - 1][:, X] - cars[EGO, X]


def going_left(cars, scenario, room, speed=15.0, look=40.0, slow=9.0):
    """Falls back, and changes to the left where there is `room`; in the free lane at most at `speed`."""
    lane = int(cars[EGO, LANE])
    gap, front = teacher.ahead(cars, lane, scenario)
    if lane == 0:
        return teacher.toward(cars, speed if gap > look else min(speed, front - 0.5), 0, scenario)
    late = cars[EGO, Y] - 4 * lane > 0.5  # still on the way into this lane
    wait = slow if lane == 2 else min(front - 0.5, 14.0) if gap > 12 else front - 1  # behind trap 2
    return teacher.toward(cars, wait, lane - 1 if room and not late else lane, scenario)


@right("watchful_rule")
def patient(cars, scenario):
    """Waits until the lane on the left is empty for 14 m on both sides."""
    return going_left(cars, scenario, not (np.abs(queue(cars)) < 14).any())


@right("watchful_rule")
def in_seconds(cars, scenario):
    """Asks whether it touches a car of that lane within 3 s, if both keep their speeds; whole numbers of NumPy's."""
    left = cars[cars[:, LANE] == int(cars[EGO, LANE]) - 1]
    apart, closing = left[:, X] - cars[EGO, X], left[:, SPEED] - cars[EGO, SPEED]
    later = apart + 3 * closing
    room = ((apart * later > 0) & (np.minimum(np.abs(apart), np.abs(later)) > 8)).all()
    return np.array(going_left(cars, scenario, room))


for _x in (250, 600, 950):

    @wrong("watchful_rule", "Your rule")
    def left_at_an_x_of_its_own(cars, scenario, x=_x):
        lane = int(cars[EGO, LANE])
        if lane == 0:
            return going_left(cars, scenario, False)
        return teacher.toward(cars, 9.0, lane - 1 if cars[EGO, X] > x else lane, scenario)


wrong_lines("""watchful_rule
    looks ahead only: lane = int(cars[EGO, LANE])
        if lane == 0:
            return teacher.toward(cars, 12.0, 0, scenario)
        free = teacher.ahead(cars, lane - 1, scenario)[0] > 8
        teacher.toward(cars, 9.0, lane - 1 if free else lane, scenario)  # collides
    looks beside only: going_left(cars, scenario, not (np.abs(queue(cars)) < 6).any())  # collides
    too fast in the free lane: going_left(cars, scenario, not (np.abs(queue(cars)) < 14).any(), speed=20.0)
    too near in the free lane: going_left(cars, scenario, not (np.abs(queue(cars)) < 14).any(), look=8.0)  # collides
    waits for the end of the queue: going_left(cars, scenario, not (queue(cars) < 0).any())  # gets out on 18 of 40
    with a memory: asked.append(1)
        going_left(cars, scenario, len(asked) % 150 > 60 and not (np.abs(queue(cars)) < 14).any())  # or remembers
""")


right_lines("""without_the_accident
    by place: np.arange(len(lanes)) < len(lanes) - (0 in lanes)
    a list: [True] * (len(lanes) - 1) + [bool((lanes > 0).all())]
""")

wrong_lines("""without_the_accident
    all: np.ones(len(lanes), dtype=bool)
    cut: np.cumsum(lanes == 0) == 0
    shorter: lanes[:-1] >= 0
""")

equivalent(
    "without_the_accident",
    "kept = np.ones(len(lanes), dtype=bool)  ->  kept = np.ones(len(lanes))",
    "Ones and zeros for bool: `crashes.marked` takes them, too.",
)
