"""Exercises of the lesson on the rule controller."""

import numpy as np

from bootcourse.course.exercise import exercise

INF = float("inf")


def speed_cases(rng):
    """Traps on the grid, next to it, at its ends and off it, a free road, one lane free, all too slow; 60 at random."""
    for v_current, v_new in ((10.0, 10.0), (8.25, 8.25), (8.25, 20.0), (20.0, 8.25), (6.0, 6.0), (15.0, 15.0),
                             (INF, INF), (10.0, INF), (INF, 10.0), (5.0, 20.0)):  # fmt: skip
        yield v_current, v_new, 6.0, 15.0, 5
    yield 16.0, 14.9, 6.0, 15.0, 2
    for v in (6.0, 8.25, 15.0):  # just above and just below a speed of the grid
        yield from ((v + near, 20.0, 6.0, 15.0, 5) for near in (0.001, -0.001, 1e-6, -1e-6))
    for _ in range(60):
        low = rng.uniform(3, 8)
        yield *rng.uniform(4, 18, 2), low, low + rng.uniform(3, 10), rng.integers(2, 9)


@exercise(
    "v_target = max {v_i : v_i < min(v_current, v_new)}, Section III-D", minutes=6, difficulty=1, cases=speed_cases,
    worked=[
        ((10.0, 10.0, 6.0, 15.0, 5), 8.25),  # of 6, 8.25, 10.5, 12.75, 15
        ((8.25, 12.0, 6.0, 15.0, 5), 6.0),  # *slower* than 8.25
        ((INF, INF, 6.0, 15.0, 5), 15.0),
    ],
    hints=(
        "Make the n speeds, keep those below the slower car, take the largest. What if none is left?",
        "`np.linspace(v_min, v_max, n)` are the speeds; `min(v_current, v_new)` is the limit.",
    ),
    mistakes={
        "v < -> v <=":
            "You allow the speed of the car ahead itself. Your speed has to be *slower*: otherwise the gap does not "
            "grow.",
        "min(v_current, v_new) -> v_current":
            "You look at the car in your own lane only. While you change, the new car ahead limits you, too.",
        "min(v_current, v_new) -> v_new":
            "You look at the car in the new lane only. Until you are there, the car ahead of you limits you, too.",
        "min(v_current, v_new) -> max(v_current, v_new)":
            "You compare with the faster of the two cars: slower than *both* means slower than the minimum.",
        "return min(max(min(v_current, v_new), v_min), v_max)":
            "You return the slower car's own speed. The rule takes one of its n speeds: the fastest one below that.",
        "return min(slower, default=v_min)":
            "You take the slowest of the speeds that qualify: the rule takes the fastest.",
        "np.linspace(v_min, v_max, n) -> np.linspace(v_min, v_max, n, endpoint=False)":
            "Your grid does not reach v_max: n speeds have n - 1 steps between them.",
    },
)  # fmt: skip
def target_speed(v_current, v_new, v_min, v_max, n):
    speeds = np.linspace(v_min, v_max, n)
    slower = [v for v in speeds if v < min(v_current, v_new)]
    return max(slower, default=v_min)


def distance_cases(rng):
    """No car ahead, equal speeds, closing in on one of the two only, by far and by little; then 60 at random."""
    yield from ((12.0, v_current, v_new, 2.0, 3.0) for v_current, v_new in ((INF, INF), (10.0, INF), (INF, 9.0)))
    yield from ((10.0, 10.0, 10.0, 2.0, 3.0), (55.0, 4.0, 6.0, 4.0, 3.0))
    yield from ((30.0, 5.0, 6.0, 4.0, 3.0), (30.0, 29.0, 30.0, 4.0, 0.0), (12.0, 10.0, 11.0, 1.5, 2.999))
    yield from ((15.0, v_current, v_new, 2.5, 4.0) for v_current, v_new in ((8.0, 14.0), (14.0, 8.0)))
    yield from (rng.uniform([5, 5, 5, 0.5, 1], [20, 20, 20, 4, 8]) for _ in range(60))


@exercise(
    "d_s = max(floor, (v_e - min(v_current, v_new)) t_safe), Section III-D as we read it; the floor is §",
    minutes=5, difficulty=1, cases=distance_cases,
    worked=[
        ((12.0, 10.0, 11.0, 2.0, 3.0), 4.0),  # (12 - 10) · 2
        ((8.25, 10.0, 10.0, 2.0, 3.0), 3.0),  # slower than both: -3.5 m, so the floor
    ],
    hints=(
        "How far do you close in on the slower of the two cars in `t_safe` seconds?",
        "Closing speed: `v_ego - min(v_current, v_new)`. It may be negative. What does the rule demand then?",
    ),
    mistakes={
        "return closing_speed * t_safe":
            "Your distance is negative when you are slower than both cars. It has to be at least `floor`.",
        "min -> max":
            "You use the speed of the faster car. Use that of the slower one: you reach it first.",
        "closing_speed * t_safe -> -closing_speed * t_safe":
            "Your sign is wrong: the distance has to grow when you are *faster* than the car ahead, not slower.",
        "closing_speed * t_safe -> abs(closing_speed) * t_safe":
            "You take the absolute value. A car that is slower than both does not close in: the floor is enough.",
        "return floor + closing_speed * t_safe":
            "You add `floor` to the distance. It is a lower bound: the larger of the two counts.",
        "min(v_current, v_new) -> v_new":
            "You look at the new lane only. Until the change is complete, you can still hit the car ahead in your own "
            "lane.",
    },
)  # fmt: skip
def safety_distance(v_ego, v_current, v_new, t_safe, floor):
    closing_speed = v_ego - min(v_current, v_new)
    return max(floor, closing_speed * t_safe)


def change_cases(rng):
    """No cars, trap 2 alongside, just enough and just too little room, a fast car behind; then 150 at random."""
    yield INF, INF, 5.0, 3.0, 8.25, 0.0, 1.5, 3.0
    yield 6.0, INF, 5.0, 3.0, 8.25, 0.0, 1.5, 3.0
    yield 9.0, INF, 5.0, 3.0, 8.25, 0.0, 1.5, 3.0
    yield INF, 7.0, 5.0, 3.0, 8.25, 8.0, 1.5, 3.0
    yield INF, 9.0, 5.0, 3.0, 8.0, 12.0, 1.5, 3.0  # 4 m behind, and it closes in 6 m
    yield INF, 6.0, 5.0, 3.0, 12.0, 8.0, 1.5, 3.0  # it falls back, but is 1 m behind
    yield 8.0, INF, 5.0, 3.0, 8.25, 0.0, 1.5, 3.0  # the gap is exactly the distance: no room
    yield 8.1, INF, 5.0, 3.0, 8.25, 0.0, 1.5, 3.0
    yield INF, 8.0, 5.0, 3.0, 8.25, 8.0, 1.5, 3.0
    yield INF, 11.0, 5.0, 3.0, 8.0, 12.0, 1.5, 3.0  # behind, too
    yield INF, 11.1, 5.0, 3.0, 8.0, 12.0, 1.5, 3.0
    yield INF, 6.8, 5.0, 3.0, 8.0, 10.0, 1.0, 1.5  # 1.8 m behind: more than the floor, and it closes in 2 m
    yield INF, 9.2, 5.0, 3.0, 8.0, 12.0, 1.0, 4.5  # 4.2 m behind: it closes in 4 m, less than the floor
    for near in (0.001, -0.001, 1e-6, -1e-6):  # a little more than needed, or less: ahead, behind, at the floor
        yield 8.0 + near, INF, 5.0, 3.0, 8.25, 0.0, 1.5, 3.0
        yield INF, 11.0 + near, 5.0, 3.0, 8.0, 12.0, 1.5, 3.0
        yield INF, 8.0 + near, 5.0, 3.0, 8.25, 8.0, 1.5, 3.0
    for _ in range(150):
        front, rear, d_s, v, v_rear = rng.uniform([4, 4, 3, 6, 6], [22, 22, 12, 15, 15])
        length, t_safe, floor = rng.uniform([3, 0.5, 1], [8, 3, 5])
        yield front, rear, length, d_s, v, v_rear, t_safe, floor


@exercise(
    "Algorithm 1, line 2, as we read it, and O_dec, Section III-D", minutes=6, difficulty=2, cases=change_cases,
    worked=[
        ((12.0, INF, 5.0, 3.0, 8.25, 0.0, 1.5, 3.0), True),  # 7 m of gap, 3 m needed
        ((7.0, INF, 5.0, 3.0, 8.25, 0.0, 1.5, 3.0), False),  # 2 m
        ((30.0, 9.0, 5.0, 3.0, 8.0, 12.0, 1.5, 3.0), False),  # 4 m behind, closing in 6 m in 1.5 s
    ],
    hints=(
        "Two gaps, from bumper to bumper, and a needed distance for each. `d_s` is the one ahead.",
        "Behind: `max(floor, (v_rear - v_ego) * t_safe)`, because there the other car closes in on you.",
    ),
    mistakes={
        "gap_front > -> gap_front <":
            "You change lane when the gap ahead is *shorter* than the safety distance, as the paper prints it. It has "
            "to be longer.",
        "- length -> [2 times]":
            "You measure from centre to centre. The gap is from bumper to bumper: subtract a car's length from each "
            "distance.",
        "length -> length / 2 [2 times]":
            "You subtract half a length. From bumper to bumper two halves go: half of your car and half of the other.",
        "return gap_front > d_s":
            "You look ahead only. The car behind you in the new lane needs its distance, too.",
        "v_rear - v_ego -> v_ego - v_rear":
            "Behind you, the *other* car closes in: the distance that you need there grows with v_rear - v_ego.",
        "max(floor, (v_rear - v_ego) * t_safe) -> (v_rear - v_ego) * t_safe":
            "If the car behind is slower than you, your needed distance is negative, and you cut in right in front of "
            "it. Apply the floor there, too.",
        "and -> or":
            "Room ahead *or* behind is not enough: you need both.",
        "return gap_front >= d_s and gap_rear >= needed_behind":
            "A gap that is exactly the needed distance is not longer than it: compare with >.",
    },
)  # fmt: skip
def room_to_change(dx_front, dx_rear, length, d_s, v_ego, v_rear, t_safe, floor):
    gap_front, gap_rear = dx_front - length, dx_rear - length
    needed_behind = max(floor, (v_rear - v_ego) * t_safe)
    return gap_front > d_s and gap_rear > needed_behind
