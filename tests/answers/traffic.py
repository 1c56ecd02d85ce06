"""Answers to the exercises of the lesson on the other cars."""

import math

import numpy as np

from tests.answers import right, right_lines, wrong, wrong_lines


@right("desired_gap")
def three_terms(v, dv, s0, time_gap, a_max, b):
    return s0 + v * time_gap + v * dv / (2 * math.sqrt(a_max * b))


right_lines("""desired_gap
    factored out: s0 + v * (time_gap + 0.5 * dv * (a_max * b) ** -0.5)
    as a sum: sum([s0, time_gap * v, v * dv / (math.sqrt(4 * a_max * b))])
    with numpy: np.dot([1, v, v * dv], [s0, time_gap, 0.5 / np.sqrt(a_max * b)])
""")

wrong_lines("""desired_gap
    never negative: s0 + max(0.0, v * time_gap + v * dv / (2 * math.sqrt(a_max * b)))  # as some versions of IDM do
    python reads from left to right: s0 + v * time_gap + v * dv / 2 * math.sqrt(a_max * b)  # parentheses
    of the scenario: 10.0 + 1.5 * v + v * dv / (2 * 0.5)
    closing in only: s0 + v * time_gap + max(0.0, v * dv) / (2 * math.sqrt(a_max * b))
    the size of the difference: s0 + v * time_gap + v * abs(dv) / (2 * math.sqrt(a_max * b))
    the mean of both: s0 + v * time_gap + v * dv / (a_max + b)
    the leader's speed: s0 + (v - dv) * time_gap + v * dv / (2 * math.sqrt(a_max * b))
""")


def acceleration(v, dv, gap, v_desired, s0, time_gap, a_max, b, delta):
    return a_max * (1 - (v / v_desired) ** delta - (three_terms(v, dv, s0, time_gap, a_max, b) / gap) ** 2)


@right("drive_behind")
def with_places(leader, v, gap, dt, *driver):
    *driver, limit = driver
    mine, theirs, states = 0.0, gap, [[gap, v]]
    for v_leader in leader:
        a = np.clip(acceleration(v, v - v_leader, theirs - mine, *driver), -limit, None)
        mine, theirs = mine + v * dt, theirs + v_leader * dt
        v = v + a * dt if v + a * dt > 0 else 0.0
        states.append([theirs - mine, v])
    return np.asarray(states)


@right("drive_behind")
def into_an_array(leader, v, gap, dt, *driver):
    found = np.zeros((len(leader) + 1, 2))
    found[0] = gap, v
    for k in range(len(leader)):
        gap, v = found[k]
        a = max(-driver[-1], acceleration(v, v - leader[k], gap, *driver[:-1]))
        found[k + 1] = gap - (v - leader[k]) * dt, max(0, v + dt * a)
    return found


@right("drive_behind")
def as_lists(leader, v, gap, dt, *driver):
    gaps, speeds = [gap], [v]
    for u in leader.tolist():
        a = max(-driver[-1], acceleration(speeds[-1], speeds[-1] - u, gaps[-1], *driver[:-1]))
        gaps.append(gaps[-1] + dt * (u - speeds[-1]))
        speeds.append(max(0.0, speeds[-1] + dt * a))
    return [list(state) for state in zip(gaps, speeds, strict=True)]


@wrong("drive_behind", "*new* gap")
def moves_first(leader, v, gap, dt, *driver):
    states = [(gap, v)]
    for u in leader:
        gap += (u - v) * dt
        v = max(v + max(acceleration(v, v - u, gap, *driver[:-1]), -driver[-1]) * dt, 0.0)
        states.append((gap, v))
    return np.array(states)


@wrong("drive_behind", "for braking")
def clipped_on_both_sides(leader, v, gap, dt, *driver):
    states = [(gap, v)]
    for u in leader:
        a = np.clip(acceleration(v, v - u, gap, *driver[:-1]), -driver[-1], driver[-1])
        gap, v = gap + (u - v) * dt, max(v + a * dt, 0.0)
        states.append((gap, v))
    return np.array(states)


DRIVER = "v_desired, s0, time_gap, a_max, b, delta"
wrong_lines(f"""drive_behind
    without its start: solution(leader, v, gap, dt, {DRIVER}, limit)[1:]  # shape
    two rows: solution(leader, v, gap, dt, {DRIVER}, limit).T.copy()
    half a second: solution(leader, v, gap, 0.5, {DRIVER}, limit)
    six metres per second squared: solution(leader, v, gap, dt, {DRIVER}, 6.0)
    never brakes: solution(leader, v, gap, dt, {DRIVER}, 0.0)
    not a number: solution(leader, v, gap, dt, {DRIVER}, limit) * np.nan  # NaN
    into whole numbers: solution(leader, v, gap, dt, {DRIVER}, limit).astype(int)
    the next speed of the leader: solution(np.append(leader[1:], leader[-1]), v, gap, dt, {DRIVER}, limit)
    the leader stands: solution(0 * leader, v, gap, dt, {DRIVER}, limit)
    with the mean speed of a step: states = solution(leader, v, gap, dt, {DRIVER}, limit)
        mean = (states[1:, 1] + states[:-1, 1]) / 2
        states[1:, 0] = gap + np.cumsum(leader - mean) * dt
        states
""")

right_lines("""heading_errors
    by a product: np.cumprod([error] + steps * [1 - dt / tau])
    in a loop: errors = [error]
        for _ in range(steps):
            errors.append(errors[-1] - dt * errors[-1] / tau)
        errors
""")


@right("heading_errors")
def by_recursion(error, tau, dt, steps):
    rest = by_recursion(error * (tau - dt) / tau, tau, dt, steps - 1) if steps else []
    return np.array([error, *rest])


wrong_lines("""heading_errors
    the last one: error * (1 - dt / tau) ** steps  # a NumPy array
    turned once: np.full(steps + 1, error - dt / tau * error)
    the first step is free: error * (1 - dt / tau) ** np.maximum(np.arange(steps + 1) - 1, 0)
    backwards in time: error / (1 + dt / tau) ** np.arange(steps + 1)
    at two hertz: error * (1 - 0.5 / tau) ** np.arange(steps + 1)
    without the start: error * (1 - dt / tau) ** np.arange(1, steps + 2)[:steps]  # shape
    one step ahead: error * (1 - dt / tau) ** np.arange(1, steps + 2)
    stops at zero: error * max(0.0, 1 - dt / tau) ** np.arange(steps + 1)
""")
