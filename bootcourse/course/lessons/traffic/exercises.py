"""Exercises of the lesson on the other cars: how they follow, change lane and steer."""

import numpy as np

from bootcourse.course.exercise import exercise
from bootcourse.course.lessons.traffic import simulation
from bootcourse.road import formulas


def gap_cases(rng):
    """Same speed, falling back, standing still; a_max and b apart; a jam ahead at full speed; then 40 at random."""
    yield from ((v, dv, 10.0, 1.5, 0.5, 0.5) for v, dv in ((10.0, 0.0), (10.0, -2.0), (0.0, 0.0)))
    yield 12.0, 3.0, 5.0, 1.0, 2.0, 1.0
    yield 30.0, 30.0, 10.0, 1.5, 0.5, 0.5
    yield 30.0, -30.0, 10.0, 1.5, 0.5, 0.5
    yield from (rng.uniform([1, -4, 1, 0.5, 0.3, 0.3], [20, 6, 12, 2, 2, 2]) for _ in range(40))


desired_gap = exercise(
    "s* = s0 + T v + v Δv / (2 √(a_max b)), Section III-B", minutes=4, difficulty=1, cases=gap_cases,
    worked=[
        ((10.0, 0.0, 10.0, 1.5, 0.5, 0.5), 25.0),  # 10 + 1.5 · 10
        ((10.0, 2.0, 10.0, 1.5, 0.5, 0.5), 45.0),  # and 10 · 2 / (2 · 0.5)
        ((10.0, 2.0, 10.0, 1.5, 2.0, 0.5), 35.0),  # 20 / (2 · 1)
    ],
    hints=(
        "Three terms: a gap at standstill, a gap that grows with speed, and one that grows when you close in.",
        "`s0 + time_gap * v` is the gap behind a car at your own speed.",
    ),
    mistakes={
        "+ v * dv -> - v * dv":
            "Your driver keeps a shorter gap when it closes in. Δv is its own speed minus that of the car ahead, so a "
            "positive Δv needs a longer gap.",
        "2 * math.sqrt(a_max * b) -> math.sqrt(a_max * b)":
            "The 2 in the denominator is missing: v Δv is divided by 2 √(a_max b).",
        "math.sqrt(a_max * b) -> a_max * b":
            "You divide by 2 a_max b. Divide by 2 √(a_max b): only with the root is the unit metres.",
        "v * dv -> dv * dv":
            "You square Δv: the last term is v Δv, the speed times the closing speed.",
        "s0 + ->":
            "You left out s0, the gap that is kept at a standstill.",
        "return s0 + max(0.0, v * time_gap + v * dv / (2 * math.sqrt(a_max * b)))":
            "You keep s* from falling below s0, as some versions of IDM do. The formula above has no such limit.",
        "(2 * math.sqrt(a_max * b)) -> 2 * math.sqrt(a_max * b)":
            "You multiply by √(a_max b): Python computes `x / 2 * y` as `(x / 2) * y`. Put the denominator in "
            "parentheses.",
    },
)(formulas.desired_gap)  # fmt: skip


def behind_cases(rng):
    """A leader at the same speed, one that stops, a free road, hard braking, an accident; then 25 at random."""
    usual = (12.5, 10.0, 1.5, 0.5, 0.5, 4.0, 6.0)
    yield np.full(6, 10.0), 10.0, 25.0, 0.5, *usual
    yield np.array([8.0, 4.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0]), 10.0, 20.0, 0.5, *usual
    yield np.full(5, 15.0), 12.0, 1e6, 0.5, *usual
    yield np.zeros(6), 6.0, 14.0, 0.5, *usual[:-1], 3.0
    yield np.zeros(5), 12.0, 7.0, 0.5, *usual  # too near to stop: the gap becomes negative
    yield np.full(3, 30.0), 28.0, 60.0, 0.1, 30.0, *usual[1:]
    yield np.full(4, 12.0), 5.0, 200.0, 0.5, 12.5, 10.0, 1.5, 3.0, 0.5, 4.0, 1.0  # speeds up harder than `limit`
    for _ in range(25):
        leader = np.maximum(rng.uniform(5, 14) + np.cumsum(rng.normal(0, 0.8, 8)), 0)
        driver = rng.uniform([9, 2, 0.8, 0.4, 0.4, 1.5, 2], [16, 11, 2, 2, 2, 5, 8])
        yield leader, rng.uniform(4, 12), rng.uniform(25, 60), rng.choice([0.25, 0.5]), *driver


drive_behind = exercise(
    "IDM in steps of dt, Section III-B", minutes=15, difficulty=3, cases=behind_cases,
    worked=[
        # s* = 10 and 1.5 s · 10 m/s is the gap: a = 0.5 (1 - 0.4096 - 1), a tenth of a metre per second in 0.5 s
        ((np.array([10.0]), 10.0, 25.0, 0.5, 12.5, 10.0, 1.5, 0.5, 0.5, 4.0, 6.0),
         np.array([[25.0, 10.0], [25.0, 9.8976]])),
        # a car that stands, 1 m ahead: the brakes give 6 m/s², the gap shrinks by 2 m/s · 0.5 s
        ((np.array([0.0]), 2.0, 2.0, 0.5, 12.5, 10.0, 1.5, 0.5, 0.5, 4.0, 6.0), np.array([[2.0, 2.0], [1.0, 0.0]])),
    ],
    hints=(
        "Keep `gap` and `v` in two variables and a list of what they were. One turn of the loop is one step.",
        "In a step: `s_star`, then `a = max(..., -limit)`, then both new values from the *old* ones: `gap, v = ..., "
        "...` computes the right side before it assigns.",
    ),
    mistakes={
        "v - v_leader -> v_leader - v":
            "Your driver keeps a shorter gap when it closes in. Δv is its own speed minus that of the car ahead.",
        "gap, v = gap + (v_leader - v) * dt, max(v + max(a, -limit) * dt, 0.0) -> "
        "v = max(v + max(a, -limit) * dt, 0.0); gap += (v_leader - v) * dt":
            "You move the car with its *new* speed. In a step both cars move with the speeds that they have at its "
            "start; compute the new gap first, or keep the old speed.",
        "max(a, -limit) -> a":
            "Your driver brakes harder than `limit` when the gap is short: the acceleration is at least -limit.",
        "max(a, -limit) -> min(max(a, -limit), limit)":
            "You limit the driver's acceleration, too: `limit` is for braking. IDM's own bracket keeps the "
            "acceleration below a_max.",
        "s_star / gap -> s_star / (gap + (v_leader - v) * dt)":
            "You move the cars first and then compute the acceleration from the *new* gap. Compute it from the speeds "
            "and the gap at the start of the step.",
        "max(v + max(a, -limit) * dt, 0.0) -> v + max(a, -limit) * dt":
            "Your car drives backwards when it brakes at a standstill: its speed is at least 0.",
        "(s_star / gap) ** 2 -> s_star / gap":
            "The square of s*/s is missing: at twice the desired gap the term is a quarter, not a half.",
        "s_star / gap -> gap / s_star":
            "Your driver brakes harder the *farther* the car ahead is: the fraction is s* over the gap.",
        "in leader -> in np.full(len(leader), leader[0])":
            "You use the leader's first speed in every step. In step k it drives leader[k].",
        "return np.array(states)[:, ::-1].copy()":
            "Your two columns are swapped: the gap comes first, then the speed.",
    },
)(simulation.drive_behind)  # fmt: skip


def heading_cases(rng):
    """Settled in one step, a constant oscillation, growing ones, no step; then 30 at random."""
    yield from ((1.0, tau, 0.5, 6) for tau in (0.5, 0.25, 0.2, 0.6))
    yield 0.1, 0.6, 0.5, 0
    yield from ((*rng.uniform([-0.3, 0.15, 0.05], [0.3, 1.0, 0.5]), rng.integers(1, 8)) for _ in range(30))


@exercise(
    "ψ̇ = (ψ_wanted - ψ) / τ_heading, in Euler steps of dt", minutes=6, difficulty=2, cases=heading_cases,
    worked=[
        ((1.0, 0.5, 0.5, 2), np.array([1.0, 0.0, 0.0])),
        ((1.0, 0.2, 0.5, 2), np.array([1.0, -1.5, 2.25])),
        ((0.4, 1.0, 0.5, 2), np.array([0.4, 0.2, 0.1])),
    ],
    hints=(
        "In one step the heading turns at the rate error / τ for dt seconds. What is left of the error?",
        "One step: `error - dt / tau * error`, which is `error * (1 - dt / tau)`.",
    ),
    mistakes={
        "return error * np.exp(-dt / tau * np.arange(steps + 1))":
            "This is the solution in continuous time, where the error always decays. Here the rate is held for a whole "
            "step, so each step subtracts dt/τ times the error.",
        "1 - dt / tau -> 1 + dt / tau":
            "Your controller steers away from the goal: the error has to be subtracted.",
        "dt / tau -> dt * tau":
            "You multiply by τ. A *small* time constant means a fast controller: the rate is error / τ.",
        "return error * (1 - np.arange(steps + 1) * dt / tau)":
            "You subtract the same amount in each step. Each step subtracts the same *fraction* of the error that is "
            "left.",
        "return np.abs(error * (1 - dt / tau) ** np.arange(steps + 1))":
            "Your error never changes sign. When dt/τ is above 1, each step overshoots, and the sign changes.",
    },
)  # fmt: skip
def heading_errors(error, tau, dt, steps):
    return error * (1 - dt / tau) ** np.arange(steps + 1)
