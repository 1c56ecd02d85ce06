"""Exercises of the lesson on a teacher of your own."""

import numpy as np

from bootcourse.course.exercise import Exercise, Mistake
from bootcourse.course.lessons.your_teacher import taught_agents
from bootcourse.course.lessons.your_teacher.driven_out import OUT, drive_out, explain_rule
from bootcourse.course.lessons.your_teacher.example_teachers import DENSE, careful, dense_road, watchful
from bootcourse.learn import teachers as teacher
from bootcourse.road.state import EGO, LANE, SPEED, X, Y
from bootcourse.road.vector_env import TrapVectorEnv
from bootcourse.scenario import DEFAULT, N_ACTIONS


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


def gap_ahead_solution(cars, lane):
    others = cars[(cars[:, LANE] == lane) & (cars[:, X] > cars[EGO, X])]
    if len(others) == 0:
        return np.inf
    return others[:, X].min() - cars[EGO, X] - 5


def gap_to(cars, others):
    return others[:, X].min() - cars[EGO, X] - 5 if len(others) else np.inf


def of_the_nearest(cars, lane):
    others = cars[1:][cars[1:, LANE] == lane]
    return others[np.abs(others[:, X] - cars[EGO, X]).argmin(), X] - cars[EGO, X] - 5 if len(others) else np.inf


gap_ahead = Exercise(
    "gap_ahead(cars, lane)", solution=gap_ahead_solution, cases=ahead_cases,
    worked=(
        ((road_of((50, 10, 2), (65, 10, 2), (56, 9, 1)), 2), 10.0),  # 15 m less a car's length
        ((road_of((50, 10, 2), (65, 10, 2), (56, 9, 1)), 1), 1.0),
        ((road_of((50, 10, 2), (65, 10, 2), (56, 9, 1)), 0), np.inf),
    ),
    mistakes=(
        Mistake(lambda cars, lane: gap_ahead_solution(cars, lane) + 5,
            "Your gap is 5 m too long: you measure from centre to centre. Subtract a car's length, 5 m.",
            "A car is a point at its x."),
        Mistake(of_the_nearest,
            "You take the nearest car, even where it is behind you. Ahead means a larger x than the ego's.",
            "The nearest car is the one that matters."),
        Mistake(lambda cars, lane: gap_to(cars, cars[cars[:, X] > cars[EGO, X]]),
            "You look at every lane. Only the cars whose lane is `lane` count.",
            "Every car ahead is in the way."),
        Mistake(lambda cars, lane: gap_to(cars, cars[(cars[:, LANE] == lane) & (cars[:, X] > cars[EGO, X])][:1]),
            "You take the first car of the table. The rows are not sorted by position: find the smallest x.",
            "Row 1 is the car ahead, as at the start."),
        Mistake(lambda cars, lane: min(gap_ahead_solution(cars, lane), 200.0),
            "You return a finite number where no car is ahead. The gap of an empty lane is infinite: `np.inf`.",
            "Nothing is seen beyond 200 m, so 200 m is the largest gap."),
    ),
    hints=(
        "Pick the rows in two steps: those in the lane, then those with a larger x than the ego's.",
        "If no row is left, return `np.inf`. If some are, the nearest has the smallest x.",
        "`others = cars[(cars[:, LANE] == lane) & (cars[:, X] > cars[EGO, X])]`",
    ),
    minutes=6, difficulty=1, equation="gap to the preceding vehicle, bumper to bumper, Section III-D",
)  # fmt: skip


def start_of(seed):
    env = TrapVectorEnv(1, DEFAULT)
    env.reset(seed=int(seed))
    return env.cars[0].copy(), DEFAULT


def always(action):
    return lambda cars, scenario: action


my_rule = Exercise(
    "my_rule(cars, scenario)",
    solution=careful, cases=lambda rng: [start_of(seed) for seed in range(1_300_002, 1_300_024)], run=drive_out,
    explain=explain_rule,
    seconds=90,  # it drives 24 roads; the first drive on a new machine compiles the road
    worked=((start_of(1_300_000), OUT), (start_of(1_300_001), OUT)),
    mistakes=(
        Mistake(always(4),
            "Your rule drives safely but does not get out: on every road it is still behind trap 1 at the end. Fall "
            "back first: trap 2 has to be ahead of you before there is room on the left. Finish a lane change that has "
            "begun.",
            "A gap will open if the ego waits long enough."),
        Mistake(always(7),
            "Your rule hits a car on every road. Look at the gap ahead before it accelerates or changes lane.",
            "The way out is forwards."),
        Mistake(always(5),
            "Your rule leaves the road every time. Every turn needs a turn back: `toward` does both.",
            "Steering is held until the lane is reached, and the car then drives straight."),
        Mistake(always(1),
            "Your rule brakes until the car stands on the road, which is an accident. Fall back at 6 m/s or more.",
            "The more room, the better."),
        Mistake(always(9),
            "Your rule returns a number that is not an action: give a whole number from 0 to 8.",
            "Nine actions are numbered 1 to 9."),
        Mistake(lambda cars, scenario: int(np.random.default_rng().integers(N_ACTIONS)),
            "Your rule answers the same road differently each time. The label of a state must not change.",
            "A stochastic teacher draws its actions. (The probability p is added later, in π̃.)"),
    ),
    hints=(
        "Three situations: no room on the left yet (be slower than both traps); room (change lane); free lane (go).",
        "`ahead(cars, lane - 1, scenario)` says if there is room, `toward(cars, speed, lane, scenario)` goes there.",
        "Begin a change only when the car is in the middle of its lane: `abs(cars[EGO, Y] - 4 * lane) < 0.5`.",
    ),
    minutes=12, difficulty=2, equation="μ(s), a controller of your own in place of Algorithm 1",
)  # fmt: skip


def without_a_look(cars, scenario):
    lane = int(cars[EGO, LANE])
    return teacher.toward(cars, 12.0 if lane == 0 else 9.0, max(lane - 1, 0), scenario)


def dense_start(seed):
    return dense_road(seed), DENSE


watchful_rule = Exercise(
    "watchful_rule(cars, scenario)",
    solution=watchful, cases=lambda rng: [dense_start(seed) for seed in range(1_300_002, 1_300_024)], run=drive_out,
    explain=explain_rule,
    seconds=90,  # it drives 24 roads
    worked=((dense_start(1_300_000), OUT), (dense_start(1_300_001), OUT)),
    mistakes=(
        Mistake(without_a_look,
            "Your rule hits a car on nearly every road: it changes lane without a look. Ask which cars are beside you "
            "and behind you in the lane on the left.",
            "Falling back makes the room that a lane change needs."),
        Mistake(careful,
            "Your rule escapes on some roads and hits a car on the others: there is room *ahead* in the left lane, and "
            "a faster car comes from behind. Look at the gap behind you, and at how fast it closes.",
            "A lane is free if the next car ahead in it is far away."),
        Mistake(lambda cars, scenario: teacher.toward(cars, 9.0, 2, scenario),
            "Your rule is safe and stays in its lane on every road: the queue has an end, and gaps before that.",
            "If the left lane is full, wait."),
        Mistake(always(7),
            "Your rule hits a car on every road. Look at the gap ahead before it accelerates or changes lane.",
            "The way out is forwards."),
    ),
    hints=(
        "Room on the left means two gaps: to the next car ahead in that lane, and to the next one behind. A faster "
        "follower needs a longer gap.",
        "`cars[(cars[:, LANE] == lane - 1) & (cars[:, X] <= cars[EGO, X])]` are the cars beside and behind. Wait "
        "in the "
        "middle lane, slower than trap 2.",
        "A change takes about 3 s: ask for 4 m + 3 s × (its speed − yours) behind, and for 4 m + 2 s × (your "
        "speed − its speed) ahead. A change that has begun must not be taken back at the next second.",
    ),
    minutes=25, difficulty=3, equation="μ(s) where looking matters: safe gaps ahead and behind, as in MOBIL",
)  # fmt: skip


def next_labels_solution(now, at_end, ended):
    return np.where(ended, at_end, now)


def label_cases(rng):
    """No road ended, all ended, one road; then 30 at random."""
    for n, share in ((4, 0.0), (4, 1.0), (1, 1.0), *((n, 0.4) for n in rng.integers(2, 9, 30))):
        yield rng.integers(0, 9, n), rng.integers(0, 9, n), rng.random(n) < share


next_labels = Exercise(
    "next_labels(now, at_end, ended)", solution=next_labels_solution, cases=label_cases,
    worked=(
        ((np.array([4, 4, 0]), np.array([7, 1, 8]), np.array([False, True, False])), np.array([4, 1, 0])),
        ((np.array([2]), np.array([5]), np.array([True])), np.array([5])),
    ),
    mistakes=(
        Mistake(lambda now, at_end, ended: now,
            "Where an episode ended, `now` belongs to the first second of the *next* one: it is the label of another "
            "state.",
            "After a step, the road shows s'. (With autoreset it may show a new road.)"),
        Mistake(lambda now, at_end, ended: at_end,
            "Where no episode ended, `at_end` belongs to another time: use it only where `ended` is true.",
            "All episodes end together."),
        Mistake(lambda now, at_end, ended: np.where(ended, now, at_end),
            "Your two cases are swapped.",
            "The arguments of np.where are the condition, the value for False, the value for True."),
        Mistake(lambda now, at_end, ended: np.where(ended, 0, now),
            "0 is an action, 'brake left'. An episode that ran out of time has a last state, which has a label.",
            "Nothing comes after the end, so its label does not matter. (Out of time is not terminated.)"),
    ),
    hints=(
        "An episode that ended has already been replaced by a new one when `now` is asked.",
        "Take `at_end` where `ended` is true, and `now` elsewhere.",
        "`np.where(ended, ..., ...)`",
    ),
    minutes=4, difficulty=1, equation="μ(s') in a row of the memory",
)  # fmt: skip


def verdict_solution(alone, taught):
    if taught.min() > alone.max():
        return 1
    if taught.max() < alone.min():
        return -1
    return 0


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


def by_middle(middle):
    return lambda alone, taught: int(np.sign(middle(taught) - middle(alone)))


verdict = Exercise(
    "verdict(alone, taught)", solution=verdict_solution, cases=verdict_cases,
    worked=(
        ((np.array([0.0, 0.0, 3.0]), np.array([80.0, 95.0, 100.0])), 1),
        ((np.array([20.0, 23.0, 23.0]), np.array([5.0, -9.0, 14.0])), -1),
        ((np.array([0.0, 0.0, 90.0]), np.array([80.0, 100.0, 100.0])), 0),
    ),
    mistakes=(
        Mistake(by_middle(np.mean),
            "You compare means. One lucky seed can change a mean of three: check whether the two groups overlap.",
            "The larger mean is the better method."),
        Mistake(by_middle(np.median),
            "You compare medians. A median says nothing about whether the two groups overlap.",
            "A robust average makes the comparison reliable."),
        Mistake(lambda alone, taught: int(taught.min() >= alone.max()) - int(taught.max() <= alone.min()),
            "You count a tie as a difference. Use `>`: where all scores are equal, the teacher neither helps nor "
            "hurts.",
            "At least as good means better."),
        Mistake(lambda alone, taught: int(taught.min() > alone.max()),
            "Your answer is never -1. Return -1 where every taught agent is worse than every agent alone.",
            "A teacher can only help."),
        Mistake(lambda alone, taught: int((taught > alone).all()) - int((taught < alone).all()),
            "You compare seed by seed. Agents with the same seed are not a pair: compare every taught agent with every "
            "agent alone.",
            "Seed 0 with a teacher is the same agent as seed 0 without."),
    ),
    hints=(
        "When is every taught agent better than every agent alone? Only the worst of one group and the best of the "
        "other decide.",
        "`taught.min() > alone.max()`",
        "The opposite comparison gives -1; everything else is 0.",
    ),
    minutes=5, difficulty=2, equation="complete separation of two groups of seeds",
)  # fmt: skip


def scaled(p, order):
    """Each p times m, m - 1, ... in this order, whatever the others become."""
    return np.minimum(p * (len(p) - np.argsort(np.argsort(order))), 1)


holm = Exercise(
    "holm(p)", solution=taught_agents.holm,
    # one test, equal ones, some that fall below their predecessor when scaled, large ones; then 40 at random
    cases=lambda rng: [(np.array([0.03]),), (np.array([0.02, 0.02, 0.02]),), (np.array([0.04, 0.01, 0.021, 0.9]),),
                       (np.array([0.9, 0.6, 0.7]),),
                       *((rng.uniform(0, 1, rng.integers(2, 9)) ** 3,) for _ in range(40))],
    worked=(
        ((np.array([0.01, 0.04]),), np.array([0.02, 0.04])),  # 2 · 0.01; 1 · 0.04
        ((np.array([0.03, 0.5, 0.02]),), np.array([0.06, 0.5, 0.06])),  # 3 · 0.02 = 0.06; 2 · 0.03 = 0.06; 0.5
    ),
    mistakes=(
        Mistake(lambda p: np.minimum(p * len(p), 1),
            "You multiply every p by the number of tests. That is Bonferroni's correction: it is right, too, but "
            "Holm's multiplies only the smallest by m, the next by m - 1, and finds more.",
            "All p-values are corrected alike."),
        Mistake(lambda p: np.sort(taught_agents.holm(p)),
            "Your numbers are right, but sorted. Return them in the order of the tests.",
            "The order of the answer does not matter."),
        Mistake(lambda p: scaled(p, p),
            "A larger p must not end below a smaller one: each adjusted p is at least as large as the one before it.",
            "Each p is corrected for itself."),
        Mistake(lambda p: scaled(p, -p),
            "You multiply the *largest* p by m. Holm begins with the smallest.",
            "The weakest result needs the strongest correction."),
        Mistake(lambda p: p,
            "These are the p-values themselves. Of twenty, one on average is below 0.05 by luck.",
            "A p-value knows how many tests were made."),
    ),
    hints=(
        "Sort the m p-values. Multiply the smallest by m, the next by m - 1, ..., the largest by 1.",
        "`np.argsort(p)` gives the order; `np.maximum.accumulate` makes each at least as large as the one before.",
        "`adjusted[order] = np.minimum(np.maximum.accumulate(p[order] * (m - np.arange(m))), 1)`",
    ),
    minutes=8, difficulty=2, equation="max over j ≤ k of (m - j + 1) p_(j), at most 1: Holm 1979",
)  # fmt: skip
