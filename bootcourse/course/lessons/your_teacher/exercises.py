"""Exercises of the lesson on a teacher of your own."""

import numpy as np

from bootcourse.course.exercise import MANY_ROWS, exercise
from bootcourse.course.lessons.your_teacher import crashes
from bootcourse.course.lessons.your_teacher.driven_out import CHANGES, OUT, drive_out, explain_rule
from bootcourse.course.lessons.your_teacher.example_teachers import DENSE, careful, dense_road, watchful
from bootcourse.learn.teachers import toward
from bootcourse.road.state import EGO, LANE
from bootcourse.road.vector_env import TrapVectorEnv
from bootcourse.scenario import DEFAULT


def start_of(seed):
    env = TrapVectorEnv(1, DEFAULT)
    env.reset(seed=int(seed))
    return env.cars[0].copy(), DEFAULT


HITS = "Your rule hits a car on every road. Look at the gap ahead before it accelerates or changes lane."


def slow_in_the_free_lane(cars, scenario):
    return toward(cars, 9.0, max(int(cars[EGO, LANE]) - 1, 0), scenario)


# Of the first 500 roads those that separate. On 141 a rule that drives up to 18 m/s in the free lane has its one
# accident of 500, on 157 one that changes lane at some x of its own, whatever is beside it. On the others rules fail
# that drive up to 20 m/s there (11 % of 500), or that see 22 m (5 %). `careful` and the course's rule get out on all.
NUMBERS = (4, 18, 27, 31, 51, 61, 62, 65, 72, 126, 133, 141, 151, 157, 161, 178, 198, 201, 233, 283, 310, 374)
my_rule = exercise(
    "μ(s), a controller of your own in place of Algorithm 1", name="my_rule", minutes=12, difficulty=2,
    cases=lambda rng: (start_of(1_300_000 + number) for number in NUMBERS), run=drive_out, explain=explain_rule,
    seconds=10,  # it drives 24 roads
    worked=[(start_of(1_300_000), OUT), (start_of(1_300_001), OUT)],
    hints=(
        "Three situations: no room on the left yet (be slower than both traps); room (change lane); free lane (go).",
        "`ahead(cars, lane - 1, scenario)` says if there is room, `toward(cars, speed, lane, scenario)` goes there. "
        "Begin a change only when the car is in the middle of its lane: `abs(cars[EGO, Y] - 4 * lane) < 0.5`.",
    ),
    mistakes={
        "return 4":
            "Your rule drives safely but does not get out: on every road it is still behind trap 1 at the end. Fall "
            "back first: trap 2 has to be ahead of you before there is room on the left. Finish a lane change that has "
            "begun.",
        slow_in_the_free_lane:
            "Your rule comes to the left lane on every road, and is still behind trap 1 at the end: it has to drive "
            "faster there than the traps.",
        "return 7":
            HITS,
        "return 5":
            "Your rule leaves the road every time. Every turn needs a turn back: `toward` does both.",
        "return 1":
            "Your rule brakes until the car stands on the road, which is an accident. Fall back at 6 m/s or more.",
        "return 9":
            "Your rule returns a number that is not an action: give a whole number from 0 to 8.",
        "return int(np.random.default_rng().integers(9))":
            CHANGES,
    },
)(careful)  # fmt: skip


def lanes_of_drives(rng):
    for lanes in ([2, 2, 1, 0, 0, 1], [1, 0, 1, 2], [0], [2], [1, 1, 0], [2, 2, 2, 2], [0, 1, 1]):
        yield (np.array(lanes),)
    for length in (5, 16, 30, MANY_ROWS):
        yield (rng.integers(0, 3, length),)
        yield (rng.integers(1, 3, length),)


without_the_accident = exercise(
    "the decisions of a drive that crashes, without the accident in the free lane", minutes=5, difficulty=1,
    cases=lanes_of_drives,
    worked=[
        ((np.array([2, 1, 0, 0]),), np.array([True, True, True, False])),
        ((np.array([2, 1, 1]),), np.array([True, True, True])),
    ],
    hints=("Begin with `np.ones(len(lanes), dtype=bool)`. When is its last entry `False`?",),
    mistakes={
        "if (lanes == 0).any(): -> if lanes[-1] == 0:":
            "Some drives leave lane 0 again before they crash: ask whether lane 0 is anywhere in `lanes`.",
        "if (lanes == 0).any(): -> if True:":
            "Yours leaves out the last decision of each drive. Change one thing: keep all of a drive that does not "
            "reach lane 0.",
        "kept[-1] = False -> kept[lanes == 0] = False":
            "Yours leaves out the free lane. Keep it, and leave out the drive's last decision alone.",
        "return ~kept":
            "Yours is the other way round: `True` marks what the agents learn from.",
    },
)(crashes.without_the_accident)  # fmt: skip


# Of the first 300 roads those that separate: a rule that leaves at some x of its own, whatever is beside it, fails on 5
# to 31 of them, and so do rules that look a little too short, or drive a little too fast in the free lane, which have
# an accident on 1 to 8 % of all such roads. `watchful` gets out on all 300.
SEPARATE = (10, 12, 13, 44, 45, 48, 50, 53, 54, 59, 91, 92, 98, 105, 109, 111, 112, 118, 120, 133, 162, 168, 175, 177,
            190, 198, 200, 202, 212, 213, 217, 229, 232, 235, 238, 246, 261, 277, 280, 298)  # fmt: skip


def dense_start(number):
    return dense_road(1_310_000 + number), DENSE


def without_a_look(cars, scenario):
    lane = int(cars[EGO, LANE])
    return toward(cars, 12.0 if lane == 0 else 9.0, max(lane - 1, 0), scenario)


watchful_rule = exercise(
    "μ(s) where looking matters: safe gaps ahead and behind, as in MOBIL",
    name="watchful_rule", minutes=25, difficulty=3,
    cases=lambda rng: map(dense_start, SEPARATE[2:]), run=drive_out, explain=explain_rule,
    seconds=15,  # it drives 40 roads
    worked=[(dense_start(number), OUT) for number in SEPARATE[:2]],
    hints=(
        "Room on the left means two gaps: to the next car ahead in that lane, and to the next one behind, one of "
        "`cars[(cars[:, LANE] == lane - 1) & (cars[:, X] <= cars[EGO, X])]`. A faster follower needs a longer gap. "
        "Wait in the middle lane, slower than trap 2.",
        "A change takes about 3 s: ask for 4 m + 3 s × (its speed − yours) behind, and for 4 m + 2 s × (your "
        "speed − its speed) ahead. A change that has begun must not be taken back at the next second.",
    ),
    mistakes={
        without_a_look:
            "Your rule hits a car on nearly every road: it changes lane without a look. Ask which cars are beside you "
            "and behind you in the lane on the left.",
        careful:
            "Your rule escapes on some roads and hits a car on others: there is room *ahead* in the left lane, and "
            "a faster car comes from behind. Look at the gap behind you, and at how fast it closes.",
        "return toward(cars, 9.0, 2, scenario)":
            "Your rule is safe and stays in its lane on every road: the queue has gaps, and an end.",
        "return 7":
            HITS,
    },
)(watchful)  # fmt: skip
