"""Exercises of the lesson on the other cars: how they follow, change lane and steer."""

import math

import numpy as np

from bootcourse.course.exercise import Exercise, Mistake
from bootcourse.course.lessons.traffic import simulation as traffic
from bootcourse.road import formulas

desired_gap = Exercise(
    "desired_gap(v, dv, s0, time_gap, a_max, b)", solution=formulas.desired_gap,
    # same speed, falling back, standing still; a_max and b apart; then 40 at random
    cases=lambda rng: [(10.0, 0.0, 10.0, 1.5, 0.5, 0.5), (10.0, -2.0, 10.0, 1.5, 0.5, 0.5),
                       (0.0, 0.0, 10.0, 1.5, 0.5, 0.5), (12.0, 3.0, 5.0, 1.0, 2.0, 1.0),
                       *(rng.uniform([1, -4, 1, 0.5, 0.3, 0.3], [20, 6, 12, 2, 2, 2]) for _ in range(40))],
    worked=(
        ((10.0, 0.0, 10.0, 1.5, 0.5, 0.5), 25.0),  # 10 + 1.5 · 10
        ((10.0, 2.0, 10.0, 1.5, 0.5, 0.5), 45.0),  # and 10 · 2 / (2 · 0.5)
        ((10.0, 2.0, 10.0, 1.5, 2.0, 0.5), 35.0),  # 20 / (2 · 1)
    ),
    mistakes=(
        Mistake(lambda v, dv, s0, T, a, b: s0 + T * v - v * dv / (2 * math.sqrt(a * b)),
            "Your driver keeps a shorter gap when it closes in. Δv is its own speed minus that of the car ahead, so a "
            "positive Δv needs a longer gap.",
            "Δv is theirs minus mine."),
        Mistake(lambda v, dv, s0, T, a, b: s0 + T * v + v * dv / math.sqrt(a * b),
            "The 2 in the denominator is missing: v Δv is divided by 2 √(a_max b).",
            "Constants in front of a root do not matter."),
        Mistake(lambda v, dv, s0, T, a, b: s0 + T * v + v * dv / (2 * a * b),
            "You divide by 2 a_max b. Divide by 2 √(a_max b): only with the root is the unit metres.",
            "The root makes little difference."),
        Mistake(lambda v, dv, s0, T, a, b: s0 + T * v + dv * dv / (2 * math.sqrt(a * b)),
            "You square Δv: the last term is v Δv, the speed times the closing speed.",
            "A braking distance goes with the square of the speed difference."),
        Mistake(lambda v, dv, s0, T, a, b: T * v + v * dv / (2 * math.sqrt(a * b)),
            "You left out s0, the gap that is kept at a standstill.",
            "A car that stands still needs no gap."),
        Mistake(lambda v, dv, s0, T, a, b: s0 + max(0.0, T * v + v * dv / (2 * math.sqrt(a * b))),
            "You keep s* from falling below s0, as some versions of IDM do. The formula above has no such limit.",
            "A gap that a driver wants is at least s0."),
        Mistake(lambda v, dv, s0, T, a, b: s0 + T * v + v * dv / 2 * math.sqrt(a * b),
            "You multiply by √(a_max b): Python computes `x / 2 * y` as `(x / 2) * y`. Put the denominator in "
            "parentheses.",
            "A product after a division sign belongs to the denominator, as on paper."),
    ),
    hints=(
        "Three terms: a gap at standstill, a gap that grows with speed, and one that grows when you close in.",
        "`s0 + time_gap * v` is the gap behind a car at your own speed.",
        "`s0 + time_gap * v + v * dv / (2 * math.sqrt(a_max * b))`",
    ),
    minutes=4, difficulty=1, equation="s* = s0 + T v + v Δv / (2 √(a_max b)), Section III-B",
)  # fmt: skip


def behind(change):
    """drive_behind with a change in one step: change(name, right) -> what is used instead."""

    def answer(leader, v, gap, dt, w, s0, T, a_max, b, d, limit):
        states = [(gap, v)]
        for u in leader:
            wished = s0 + T * v + change("closing", v - u) * v / (2 * math.sqrt(a_max * b))
            seen = change("seen", gap, gap + (u - v) * dt)
            a = a_max * (1 - (v / w) ** d - change("ratio", wished / seen) ** change("power", 2))
            a = change("top", max(a, -change("limit", limit)), min(max(a, -limit), limit))
            new = change("speed", max(v + a * dt, 0.0), v + a * dt)
            gap, v = gap + (u - change("moves", v, new)) * dt, new
            states.append((gap, v))
        return np.array(states)

    return answer


def slip(name, wrong):
    """The change of one name; wrong(right, other)."""
    return behind(lambda each, right, other=None: wrong(right, other) if each == name else right)


def behind_cases(rng):
    """A leader at the same speed, one that stops, a free road, hard braking from close by; then 25 at random."""
    usual = (12.5, 10.0, 1.5, 0.5, 0.5, 4.0, 6.0)
    yield np.full(6, 10.0), 10.0, 25.0, 0.5, *usual
    yield np.array([8.0, 4.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0]), 10.0, 20.0, 0.5, *usual
    yield np.full(5, 15.0), 12.0, 1e6, 0.5, *usual
    yield np.zeros(6), 6.0, 14.0, 0.5, *usual[:-1], 3.0
    yield np.full(4, 12.0), 5.0, 200.0, 0.5, 12.5, 10.0, 1.5, 3.0, 0.5, 4.0, 1.0  # speeds up harder than `limit`
    for _ in range(25):
        leader = np.maximum(rng.uniform(5, 14) + np.cumsum(rng.normal(0, 0.8, 8)), 0)
        driver = rng.uniform([9, 2, 0.8, 0.4, 0.4, 1.5, 2], [16, 11, 2, 2, 2, 5, 8])
        yield leader, rng.uniform(4, 12), rng.uniform(25, 60), rng.choice([0.25, 0.5]), *driver


drive_behind = Exercise(
    "drive_behind(leader, v, gap, dt, v_desired, s0, time_gap, a_max, b, delta, limit)",
    solution=traffic.drive_behind, cases=behind_cases,
    worked=(
        # s* = 10 and 1.5 s · 10 m/s is the gap: a = 0.5 (1 - 0.4096 - 1), a tenth of a metre per second in 0.5 s
        ((np.array([10.0]), 10.0, 25.0, 0.5, 12.5, 10.0, 1.5, 0.5, 0.5, 4.0, 6.0),
         np.array([[25.0, 10.0], [25.0, 9.8976]])),
        # a car that stands, 1 m ahead: the brakes give 6 m/s², the gap shrinks by 2 m/s · 0.5 s
        ((np.array([0.0]), 2.0, 2.0, 0.5, 12.5, 10.0, 1.5, 0.5, 0.5, 4.0, 6.0), np.array([[2.0, 2.0], [1.0, 0.0]])),
    ),
    mistakes=(
        Mistake(slip("closing", lambda right, _: -right),
            "Your driver keeps a shorter gap when it closes in. Δv is its own speed minus that of the car ahead.",
            "Δv is theirs minus mine."),
        Mistake(slip("moves", lambda _, new: new),
            "You move the car with its *new* speed. In a step both cars move with the speeds that they have at its "
            "start; compute the new gap first, or keep the old speed.",
            "The order of two assignments does not matter."),
        Mistake(slip("limit", lambda *_: math.inf),
            "Your driver brakes harder than `limit` when the gap is short: the acceleration is at least -limit.",
            "The formula itself has all limits."),
        Mistake(slip("top", lambda _, clipped: clipped),
            "You limit the driver's acceleration, too: `limit` is for braking. IDM's own bracket keeps the "
            "acceleration below a_max.",
            "A limit holds in both directions."),
        Mistake(slip("seen", lambda _, after: after),
            "You move the cars first and then compute the acceleration from the *new* gap. Compute it from the speeds "
            "and the gap at the start of the step.",
            "It does not matter when the acceleration is computed."),
        Mistake(slip("speed", lambda _, free: free),
            "Your car drives backwards when it brakes at a standstill: its speed is at least 0.",
            "Braking ends by itself."),
        Mistake(slip("power", lambda *_: 1),
            "The square of s*/s is missing: at twice the desired gap the term is a quarter, not a half.",
            "The exponent belongs to the speed only."),
        Mistake(slip("ratio", lambda right, _: 1 / right),
            "Your driver brakes harder the *farther* the car ahead is: the fraction is s* over the gap.",
            "It does not matter which gap is divided by the other."),
        Mistake(lambda leader, *rest: traffic.drive_behind(np.full(len(leader), leader[0]), *rest),
            "You use the leader's first speed in every step. In step k it drives leader[k].",
            "The leader's speed is a number."),
        Mistake(lambda leader, *rest: traffic.drive_behind(leader, *rest)[:, ::-1].copy(),
            "Your two columns are swapped: the gap comes first, then the speed.",
            "The order of the columns is free."),
    ),
    hints=(
        "Keep `gap` and `v` in two variables and a list of what they were. One turn of the loop is one step.",
        "In a step: `s_star`, then `a = max(..., -limit)`, then both new values from the *old* ones.",
        "`gap, v = gap + (v_leader - v) * dt, max(v + a * dt, 0.0)` computes the right side before it assigns.",
    ),
    minutes=20, difficulty=3, equation="IDM in steps of dt, Section III-B",
)  # fmt: skip


def equilibrium_solution(v, v_desired, s0, time_gap, delta):
    wanted = s0 + time_gap * v
    return wanted / math.sqrt(1 - (v / v_desired) ** delta)


def equilibrium_cases(rng):
    yield 0.0, 12.5, 10.0, 1.5, 4.0
    yield 12.4, 12.5, 10.0, 1.5, 4.0
    for _ in range(40):
        wanted = rng.uniform(9, 16)
        yield wanted * rng.uniform(0.2, 0.98), wanted, *rng.uniform([1, 0.5, 1], [12, 2, 5])


equilibrium_gap = Exercise(
    "equilibrium_gap(v, v_desired, s0, time_gap, delta)", solution=equilibrium_solution, cases=equilibrium_cases,
    worked=(((0.0, 12.5, 10.0, 1.5, 4.0), 10.0), ((5.0, 10.0, 10.0, 1.5, 2.0), 17.5 / math.sqrt(0.75))),
    mistakes=(
        Mistake(lambda v, w, s0, T, d: s0 + T * v,
            "This is s*. At a gap of s* the driver still brakes: 1 - (v/v_desired)^δ - 1 is below zero.",
            "A driver at its desired gap s* keeps its speed."),
        Mistake(lambda v, w, s0, T, d: (s0 + T * v) / (1 - (v / w) ** d),
            "The root is missing: s*/s is squared, so s is s* over a square root.",
            "The square was lost while solving for s."),
        Mistake(lambda v, w, s0, T, d: (s0 + T * v) * math.sqrt(1 - (v / w) ** d),
            "Your gap gets shorter as the driver comes closer to its desired speed. Solve (s*/s)² = 1 - "
            "(v/v_desired)^δ for s: the root stands in the denominator.",
            "The fraction was not inverted when solving for s."),
        Mistake(lambda v, w, s0, T, d: (s0 + T * v) / math.sqrt(1 + (v / w) ** d),
            "You have a plus under the root. From 0 = 1 - (v/v_desired)^δ - (s*/s)² follows (s*/s)² = 1 - "
            "(v/v_desired)^δ.",
            "Bringing a term to the other side changes every sign."),
    ),
    hints=(
        "Equilibrium means: same speed as the car ahead (Δv = 0), and no acceleration.",
        "0 = 1 - (v/v_desired)^δ - (s*/s)², with s* = s0 + T v. Solve for s.",
        "`(s0 + time_gap * v) / math.sqrt(1 - (v / v_desired) ** delta)`",
    ),
    minutes=6, difficulty=2, equation="the gap s at which the IDM's a is 0 and Δv is 0, Section III-B",
)  # fmt: skip


def changing_solution(own_gain, follower_before, follower_after, old_follower_gain, politeness, threshold, limit):
    if follower_after < -limit:
        return False
    new_follower_gain = follower_after - follower_before
    return own_gain + politeness * (new_follower_gain + old_follower_gain) > threshold


def incentive(own, before, after, old, p):
    return own + p * (after - before + old)


def changing_cases(rng):
    """Safe or not, worth it or not, politeness 0 to 1, a gain of the old follower alone; then 120 at random."""
    yield 1.0, 0.1, -3.0, 0.0, 0.0, 0.2, 2.0  # worth it without politeness, but not safe
    yield 0.5, 0.1, -1.5, 0.0, 0.5, 0.2, 2.0  # safe, but the new follower loses more
    yield 0.5, 0.1, -1.5, 0.0, 0.0, 0.2, 2.0
    yield 0.1, 0.0, 0.0, 0.0, 0.5, 0.2, 2.0  # a gain below the threshold
    yield 0.0, 0.0, 0.0, 1.0, 0.5, 0.2, 2.0  # only the old follower gains
    yield 0.4, -0.9, -1.0, 0.0, 1.0, 0.2, 2.0  # the new follower brakes anyway
    yield 0.3, 2.2, 2.3, 0.0, 1.0, 0.2, 2.0
    yield 1.0, 0.0, -2.0, 0.0, 0.0, 0.2, 2.0  # exactly at the limit: safe
    yield 1.0, 0.0, -2.01, 0.0, 0.0, 0.2, 2.0
    yield 0.25, 0.0, 0.0, 0.0, 0.5, 0.25, 2.0  # exactly at the threshold: not worth it
    yield 0.26, 0.0, 0.0, 0.0, 0.5, 0.25, 2.0
    for _ in range(120):
        limits = rng.uniform([0.05, 0.5], [0.6, 4.0])
        accelerations = rng.normal([0.4, 0, -1, 0.1], [0.8, 0.6, 1.2, 0.4])
        yield *accelerations, rng.choice([0.0, 0.3, 0.5, 1.0]), *limits


worth_changing = Exercise(
    "worth_changing(own_gain, follower_before, follower_after, old_follower_gain, politeness, threshold, limit)",
    solution=changing_solution, cases=changing_cases,
    worked=(
        ((0.5, 0.1, -1.5, 0.0, 0.5, 0.2, 2.0), False),  # 0.5 + 0.5 · (-1.6) = -0.3
        ((0.5, 0.1, -1.5, 0.0, 0.0, 0.2, 2.0), True),  # politeness 0
        ((5.0, 0.1, -2.5, 0.0, 0.0, 0.2, 2.0), False),  # not safe
    ),
    mistakes=(
        Mistake(lambda *case: changing_solution(*case[:-1], math.inf),
            "You change lane although the new follower has to brake harder than the limit. Safety comes first, "
            "whatever the gain.",
            "A large gain makes up for a risk; the politeness term is safety enough."),
        Mistake(lambda own, before, after, old, p, *rest: changing_solution(own, before, after, old, 0, *rest),
            "Your driver counts its own gain only. Add what the others gain or lose, times the politeness.",
            "If it is safe for the others, they do not matter."),
        Mistake(lambda own, before, *rest: changing_solution(own, 0, *rest),
            "You count all of the new follower's braking. Count only what the change adds: its acceleration after "
            "minus before.",
            "Its acceleration afterwards is its loss."),
        Mistake(lambda own, before, after, old, *rest: changing_solution(own, before, after, 0, *rest),
            "You forgot the old follower: the car behind gains when you leave its lane.",
            "The car that stays behind is not affected."),
        Mistake(lambda *case: changing_solution(*case[:5], 0, case[6]),
            "You left out the threshold: without it drivers change lanes back and forth for tiny gains.",
            "Any gain is a gain."),
        Mistake(lambda own, before, after, old, p, th, limit:
            after >= -limit and incentive(own, after, before, old, p) > th,
            "Your new follower gains when it has to brake: its gain is `follower_after - follower_before`.",
            "A gain is before minus after."),
        Mistake(lambda own, before, after, old, p, th, limit:
            after >= -limit and incentive(own, before, after, old, p) >= th,
            "You change lane at exactly the threshold. The formula says more than the threshold.",
            "More than and at least are the same."),
        Mistake(lambda own, before, after, old, p, th, limit:
            after > -limit and incentive(own, before, after, old, p) > th,
            "You refuse a change that makes the new follower brake exactly as hard as the limit allows.",
            "The limit itself is too much."),
        Mistake(lambda own, before, after, old, p, th, limit:
            after >= limit and incentive(own, before, after, old, p) > th,
            "Braking is a negative acceleration: the new follower's must be at least -limit.",
            "A limit has the sign of what it limits."),
        Mistake(lambda own, before, after, old, p, th, limit:
            abs(after) <= limit and incentive(own, before, after, old, p) > th,
            "You refuse a change after which the new follower *accelerates* by more than the limit: only its braking "
            "is limited.",
            "An acceleration and a braking of the same size are equally dangerous."),
    ),
    hints=(
        "Ask two questions: is the change safe, and is it worth it? If it is not safe, the answer is False.",
        "Safe means `follower_after >= -limit`. The new follower's gain is what it has after, minus before.",
        "`own_gain + politeness * (new_follower_gain + old_follower_gain) > threshold`",
    ),
    minutes=7, difficulty=2,
    equation="Δa_ego + p (Δa_rear + Δa_front) > a_threshold, Section III-B, with its safety criterion",
)  # fmt: skip


def heading_solution(error, tau, dt, steps):
    return error * (1 - dt / tau) ** np.arange(steps + 1)


def step_by_step(error, factor, steps):
    return error * float(factor) ** np.arange(steps + 1)


heading_errors = Exercise(
    "heading_errors(error, tau, dt, steps)", solution=heading_solution,
    # settled in one step, a constant oscillation, growing ones, no step; then 30 at random
    cases=lambda rng: [*((1.0, tau, 0.5, 6) for tau in (0.5, 0.25, 0.2, 0.6)), (0.1, 0.6, 0.5, 0), *(
                       (*rng.uniform([-0.3, 0.15, 0.05], [0.3, 1.0, 0.5]), rng.integers(1, 8)) for _ in range(30))],
    worked=(
        ((1.0, 0.5, 0.5, 2), np.array([1.0, 0.0, 0.0])),
        ((1.0, 0.2, 0.5, 2), np.array([1.0, -1.5, 2.25])),
        ((0.4, 1.0, 0.5, 2), np.array([0.4, 0.2, 0.1])),
    ),
    mistakes=(
        Mistake(lambda e, tau, dt, n: e * np.exp(-dt / tau * np.arange(n + 1)),
            "This is the solution in continuous time, where the error always decays. Here the rate is held for a whole "
            "step, so each step subtracts dt/τ times the error.",
            "A simulation computes what the differential equation says."),
        Mistake(lambda e, tau, dt, n: step_by_step(e, 1 + dt / tau, n),
            "Your controller steers away from the goal: the error has to be subtracted.",
            "The rate is proportional to the error, whatever the sign."),
        Mistake(lambda e, tau, dt, n: step_by_step(e, 1 - dt * tau, n),
            "You multiply by τ. A *small* time constant means a fast controller: the rate is error / τ.",
            "τ is the gain."),
        Mistake(lambda e, tau, dt, n: e * (1 - np.arange(n + 1) * dt / tau),
            "You subtract the same amount in each step. Each step subtracts the same *fraction* of the error that is "
            "left.",
            "The heading turns at a constant rate."),
        Mistake(lambda e, tau, dt, n: np.abs(step_by_step(e, 1 - dt / tau, n)),
            "Your error never changes sign. When dt/τ is above 1, each step overshoots, and the sign changes.",
            "An error is a distance."),
    ),
    hints=(
        "In one step the heading turns at the rate error / τ for dt seconds. What is left of the error?",
        "One step: `error - dt / tau * error`, which is `error * (1 - dt / tau)`.",
        "`error * (1 - dt / tau) ** np.arange(steps + 1)`",
    ),
    minutes=6, difficulty=2, equation="ψ̇ = (ψ_wanted - ψ) / τ_heading, in Euler steps of dt",
)  # fmt: skip
