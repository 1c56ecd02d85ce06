"""Answers to the exercises of the lesson on the other cars."""

import math

import numpy as np

from tests.answers import right, right_lines, wrong_lines


@right("desired_gap")
def three_terms(v, dv, s0, time_gap, a_max, b):
    return s0 + v * time_gap + v * dv / (2 * math.sqrt(a_max * b))


right_lines("""desired_gap
    with numpy: np.dot([1, v, v * dv], [s0, time_gap, 0.5 / np.sqrt(a_max * b)])
""")

wrong_lines("""desired_gap
    never negative: s0 + max(0.0, v * time_gap + v * dv / (2 * math.sqrt(a_max * b)))  # as some versions of IDM do
    the size of the difference: s0 + v * time_gap + v * abs(dv) / (2 * math.sqrt(a_max * b))
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


DRIVER = "v_desired, s0, time_gap, a_max, b, delta"
wrong_lines(f"""drive_behind
    without its start: solution(leader, v, gap, dt, {DRIVER}, limit)[1:]  # shape
    into whole numbers: solution(leader, v, gap, dt, {DRIVER}, limit).astype(int)
""")

right_lines("""heading_errors
    by a product: np.cumprod([error] + steps * [1 - dt / tau])
    in a loop: errors = [error]
        for _ in range(steps):
            errors.append(errors[-1] - dt * errors[-1] / tau)
        errors
""")


wrong_lines("""heading_errors
    the last one: error * (1 - dt / tau) ** steps  # a NumPy array
""")

wrong_lines("""desired_gap
    capped: min(200.0, solution(v, dv, s0, time_gap, a_max, b))
""")

wrong_lines("""drive_behind
    never touching: states = [(gap, v)]
        for ahead in leader:
            s = s0 + time_gap * v + v * (v - ahead) / (2 * math.sqrt(a_max * b))
            a = max(-limit, a_max * (1 - (v / v_desired) ** delta - (s / gap) ** 2))
            gap, v = max(0.01, gap + (ahead - v) * dt), max(0.0, v + a * dt)
            states.append((gap, v))
        np.array(states)
""")
