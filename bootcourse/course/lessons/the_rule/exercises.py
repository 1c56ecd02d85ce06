"""Exercises of the lesson on the rule controller."""

import numpy as np

from bootcourse import rule
from bootcourse.course.exercise import Exercise, Mistake
from bootcourse.course.lessons.the_rule.plans import ROADS, direct_solution, drive_plan, what_happened

INF = float("inf")


def of_grid(low, high, n, allowed, choose=max):
    """The fastest of n speeds that is allowed."""
    return choose((v for v in np.linspace(low, high, n) if allowed(v)), default=low)


def speed_cases(rng):
    """Traps on the grid, at its ends and off it, a free road, one lane free, all too slow; then 60 at random."""
    for v_current, v_new in ((10.0, 10.0), (8.25, 8.25), (8.25, 20.0), (20.0, 8.25), (6.0, 6.0), (15.0, 15.0),
                             (INF, INF), (10.0, INF), (INF, 10.0), (5.0, 20.0)):  # fmt: skip
        yield v_current, v_new, 6.0, 15.0, 5
    yield 16.0, 14.9, 6.0, 15.0, 2
    for _ in range(60):
        low = rng.uniform(3, 8)
        yield *rng.uniform(4, 18, 2), low, low + rng.uniform(3, 10), rng.integers(2, 9)


target_speed = Exercise(
    "target_speed(v_current, v_new, v_min, v_max, n)", solution=rule.target_speed, cases=speed_cases,
    worked=(
        ((10.0, 10.0, 6.0, 15.0, 5), 8.25),  # of 6, 8.25, 10.5, 12.75, 15
        ((8.25, 12.0, 6.0, 15.0, 5), 6.0),  # *slower* than 8.25
        ((INF, INF, 6.0, 15.0, 5), 15.0),
    ),
    mistakes=(
        Mistake(lambda a, b, low, high, n: of_grid(low, high, n, lambda v: v <= min(a, b)),
            "You allow the speed of the car ahead itself. Your speed has to be *slower*: otherwise the gap does not "
            "grow.",
            "Equal speeds are safe, so equal is allowed."),
        Mistake(lambda a, b, low, high, n: of_grid(low, high, n, lambda v: v < a),
            "You look at the car in your own lane only. While you change, the new car ahead limits you, too.",
            "The new lane matters only after the change."),
        Mistake(lambda a, b, low, high, n: of_grid(low, high, n, lambda v: v < b),
            "You look at the car in the new lane only. Until you are there, the car ahead of you limits you, too.",
            "The old lane does not matter any more."),
        Mistake(lambda a, b, low, high, n: of_grid(low, high, n, lambda v: v < max(a, b)),
            "You compare with the faster of the two cars: slower than *both* means slower than the minimum.",
            "The other lane is faster, so its car sets the limit."),
        Mistake(lambda a, b, low, high, n: min(max(min(a, b), low), high),
            "You return the slower car's own speed. The rule takes one of its n speeds: the fastest one below that.",
            "The grid is only there to describe a range."),
        Mistake(lambda a, b, low, high, n: of_grid(low, high, n, lambda v: v < min(a, b), choose=min),
            "You take the slowest of the speeds that qualify: the rule takes the fastest.",
            "Slower is safer."),
        Mistake(lambda a, b, low, high, n: of_grid(low, high - (high - low) / n, n, lambda v: v < min(a, b)),
            "Your grid does not reach v_max: n speeds have n - 1 steps between them.",
            "n speeds, n steps."),
    ),
    hints=(
        "Make the n speeds, keep those below the slower car, take the largest. What if none is left?",
        "`np.linspace(v_min, v_max, n)` are the speeds; `min(v_current, v_new)` is the limit.",
        "`max([v for v in np.linspace(v_min, v_max, n) if v < min(v_current, v_new)], default=v_min)`",
    ),
    minutes=6, difficulty=1, equation="v_target = max {v_i : v_i < min(v_current, v_new)}, Section III-D",
)  # fmt: skip


safety_distance = Exercise(
    "safety_distance(v_ego, v_current, v_new, t_safe, floor)", solution=rule.safety_distance,
    # no car ahead, equal speeds, closing in on one of the two only; then 60 at random
    cases=lambda rng: [(12.0, INF, INF, 2.0, 3.0), (12.0, 10.0, INF, 2.0, 3.0), (12.0, INF, 9.0, 2.0, 3.0),
                       (10.0, 10.0, 10.0, 2.0, 3.0), (15.0, 8.0, 14.0, 2.5, 4.0), (15.0, 14.0, 8.0, 2.5, 4.0),
                       *(rng.uniform([5, 5, 5, 0.5, 1], [20, 20, 20, 4, 8]) for _ in range(60))],
    worked=(
        ((12.0, 10.0, 11.0, 2.0, 3.0), 4.0),  # (12 - 10) · 2
        ((8.25, 10.0, 10.0, 2.0, 3.0), 3.0),  # slower than both: -3.5 m, so the floor
    ),
    mistakes=(
        Mistake(lambda v_ego, v_current, v_new, t_safe, floor: (v_ego - min(v_current, v_new)) * t_safe,
            "Your distance is negative when you are slower than both cars. It has to be at least `floor`.",
            "The formula holds everywhere. (Behind faster cars it gives -3.5 m.)"),
        Mistake(lambda v_ego, v_current, v_new, t_safe, floor: max(floor, (v_ego - max(v_current, v_new)) * t_safe),
            "You use the speed of the faster car. Use that of the slower one: you reach it first.",
            "The new lane is the faster one, so the car there counts."),
        Mistake(lambda v_ego, v_current, v_new, t_safe, floor: max(floor, (min(v_current, v_new) - v_ego) * t_safe),
            "Your sign is wrong: the distance has to grow when you are *faster* than the car ahead, not slower.",
            "The speed difference is theirs minus mine, as the gap is."),
        Mistake(lambda v_ego, v_current, v_new, t_safe, floor: max(floor, abs(v_ego - min(v_current, v_new)) * t_safe),
            "You take the absolute value. A car that is slower than both does not close in: the floor is enough.",
            "A distance is positive, so its sign can be dropped."),
        Mistake(lambda v_ego, v_current, v_new, t_safe, floor: floor + (v_ego - min(v_current, v_new)) * t_safe,
            "You add `floor` to the distance. It is a lower bound: the larger of the two counts.",
            "A floor is a margin that is added."),
        Mistake(lambda v_ego, v_current, v_new, t_safe, floor: max(floor, (v_ego - v_new) * t_safe),
            "You look at the new lane only. Until the change is complete, you can still hit the car ahead in your own "
            "lane.",
            "A change of lane takes no time."),
    ),
    hints=(
        "How far do you close in on the slower of the two cars in `t_safe` seconds?",
        "Closing speed: `v_ego - min(v_current, v_new)`. It may be negative. What does the rule demand then?",
        "`max(floor, ...)` around closing speed times time.",
    ),
    minutes=5, difficulty=1,
    equation="d_s = max(floor, (v_e - min(v_current, v_new)) t_safe), Section III-D as we read it; the floor is §",
)  # fmt: skip


def change_solution(dx_front, dx_rear, length, d_s, v_ego, v_rear, t_safe, floor):
    gap_front, gap_rear = dx_front - length, dx_rear - length
    needed_behind = max(floor, (v_rear - v_ego) * t_safe)
    return gap_front > d_s and gap_rear > needed_behind


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
    for _ in range(150):
        front, rear, d_s, v, v_rear = rng.uniform([4, 4, 3, 6, 6], [22, 22, 12, 15, 15])
        length, t_safe, floor = rng.uniform([3, 0.5, 1], [8, 3, 5])
        yield front, rear, length, d_s, v, v_rear, t_safe, floor


room_to_change = Exercise(
    "room_to_change(dx_front, dx_rear, length, d_s, v_ego, v_rear, t_safe, floor)",
    solution=change_solution, cases=change_cases,
    worked=(
        ((12.0, INF, 5.0, 3.0, 8.25, 0.0, 1.5, 3.0), True),  # 7 m of gap, 3 m needed
        ((7.0, INF, 5.0, 3.0, 8.25, 0.0, 1.5, 3.0), False),  # 2 m
        ((30.0, 9.0, 5.0, 3.0, 8.0, 12.0, 1.5, 3.0), False),  # 4 m behind, closing in 6 m in 1.5 s
    ),
    mistakes=(
        Mistake(lambda front, rear, length, d_s, v, v_rear, t, floor:
            front - length < d_s and rear - length > max(floor, (v_rear - v) * t),
            "You change lane when the gap ahead is *shorter* than the safety distance, as the paper prints it. It has "
            "to be longer.",
            "A printed formula is right."),
        Mistake(lambda front, rear, length, *rest: change_solution(front, rear, 0.0, *rest),
            "You measure from centre to centre. The gap is from bumper to bumper: subtract a car's length from each "
            "distance.",
            "The distance between two cars is the distance between their positions."),
        Mistake(lambda front, rear, length, *rest: change_solution(front, rear, length / 2, *rest),
            "You subtract half a length. From bumper to bumper two halves go: half of your car and half of the other.",
            "Only the other car's length counts."),
        Mistake(lambda front, rear, *rest: change_solution(front, INF, *rest),
            "You look ahead only. The car behind you in the new lane needs its distance, too.",
            "The driver behind has to take care."),
        Mistake(lambda front, rear, length, d_s, v, u, *rest: change_solution(front, rear, length, d_s, u, v, *rest),
            "Behind you, the *other* car closes in: the distance that you need there grows with v_rear - v_ego.",
            "The same formula serves ahead and behind."),
        Mistake(lambda *case: change_solution(*case[:-1], -INF),
            "If the car behind is slower than you, your needed distance is negative, and you cut in right in front of "
            "it. Apply the floor there, too.",
            "The floor belongs to the formula for the car ahead."),
        Mistake(lambda front, rear, length, d_s, v, v_rear, t, floor:
            front - length > d_s or rear - length > max(floor, (v_rear - v) * t),
            "Room ahead *or* behind is not enough: you need both.",
            "Room on one side is enough."),
        Mistake(lambda front, rear, length, d_s, v, v_rear, t, floor:
            front - length >= d_s and rear - length >= max(floor, (v_rear - v) * t),
            "A gap that is exactly the needed distance is not longer than it: compare with >.",
            "At least and more than are the same."),
    ),
    hints=(
        "Two gaps, from bumper to bumper, and a needed distance for each. `d_s` is the one ahead.",
        "Behind: `max(floor, (v_rear - v_ego) * t_safe)`, because there the other car closes in on you.",
        "`dx_front - length > d_s and dx_rear - length > max(floor, (v_rear - v_ego) * t_safe)`",
    ),
    minutes=6, difficulty=2, equation="Algorithm 1, line 2, as we read it, and O_dec, Section III-D",
)  # fmt: skip


def first_solution(costs):
    cheapest = costs.min(axis=(1, 2))
    return cheapest.argmin()


def first_cases(rng):
    """The best plan begins with each of the three; then 50 at random."""
    for first in range(3):
        costs = rng.uniform(5, 9, (3, 3, 3))
        costs[first, (first + 1) % 3, (first + 2) % 3] = 1.0
        yield (costs,)
    for _ in range(50):
        yield (rng.uniform(0, 10, (3, 3, 3)) + rng.choice([0.0, 1e6], (3, 3, 3), p=[0.8, 0.2]),)


def one_good_plan(first, second, third):
    costs = np.full((3, 3, 3), 5.0)
    costs[first, second, third] = 1.0
    return costs


best_first_step = Exercise(
    "best_first_step(costs)", solution=first_solution, cases=first_cases,
    worked=(
        ((one_good_plan(2, 0, 1),), 2),  # right, left, straight
        ((one_good_plan(0, 2, 1),), 0),
    ),
    mistakes=(
        Mistake(lambda costs: costs.argmin(),
            "This is the number of the best plan, 0 to 26. Return only its first step, 0, 1 or 2.",
            "argmin gives the index along the first axis."),
        Mistake(lambda costs: costs.mean(axis=(1, 2)).argmin(),
            "You average over the later steps. You choose those steps as well: take the best of them.",
            "The future is uncertain, so it is averaged."),
        Mistake(lambda costs: costs.min(axis=(0, 1)).argmin(),
            "This is the *last* step of the best plan. The first axis is the step that you take now.",
            "The axes are counted from the end of the plan."),
        Mistake(lambda costs: costs[:, 1, 1].argmin(),
            "You assume that you steer straight afterwards. A lane change needs a turn and a turn back, so it never "
            "looks good then.",
            "Looking ahead means to steer once and then drive straight."),
        Mistake(lambda costs: costs.max(axis=(1, 2)).argmin(),
            "You compare the worst plan after each first step. You choose the later steps yourself: take the best "
            "plan.",
            "A careful driver prepares for the worst case."),
        Mistake(lambda costs: costs.min(axis=(1, 2)).argmax(),
            "You take the most expensive first step. The cost should be small.",
            "The best action has the largest entry."),
    ),
    hints=(
        "There are 27 plans, nine for each first step. What does a first step cost?",
        "`costs.min(axis=(1, 2))` is the cheapest plan for each first step: three numbers.",
        "`costs.min(axis=(1, 2)).argmin()`",
    ),
    minutes=5, difficulty=2, equation="the tracker's choice among 27 sequences of steering, bootcourse.rule",
)  # fmt: skip


def plan(*steps):
    return lambda: list(steps)


direct_plan = Exercise(
    "direct_plan()", solution=direct_solution, run=drive_plan, explain=what_happened,
    cases=lambda rng: ((road,) for road in ROADS[1:] * 3),
    worked=(((ROADS[0],), np.array([0.0, 0.0, 1.0])),),
    mistakes=(
        Mistake(plan(("keep left", 2), ("keep right", 2)),
            "Your plan is safe, but it does not get ahead of trap 1. Draw it, and see in which lane the car ends, "
            "and behind which trap.",
            "One lane change leads out."),
        Mistake(plan(("keep left", 5)),
            "Your plan steers the car off the road. Each turn needs a turn back.",
            "Left is where the free lane is."),
        Mistake(plan(("brake straight", 2), ("keep left", 2), ("keep right", 2)),
            "You brake. That makes room behind trap 2, but this exercise asks for a way without it.",
            "Without braking there is no room."),
        Mistake(plan(("accelerate straight", 5)),
            "Your plan hits one of the traps. Draw it on road 7, and see which one, and when.",
            "Speed alone overtakes."),
    ),
    hints=(
        "Two seconds of `keep left` move the car 2.5 m to the left and leave it turned. Try what turns it back.",
        "In the middle lane turn back only halfway, and go on to the left lane at once. Eight seconds of steering do.",
        'It begins with `("keep left", 2), "keep right", "keep left"`, and ends with `("accelerate straight", 5)`.',
    ),
    minutes=20, difficulty=3, equation="a plan without braking, on roads with D2 ≥ 4.85 m",
)  # fmt: skip


def table(actions, own, other):
    return np.where(np.arange(9) == np.asarray(actions)[..., None], own, other)


stochastic_rule = Exercise(
    "stochastic_rule(rule_actions, p)", solution=rule.stochastic_rule,
    # every action, p = 1/9, which is uniform; then 40 at random
    cases=lambda rng: [(np.arange(9), 0.9), (np.array([3, 3, 8]), 1 / 9), (np.array([0]), 0.999), *(
                       (rng.integers(0, 9, rng.integers(1, 6)), rng.uniform(0.12, 0.99)) for _ in range(40))],
    worked=(
        ((np.array([3]), 0.9), np.array([[0.0125] * 3 + [0.9] + [0.0125] * 5])),
        ((np.array([0, 8]), 1 / 9), np.full((2, 9), 1 / 9)),
    ),
    mistakes=(
        Mistake(lambda actions, p: table(actions, p, 1 - p),
            "Your probabilities add up to more than 1: the eight other actions *share* 1 - p.",
            "1 - p is the probability of each other action."),
        Mistake(lambda actions, p: table(actions, p, (1 - p) / 9),
            "You share 1 - p among nine actions. The rule's own action already has p: eight are left.",
            "There are nine actions, so nine shares."),
        Mistake(lambda actions, p: table(actions, p + (1 - p) / 9, (1 - p) / 9),
            "You mix the rule with a uniform policy. The probabilities add up to 1, but the rule's own action gets "
            "more than p.",
            "'With probability 1 - p, anything' and 'with probability 1 - p, something else' are the same."),
        Mistake(lambda actions, p: table(actions, (1 - p) / 8, p),
            "Your two cases are swapped: the rule's own action has the small probability, and each other action has p.",
            "np.where takes the value for False first."),
        Mistake(lambda actions, p: table(actions, p, 0.0),
            "The other eight actions have probability 0, which makes the KL of lesson 7 infinite. They share 1 - p.",
            "The rule would never do them."),
        Mistake(lambda actions, p: table([actions] * len(actions), p, (1 - p) / 8).max(axis=1),
            "`table[:, rule_actions] = p` writes p into these columns of *every* row. Each row has one p: give the "
            "number of the row as well, `table[np.arange(n), rule_actions]`.",
            "A list of columns is used row by row."),
    ),
    hints=(
        "Begin with a table (n, 9) that holds the probability of each *other* action.",
        "`np.full((len(rule_actions), 9), (1 - p) / 8)`. Which one entry of each row has to become p?",
        "`table[np.arange(len(rule_actions)), rule_actions] = p`",
    ),
    minutes=5, difficulty=1, equation="π̃(a|s), Section IV-A",
)  # fmt: skip
