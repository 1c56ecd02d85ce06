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

right_lines("""equilibrium_gap
    solved: (s0 + time_gap * v) * (1 - (v / v_desired) ** delta) ** -0.5
    with numpy's functions: np.polyval([time_gap, s0], v) / np.sqrt(1 - np.power(v / v_desired, delta))
    by bisection: low, high = 0.01, 1e6
        for _ in range(100):
            middle = (low + high) / 2
            if 1 - (v / v_desired) ** delta - ((s0 + time_gap * v) / middle) ** 2 < 0:
                low = middle
            else:
                high = middle
        low
""")

wrong_lines("""equilibrium_gap
    a power goes first: (s0 + time_gap * v) / math.sqrt(1 - v / v_desired**delta)
    delta is four: (s0 + time_gap * v) / math.sqrt(1 - (v / v_desired) ** 4)
    at a standstill: s0
    less the car: solution(v, v_desired, s0, time_gap, delta) - 5
    at the desired speed: (s0 + time_gap * v_desired) / math.sqrt(1 - (v / v_desired) ** delta)
    both roots: np.array([1, -1]) * solution(v, v_desired, s0, time_gap, delta)  # a number
    only the time gap is stretched: s0 + time_gap * v / math.sqrt(1 - (v / v_desired) ** delta)
    without power: (s0 + time_gap * v) / math.sqrt(1 - v / v_desired)
""")

right_lines("""worth_changing
    one expression: others = follower_after - follower_before + old_follower_gain
        follower_after >= -limit and own_gain + politeness * others > threshold
    with steps: total = own_gain
        total += politeness * old_follower_gain
        total -= politeness * (follower_before - follower_after)
        is_safe = not follower_after < -limit
        1 if is_safe and total > threshold else 0
    unsafe is worth nothing:
        gains = np.array([own_gain, follower_after - follower_before, old_follower_gain]) @ [1, politeness, politeness]
        np.where(follower_after + limit >= 0, gains, -np.inf) > threshold
""")

wrong_lines("""worth_changing
    the default's numbers: others = follower_after - follower_before + old_follower_gain
        follower_after >= -2.0 and own_gain + politeness * others > 0.2
    safety turned: others = follower_after - follower_before + old_follower_gain
        follower_after < -limit and own_gain + politeness * others > threshold
    safe or worth it: others = follower_after - follower_before + old_follower_gain
        follower_after >= -limit or own_gain + politeness * others > threshold
    politeness for everything: total = own_gain + follower_after - follower_before + old_follower_gain
        follower_after >= -limit and politeness * total > threshold
    any change is limited: others = follower_after - follower_before + old_follower_gain
        -limit <= follower_after <= limit and own_gain + politeness * others > threshold  # accelerates
    the loss is limited: loss = follower_after - follower_before
        loss >= -limit and own_gain + politeness * (loss + old_follower_gain) > threshold
    weighed against the rest: others = follower_after - follower_before + old_follower_gain
        follower_after >= -limit and (1 - politeness) * own_gain + politeness * others > threshold
    the gain itself: own_gain + politeness * (follower_after - follower_before + old_follower_gain)
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
