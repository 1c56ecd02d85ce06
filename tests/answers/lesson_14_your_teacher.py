"""Answers to the exercises of the lesson on a teacher of your own."""

import numpy as np

from bootcourse.learn import teachers as teacher
from bootcourse.lessons.example_teachers import watchful
from bootcourse.road.state import EGO, LANE, SPEED, X, Y
from tests.answers import right, wrong

# gap_ahead ----------------------------------------------------------------------------------------------


@right("gap_ahead")
def with_a_loop(cars, lane):
    gap = np.inf
    for car in cars[1:]:
        distance = car[X] - cars[EGO, X]
        if car[LANE] == lane and 0 < distance and distance - 5 < gap:
            gap = distance - 5
    return gap


@right("gap_ahead")
def with_min(cars, lane):
    gaps = [car[X] - cars[EGO, X] - 5 for car in cars if car[LANE] == lane and car[X] > cars[EGO, X]]
    return min(gaps, default=float("inf"))


@right("gap_ahead")
def the_library_s(cars, lane):
    return teacher.ahead(cars, lane)[0]


@wrong("gap_ahead", "behind you")
def the_nearest(cars, lane):
    gaps = [car[X] - cars[EGO, X] for car in cars[1:] if car[LANE] == lane]
    return min(gaps, key=abs) - 5 if gaps else np.inf


@wrong("gap_ahead", "every lane")
def in_any_lane(cars, lane):
    gaps = [x - cars[EGO, X] - 5 for x in cars[:, X] if x > cars[EGO, X]]
    return min(gaps, default=np.inf)


@wrong("gap_ahead", "first car of the table")
def the_first_row(cars, lane):
    for car in cars[1:]:
        if car[LANE] == lane and car[X] > cars[EGO, X]:
            return car[X] - cars[EGO, X] - 5
    return np.inf


@wrong("gap_ahead", "raises an error")
def without_the_empty_lane(cars, lane):
    others = cars[(cars[:, LANE] == lane) & (cars[:, X] > cars[EGO, X])]
    return others[:, X].min() - cars[EGO, X] - 5


@wrong("gap_ahead", "returns")
def with_the_speed(cars, lane):
    return teacher.ahead(cars, lane)


@wrong("gap_ahead")
def zero_for_nobody(cars, lane):
    gap = with_a_loop(cars, lane)
    return 0.0 if gap == np.inf else gap


# my_rule --------------------------------------------------------------------------------------------


@right("my_rule")
def the_course_s(cars, scenario):
    return teacher.course_rule(cars[None], scenario)[0]


@right("my_rule")
def slow_then_left(cars, scenario):
    """Falls back at 8 m/s, then one lane at a time, then 13 m/s with a distance of 20 m."""
    lane = int(cars[EGO, LANE])
    middle = abs(cars[EGO, Y] - 4 * lane) < 0.5
    if lane > 0:
        room = teacher.ahead(cars, lane - 1)[0] > 6
        return teacher.toward(cars, 8.0, lane - 1 if room and middle else lane)
    gap, speed = teacher.ahead(cars, 0)
    return teacher.toward(cars, 13.0 if gap > 20 else speed - 1, 0)


@wrong("my_rule", "whole number")
def a_float(cars, scenario):
    return float(the_course_s(cars, scenario))


@wrong("my_rule", "branch without `return`")
def nothing_in_the_free_lane(cars, scenario):
    if cars[EGO, LANE] > 0:
        return the_course_s(cars, scenario)


@wrong("my_rule", "collides")
def left_at_once(cars, scenario):
    return teacher.toward(cars, 10.0, max(int(cars[EGO, LANE]) - 1, 0), scenario)


@wrong("my_rule", "returns")
def speed_and_lane(cars, scenario):
    return 9.0, 1


@right("my_rule")
def late_and_slow(cars, scenario):
    """Waits until 12 m are free ahead on the left, and keeps 30 m distance there; whole numbers of NumPy's."""
    lane = int(cars[EGO, LANE])
    gap, speed = teacher.ahead(cars, lane, scenario)
    if lane == 0:
        return np.int64(teacher.toward(cars, 14.0 if gap > 30 else min(14.0, speed - 1), 0, scenario))
    free = teacher.ahead(cars, lane - 1, scenario)[0] > 12 and abs(cars[EGO, Y] - 4 * lane) < 0.5
    return np.int64(teacher.toward(cars, 8.0, lane - free, scenario))


@wrong("my_rule", "changes its argument")
def moves_the_traps(cars, scenario):
    cars[1:3, X] -= 50
    return 4


# next_labels ----------------------------------------------------------------------------------------


@right("next_labels")
def by_index(now, at_end, ended):
    labels = now.copy()
    labels[ended] = at_end[ended]
    return labels


@right("next_labels")
def one_by_one(now, at_end, ended):
    return np.array([b if over else a for a, b, over in zip(now, at_end, ended, strict=True)])


@wrong("next_labels", "changes its argument")
def in_place(now, at_end, ended):
    now[ended] = at_end[ended]
    return now


@wrong("next_labels", "shape")
def only_those_that_ended(now, at_end, ended):
    return at_end[ended]


@wrong("next_labels")
def the_larger(now, at_end, ended):
    return np.maximum(now, at_end * ended)


@right("next_labels")
def as_a_list(now, at_end, ended):
    return [int(at_end[i]) if ended[i] else int(now[i]) for i in range(len(ended))]


@wrong("next_labels")
def no_label_at_the_end(now, at_end, ended):
    return np.where(ended, -1, now)


@wrong("next_labels")
def of_the_road_before(now, at_end, ended):
    return np.where(np.roll(ended, 1), at_end, now)


@wrong("next_labels")
def all_if_any_ended(now, at_end, ended):
    return at_end if ended.any() else now


@wrong("next_labels")
def both_added(now, at_end, ended):
    return now + at_end * ended


# verdict --------------------------------------------------------------------------------------------


@right("verdict")
def every_one_with_every_one(alone, taught):
    better = taught[:, None] > alone
    worse = taught[:, None] < alone
    return int(better.all()) - int(worse.all())


@right("verdict")
def sorted_by_value(alone, taught):
    alone, taught = sorted(alone), sorted(taught)
    if taught[0] > alone[-1]:
        return 1
    return -1 if taught[-1] < alone[0] else 0


@wrong("verdict", "tie")
def ties_count(alone, taught):
    if all(t >= a for t in taught for a in alone) and all(t <= a for t in taught for a in alone):
        return 0
    return 1 if min(taught) >= max(alone) else (-1 if max(taught) <= min(alone) else 0)


@wrong("verdict")
def the_other_way_round(alone, taught):
    return -every_one_with_every_one(alone, taught)


@wrong("verdict")
def best_against_best(alone, taught):
    return int(np.sign(max(taught) - max(alone)))


@right("verdict")
def of_pairs(alone, taught):
    pairs = [(a, t) for a in alone for t in taught]
    return int(all(t > a for a, t in pairs)) - int(all(t < a for a, t in pairs))


@wrong("verdict")
def as_a_text(alone, taught):
    return {1: "helps", 0: "cannot be told", -1: "hurts"}[sorted_by_value(alone, taught)]


@wrong("verdict")
def most_of_the_pairs(alone, taught):
    better = (taught[:, None] > alone).mean()
    return 1 if better > 0.8 else -1 if better < 0.2 else 0


@wrong("verdict")
def by_ten_points(alone, taught):
    return int(taught.min() > alone.max() + 10) - int(taught.max() < alone.min() - 10)


# watchful_rule ------------------------------------------------------------------------------------------


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


@right("watchful_rule")
def the_library_s_with_other_names(cars, scenario):
    return watchful(cars, scenario)


@wrong("watchful_rule", "collides")
def looks_ahead_only(cars, scenario):
    lane = int(cars[EGO, LANE])
    if lane == 0:
        return teacher.toward(cars, 12.0, 0, scenario)
    free = teacher.ahead(cars, lane - 1, scenario)[0] > 8
    return teacher.toward(cars, 9.0, lane - 1 if free else lane, scenario)


@wrong("watchful_rule", "branch without `return`")
def nothing_in_the_middle_lane(cars, scenario):
    if cars[EGO, LANE] != 1:
        return teacher.toward(cars, 9.0, max(int(cars[EGO, LANE]) - 1, 0), scenario)


@wrong("watchful_rule", "stays in its lane")
def waits_for_ever(cars, scenario):
    return teacher.toward(cars, 8.0, 2, scenario)


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


@wrong("watchful_rule", "whole number")
def a_float_in_the_left_lane(cars, scenario):
    action = watchful(cars, scenario)
    return float(action) if cars[EGO, LANE] == 0 else action


@wrong("watchful_rule", "differently each time")
def changes_at_random(cars, scenario):
    return int(np.random.default_rng().integers(9))


# holm ---------------------------------------------------------------------------------------------------


@right("holm")
def step_by_step(p):
    found, before = [0.0] * len(p), 0.0
    for k, i in enumerate(sorted(range(len(p)), key=lambda i: p[i])):
        before = found[i] = max(before, min(1.0, (len(p) - k) * p[i]))
    return np.array(found)


@right("holm")
def by_definition(p):
    p = np.asarray(p)
    ranks = np.argsort(np.argsort(p, kind="stable"), kind="stable")
    scaled = np.minimum((len(p) - ranks) * p, 1)
    return np.array([scaled[ranks <= rank].max() for rank in ranks])


@wrong("holm")
def of_benjamini_and_hochberg(p):
    from scipy import stats

    return stats.false_discovery_control(np.asarray(p))


@wrong("holm")
def above_one(p):
    order = np.argsort(p)
    adjusted = np.empty(len(p))
    adjusted[order] = np.maximum.accumulate(np.asarray(p)[order] * (len(p) - np.arange(len(p))))
    return adjusted


@wrong("holm")
def one_test_too_many(p):
    order = np.argsort(p)
    adjusted = np.empty(len(p))
    scaled = np.asarray(p)[order] * (len(p) + 1 - np.arange(len(p)))
    adjusted[order] = np.minimum(np.maximum.accumulate(scaled), 1)
    return adjusted


@right("holm")
def with_a_table(p):
    p = np.asarray(p, dtype=float)
    order = np.lexsort((np.arange(len(p)), p))
    scaled = np.minimum(p[order] * np.arange(len(p), 0, -1), 1)
    larger = np.tril(np.ones((len(p), len(p)), dtype=bool))
    return np.where(larger, scaled, 0).max(axis=1)[np.argsort(order)]


@wrong("holm")
def of_sidak(p):
    return 1 - (1 - np.asarray(p)) ** len(p)


@wrong("holm")
def for_three_tests(p):
    order = np.argsort(p)
    adjusted = np.empty(len(p))
    adjusted[order] = np.minimum(np.maximum.accumulate(np.asarray(p)[order] * np.maximum(3 - np.arange(len(p)), 1)), 1)
    return adjusted


@wrong("holm")
def which_are_significant(p):
    return np.asarray(p) * len(p) < 0.05
