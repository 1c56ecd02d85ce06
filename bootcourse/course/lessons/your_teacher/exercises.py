"""Exercises of the lesson on a teacher of your own."""

import numpy as np

from bootcourse.course.exercise import exercise
from bootcourse.course.lessons.your_teacher import taught_agents
from bootcourse.course.lessons.your_teacher.driven_out import OUT, drive_out, explain_rule
from bootcourse.course.lessons.your_teacher.example_teachers import DENSE, careful, dense_road, watchful
from bootcourse.learn.teachers import toward
from bootcourse.road.state import EGO, LANE, SPEED, X, Y
from bootcourse.road.vector_env import TrapVectorEnv
from bootcourse.scenario import DEFAULT


def road_of(*cars):
    """A road, (vehicles, 10), the ego first; each car is given as (x in m, speed in m/s, lane)."""
    rows = np.zeros((len(cars), 10))
    for row, (x, speed, lane) in zip(rows, cars, strict=True):
        row[[X, Y, SPEED, LANE]] = x, 4.0 * lane, speed, lane
    return rows


def ahead_cases(rng):
    """No car ahead; one behind, nearer than the one ahead; two ahead, the farther first; then 40 at random."""
    yield road_of((50, 10, 2), (60, 9, 1)), 0
    yield road_of((50, 10, 2), (40, 9, 2), (80, 11, 2)), 2
    yield road_of((50, 10, 2), (90, 12, 1), (70, 9, 1)), 1
    yield road_of((50, 10, 2), (30, 12, 1)), 1
    for _ in range(40):
        cars = zip(rng.uniform(0, 150, 9), rng.uniform(8, 14, 9), rng.integers(0, 3, 9), strict=True)
        yield road_of(*cars), rng.integers(0, 3)


@exercise(
    "gap to the preceding vehicle, bumper to bumper, Section III-D", minutes=6, difficulty=1, cases=ahead_cases,
    worked=[
        ((road_of((50, 10, 2), (65, 10, 2), (56, 9, 1)), 2), 10.0),  # 15 m less a car's length
        ((road_of((50, 10, 2), (65, 10, 2), (56, 9, 1)), 1), 1.0),
        ((road_of((50, 10, 2), (65, 10, 2), (56, 9, 1)), 0), np.inf),
    ],
    hints=(
        "Pick the rows in two steps: those in the lane, then those with a larger x than the ego's.",
        "If no row is left, return `np.inf`. If some are, the nearest has the smallest x.",
    ),
    mistakes={
        "- 5 ->":
            "Your gap is 5 m too long: you measure from centre to centre. Subtract a car's length, 5 m.",
        ("cars[(cars[:, LANE] == lane) & (cars[:, X] > cars[EGO, X])] -> cars[1:][cars[1:, LANE] == lane]",
         "return others[np.abs(others[:, X] - cars[EGO, X]).argmin(), X] - cars[EGO, X] - 5"):
            "You take the nearest car, even where it is behind you. Ahead means a larger x than the ego's.",
        "(cars[:, LANE] == lane) & ->":
            "You look at every lane. Only the cars whose lane is `lane` count.",
        "others[:, X].min() -> others[0, X]":
            "You take the first car of the table. The rows are not sorted by position: find the smallest x.",
        "np.inf -> 200.0":
            "You return a finite number where no car is ahead. The gap of an empty lane is infinite: `np.inf`.",
    },
)  # fmt: skip
def gap_ahead(cars, lane):
    others = cars[(cars[:, LANE] == lane) & (cars[:, X] > cars[EGO, X])]
    if len(others) == 0:
        return np.inf
    return others[:, X].min() - cars[EGO, X] - 5


def start_of(seed):
    env = TrapVectorEnv(1, DEFAULT)
    env.reset(seed=int(seed))
    return env.cars[0].copy(), DEFAULT


HITS = "Your rule hits a car on every road. Look at the gap ahead before it accelerates or changes lane."

my_rule = exercise(
    "μ(s), a controller of your own in place of Algorithm 1", name="my_rule", minutes=12, difficulty=2,
    cases=lambda rng: map(start_of, range(1_300_002, 1_300_024)), run=drive_out, explain=explain_rule,
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
        "return 7":
            HITS,
        "return 5":
            "Your rule leaves the road every time. Every turn needs a turn back: `toward` does both.",
        "return 1":
            "Your rule brakes until the car stands on the road, which is an accident. Fall back at 6 m/s or more.",
        "return 9":
            "Your rule returns a number that is not an action: give a whole number from 0 to 8.",
        "return int(np.random.default_rng().integers(9))":
            "Your rule answers the same road differently each time. The label of a state must not change.",
    },
)(careful)  # fmt: skip


def dense_start(seed):
    return dense_road(seed), DENSE


def without_a_look(cars, scenario):
    lane = int(cars[EGO, LANE])
    return toward(cars, 12.0 if lane == 0 else 9.0, max(lane - 1, 0), scenario)


watchful_rule = exercise(
    "μ(s) where looking matters: safe gaps ahead and behind, as in MOBIL",
    name="watchful_rule", minutes=25, difficulty=3,
    cases=lambda rng: map(dense_start, range(1_300_002, 1_300_024)), run=drive_out, explain=explain_rule,
    seconds=10,  # it drives 24 roads
    worked=[(dense_start(1_300_000), OUT), (dense_start(1_300_001), OUT)],
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
            "Your rule escapes on some roads and hits a car on the others: there is room *ahead* in the left lane, and "
            "a faster car comes from behind. Look at the gap behind you, and at how fast it closes.",
        "return toward(cars, 9.0, 2, scenario)":
            "Your rule is safe and stays in its lane on every road: the queue has an end, and gaps before that.",
        "return 7":
            HITS,
    },
)(watchful)  # fmt: skip


def label_cases(rng):
    """No road ended, all ended, one road; then 30 at random."""
    for n, share in ((4, 0.0), (4, 1.0), (1, 1.0), *((n, 0.4) for n in rng.integers(2, 9, 30))):
        yield rng.integers(0, 9, n), rng.integers(0, 9, n), rng.random(n) < share


@exercise(
    "μ(s') in a row of the memory", minutes=4, difficulty=1, cases=label_cases,
    worked=[
        ((np.array([4, 4, 0]), np.array([7, 1, 8]), np.array([False, True, False])), np.array([4, 1, 0])),
        ((np.array([2]), np.array([5]), np.array([True])), np.array([5])),
    ],
    hints=(
        "An episode that ended has already been replaced by a new one when `now` is asked.",
        "Take `at_end` where `ended` is true, and `now` elsewhere.",
    ),
    mistakes={
        "return now":
            "Where an episode ended, `now` belongs to the first second of the *next* one: it is the label of another "
            "state.",
        "return at_end":
            "Where no episode ended, `at_end` belongs to another time: use it only where `ended` is true.",
        "at_end, now -> now, at_end":
            "Your two cases are swapped.",
        "at_end -> 0":
            "0 is an action, 'brake left'. An episode that ran out of time has a last state, which has a label.",
    },
)  # fmt: skip
def next_labels(now, at_end, ended):
    return np.where(ended, at_end, now)


def verdict_cases(rng):
    """All equal, ties, means and medians that disagree, an overlap; then 60 at random, of three seeds or more."""
    yield np.zeros(3), np.zeros(3)
    yield np.array([10.0, 20.0, 30.0]), np.array([30.0, 40.0, 50.0])
    yield np.array([30.0, 40.0, 50.0]), np.array([10.0, 20.0, 30.0])
    yield np.array([0.0, 10.0, 90.0]), np.array([20.0, 30.0, 40.0])
    yield np.array([0.0, 0.0, 90.0]), np.array([80.0, 100.0, 100.0])
    yield np.array([0.0, 10.0, 20.0]), np.array([5.0, 15.0, 25.0])
    for _ in range(60):
        n, shift = rng.integers(3, 6), rng.choice([-60, -20, 0, 20, 60])
        yield rng.uniform(0, 40, n).round(), rng.uniform(0, 40, n).round() + shift


A_TIE = (
    "You count a tie as a difference. Use `>`: where all scores are equal, the teacher neither helps nor hurts."
)  # fmt: skip


@exercise(
    "complete separation of two groups of seeds", minutes=5, difficulty=2, cases=verdict_cases,
    worked=[
        ((np.array([0.0, 0.0, 3.0]), np.array([80.0, 95.0, 100.0])), 1),
        ((np.array([20.0, 23.0, 23.0]), np.array([5.0, -9.0, 14.0])), -1),
        ((np.array([0.0, 0.0, 90.0]), np.array([80.0, 100.0, 100.0])), 0),
    ],
    hints=(
        "When is every taught agent better than every agent alone? Only the worst of one group and the best of the "
        "other decide.",
        "`taught.min() > alone.max()` gives 1. The opposite comparison gives -1; everything else is 0.",
    ),
    mistakes={
        "return int(np.sign(taught.mean() - alone.mean()))":
            "You compare means. One lucky seed can change a mean of three: check whether the two groups overlap.",
        "return int(np.sign(np.median(taught) - np.median(alone)))":
            "You compare medians. A median says nothing about whether the two groups overlap.",
        "return int(taught.min() >= alone.max()) - int(taught.max() <= alone.min())":
            A_TIE,
        ("> -> >=", "< -> <="):
            A_TIE,
        "-1 -> 0":
            "Your answer is never -1. Return -1 where every taught agent is worse than every agent alone.",
        "return int((taught > alone).all()) - int((taught < alone).all())":
            "You compare seed by seed. Agents with the same seed are not a pair: compare every taught agent with every "
            "agent alone.",
    },
)  # fmt: skip
def verdict(alone, taught):
    if taught.min() > alone.max():
        return 1
    if taught.max() < alone.min():
        return -1
    return 0


def p_values(rng):
    """One test, equal ones, some that fall below their predecessor when scaled, large ones; then 40 at random."""
    yield from ((np.array(p),) for p in ([0.03], [0.02, 0.02, 0.02], [0.04, 0.01, 0.021, 0.9], [0.9, 0.6, 0.7]))
    yield from ((rng.uniform(0, 1, rng.integers(2, 9)) ** 3,) for _ in range(40))


holm = exercise(
    "max over j ≤ k of (m - j + 1) p_(j), at most 1: Holm 1979", minutes=8, difficulty=2, cases=p_values,
    worked=[
        ((np.array([0.01, 0.04]),), np.array([0.02, 0.04])),  # 2 · 0.01; 1 · 0.04
        ((np.array([0.03, 0.5, 0.02]),), np.array([0.06, 0.5, 0.06])),  # 3 · 0.02 = 0.06; 2 · 0.03 = 0.06; 0.5
    ],
    hints=(
        "Sort the m p-values. Multiply the smallest by m, the next by m - 1, ..., the largest by 1.",
        "`np.argsort(p)` gives the order; `np.maximum.accumulate` makes each at least as large as the one before.",
    ),
    mistakes={
        "return np.minimum(p * m, 1)":
            "You multiply every p by the number of tests. That is Bonferroni's correction: it is right, too, but "
            "Holm's multiplies only the smallest by m, the next by m - 1, and finds more.",
        "return np.sort(adjusted)":
            "Your numbers are right, but sorted. Return them in the order of the tests.",
        "np.maximum.accumulate ->":
            "A larger p must not end below a smaller one: each adjusted p is at least as large as the one before it.",
        ("np.argsort(p) -> np.argsort(-p)", "np.maximum.accumulate ->"):
            "You multiply the *largest* p by m. Holm begins with the smallest.",
        "return p":
            "These are the p-values themselves. Of twenty, one on average is below 0.05 by luck.",
    },
)(taught_agents.holm)  # fmt: skip
