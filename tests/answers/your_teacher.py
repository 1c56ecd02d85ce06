"""Answers to the exercises of the lesson on a teacher of your own."""

import numpy as np

from bootcourse.learn import teachers as teacher
from bootcourse.road.state import EGO, LANE, SPEED, X, Y
from tests.answers import right, right_lines, wrong, wrong_lines


@right("gap_ahead")
def with_a_loop(cars, lane):
    gap = np.inf
    for car in cars[1:]:
        distance = car[X] - cars[EGO, X]
        if car[LANE] == lane and 0 < distance and distance - 5 < gap:
            gap = distance - 5
    return gap


right_lines("""gap_ahead
    with min: gaps = [car[X] - cars[EGO, X] - 5 for car in cars if car[LANE] == lane and car[X] > cars[EGO, X]]
        min(gaps, default=float("inf"))
    the library's: teacher.ahead(cars, lane)[0]
""")

wrong_lines("""gap_ahead
    the nearest: gaps = [car[X] - cars[EGO, X] for car in cars[1:] if car[LANE] == lane]
        min(gaps, key=abs) - 5 if gaps else np.inf  # behind you
    in any lane: gaps = [x - cars[EGO, X] - 5 for x in cars[:, X] if x > cars[EGO, X]]
        min(gaps, default=np.inf)  # every lane
    without the empty lane: others = cars[(cars[:, LANE] == lane) & (cars[:, X] > cars[EGO, X])]
        others[:, X].min() - cars[EGO, X] - 5  # raises an error
    with the speed: teacher.ahead(cars, lane)  # returns
    zero where no car is ahead: gap = with_a_loop(cars, lane); 0.0 if gap == np.inf else gap
    the first row:
        for car in cars[1:]:
            if car[LANE] == lane and car[X] > cars[EGO, X]:
                return car[X] - cars[EGO, X] - 5
        np.inf  # first car of the table
""")


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


right_lines("""next_labels
    by index: labels = now.copy(); labels[ended] = at_end[ended]; labels
    one by one: np.array([b if over else a for a, b, over in zip(now, at_end, ended, strict=True)])
    as a list: [int(at_end[i]) if ended[i] else int(now[i]) for i in range(len(ended))]
""")

wrong_lines("""next_labels
    in place: now[ended] = at_end[ended]; now  # changes its argument
    only those that ended: at_end[ended]  # shape
    the larger: np.maximum(now, at_end * ended)
    no label at the end: np.where(ended, -1, now)
    of the road before: np.where(np.roll(ended, 1), at_end, now)
    all if any ended: at_end if ended.any() else now
    both added: now + at_end * ended
""")

right_lines("""verdict
    every one with every one: better = taught[:, None] > alone
        worse = taught[:, None] < alone
        int(better.all()) - int(worse.all())
    of pairs: pairs = [(a, t) for a in alone for t in taught]
        int(all(t > a for a, t in pairs)) - int(all(t < a for a, t in pairs))
""")


@right("verdict")
def sorted_by_value(alone, taught):
    alone, taught = sorted(alone), sorted(taught)
    if taught[0] > alone[-1]:
        return 1
    return -1 if taught[-1] < alone[0] else 0


wrong_lines("""verdict
    the other way round: -solution(alone, taught)
    best against best: int(np.sign(max(taught) - max(alone)))
    as a text: {1: "helps", 0: "cannot be told", -1: "hurts"}[sorted_by_value(alone, taught)]
    most of the pairs: better = (taught[:, None] > alone).mean(); 1 if better > 0.8 else -1 if better < 0.2 else 0
    by ten points: int(taught.min() > alone.max() + 10) - int(taught.max() < alone.min() - 10)
    ties count:
        if all(t >= a for t in taught for a in alone) and all(t <= a for t in taught for a in alone):
            return 0
        1 if min(taught) >= max(alone) else (-1 if max(taught) <= min(alone) else 0)  # tie
""")


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


right_lines("""holm
    by definition: p = np.asarray(p)
        ranks = np.argsort(np.argsort(p, kind="stable"), kind="stable")
        scaled = np.minimum((len(p) - ranks) * p, 1)
        np.array([scaled[ranks <= rank].max() for rank in ranks])
    step by step: found, before = [0.0] * len(p), 0.0
        for k, i in enumerate(sorted(range(len(p)), key=lambda i: p[i])):
            before = found[i] = max(before, min(1.0, (len(p) - k) * p[i]))
        np.array(found)
""")


@wrong("holm")
def of_benjamini_and_hochberg(p):
    from scipy import stats

    return stats.false_discovery_control(np.asarray(p))


wrong_lines("""holm
    above one: order = np.argsort(p)
        adjusted = np.empty(len(p))
        adjusted[order] = np.maximum.accumulate(np.asarray(p)[order] * (len(p) - np.arange(len(p))))
        adjusted
    one test too many: order = np.argsort(p)
        adjusted = np.empty(len(p))
        scaled = np.asarray(p)[order] * (len(p) + 1 - np.arange(len(p)))
        adjusted[order] = np.minimum(np.maximum.accumulate(scaled), 1)
        adjusted
    of sidak: 1 - (1 - np.asarray(p)) ** len(p)
    which are significant: np.asarray(p) * len(p) < 0.05
""")


@wrong("holm")
def for_three_tests(p):
    order = np.argsort(p)
    adjusted = np.empty(len(p))
    adjusted[order] = np.minimum(np.maximum.accumulate(np.asarray(p)[order] * np.maximum(3 - np.arange(len(p)), 1)), 1)
    return adjusted
