"""Exercises of the lesson on the rule controller."""

from bootcourse import rule
from bootcourse.lessons.exercise import Exercise, Mistake


def cases(rng):
    """Corner cases: nobody ahead, equal speeds, closing in on one of the two only; then 60 at random."""
    inf = float("inf")
    yield 12.0, inf, inf, 2.0, 3.0
    yield 12.0, 10.0, inf, 2.0, 3.0
    yield 12.0, inf, 9.0, 2.0, 3.0
    yield 10.0, 10.0, 10.0, 2.0, 3.0
    yield 15.0, 8.0, 14.0, 2.5, 4.0
    yield 15.0, 14.0, 8.0, 2.5, 4.0
    for _ in range(60):
        yield (*rng.uniform(5, 20, 3).tolist(), rng.uniform(0.5, 4), rng.uniform(1, 8))


safety_distance = Exercise(
    call="safety_distance(v_ego, v_current, v_new, t_safe, floor)",
    solution=rule.safety_distance,
    worked=(
        ((12.0, 10.0, 11.0, 2.0, 3.0), 4.0),  # (12 - 10) · 2
        ((8.25, 10.0, 10.0, 2.0, 3.0), 3.0),  # slower than both: -3.5 m, so the floor
    ),
    cases=cases,
    mistakes=(
        Mistake(
            answer=lambda v_ego, v_current, v_new, t_safe, floor: (v_ego - min(v_current, v_new)) * t_safe,
            says="Your distance is negative when you are slower than both cars. It may never be shorter than `floor`.",
            belief="A formula holds everywhere; that it gives -3.5 m behind faster cars goes unnoticed.",
        ),
        Mistake(
            answer=lambda v_ego, v_current, v_new, t_safe, floor: max(floor, (v_ego - max(v_current, v_new)) * t_safe),
            says="You measure against the faster of the two cars. The slower one is the one that you reach first.",
            belief="The lane that one changes to is the faster one, so its car must be what counts.",
        ),
        Mistake(
            answer=lambda v_ego, v_current, v_new, t_safe, floor: max(floor, (min(v_current, v_new) - v_ego) * t_safe),
            says="Your sign is turned: the distance has to grow when you are *faster* than the car ahead, not slower.",
            belief="The speed difference is read as 'theirs minus mine', as the gap is.",
        ),
        Mistake(
            answer=lambda v_ego, v_current, v_new, t_safe, floor: floor + (v_ego - min(v_current, v_new)) * t_safe,
            says="You add `floor` to the distance. It is a lower bound: the larger of the two counts.",
            belief="A floor is taken for a margin that comes on top.",
        ),
        Mistake(
            answer=lambda v_ego, v_current, v_new, t_safe, floor: max(floor, (v_ego - v_new) * t_safe),
            says="You look at the new lane only. Until you are across, you can still reach the car in your own lane.",
            belief="The change of lane is instant.",
        ),
    ),
    hints=(
        "How far do you close in on the slower of the two cars in `t_safe` seconds?",
        "Closing speed: `v_ego - min(v_current, v_new)`. It may be negative. What does the rule demand then?",
        "`max(floor, ...)` around closing speed times time.",
    ),
    minutes=5,
    difficulty=1,
    equation="d_s = max(floor, (v_e - min(v_current, v_new)) t_safe), Section III-D, its sign corrected",
)
