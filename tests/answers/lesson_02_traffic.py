"""Answers to the exercises of the lesson on the other cars."""

import math

import numpy as np

from tests.answers import right, wrong


@right("desired_gap")
def three_terms(v, dv, s0, time_gap, a_max, b):
    return s0 + v * time_gap + v * dv / (2 * math.sqrt(a_max * b))


@right("desired_gap")
def factored_out(v, dv, s0, time_gap, a_max, b):
    return s0 + v * (time_gap + 0.5 * dv * (a_max * b) ** -0.5)


@wrong("desired_gap")
def never_negative(v, dv, s0, time_gap, a_max, b):
    return s0 + max(0.0, v * time_gap + v * dv / (2 * math.sqrt(a_max * b)))


@wrong("desired_gap")
def python_reads_from_left_to_right(v, dv, s0, time_gap, a_max, b):
    return s0 + v * time_gap + v * dv / 2 * math.sqrt(a_max * b)


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
def step_after_step(leader, v, gap, dt, *driver):
    if len(leader) == 0:
        return np.array([[gap, v]])
    *others, limit = driver
    a = max(acceleration(v, v - leader[0], gap, *others), -limit)
    rest = step_after_step(leader[1:], max(v + a * dt, 0.0), gap + (leader[0] - v) * dt, dt, *driver)
    return np.vstack([[gap, v], rest])


@wrong("drive_behind", "shape")
def without_its_start(leader, v, gap, dt, *driver):
    return into_an_array(leader, v, gap, dt, *driver)[1:]


@wrong("drive_behind")
def two_rows(leader, v, gap, dt, *driver):
    return into_an_array(leader, v, gap, dt, *driver).T.copy()


@wrong("drive_behind")
def half_a_second(leader, v, gap, dt, *driver):
    return into_an_array(leader, v, gap, 0.5, *driver)


@wrong("drive_behind")
def six_metres_per_second_squared(leader, v, gap, dt, *driver):
    return into_an_array(leader, v, gap, dt, *driver[:-1], 6.0)


@wrong("drive_behind", "NaN")
def divided_by_the_leader(leader, v, gap, dt, *driver):
    return into_an_array(leader, v, gap, dt, *driver) * np.where(leader[0] == leader[0], np.nan, 1)


@wrong("drive_behind")
def the_leader_stands(leader, v, gap, dt, *driver):
    return into_an_array(np.zeros(len(leader)), v, gap, dt, *driver)


@wrong("drive_behind")
def never_brakes(leader, v, gap, dt, *driver):
    return into_an_array(leader, v, gap, dt, *driver[:-1], 0.0)


@right("equilibrium_gap")
def solved(v, v_desired, s0, time_gap, delta):
    return (s0 + time_gap * v) * (1 - (v / v_desired) ** delta) ** -0.5


@right("equilibrium_gap")
def by_bisection(v, v_desired, s0, time_gap, delta):
    low, high = 0.01, 1e6
    for _ in range(100):
        middle = (low + high) / 2
        if 1 - (v / v_desired) ** delta - ((s0 + time_gap * v) / middle) ** 2 < 0:
            low = middle
        else:
            high = middle
    return low


@wrong("equilibrium_gap")
def only_the_time_gap_is_stretched(v, v_desired, s0, time_gap, delta):
    return s0 + time_gap * v / math.sqrt(1 - (v / v_desired) ** delta)


@wrong("equilibrium_gap")
def without_power(v, v_desired, s0, time_gap, delta):
    return (s0 + time_gap * v) / math.sqrt(1 - v / v_desired)


@right("worth_changing")
def one_expression(own_gain, follower_before, follower_after, old_follower_gain, politeness, threshold, limit):
    others = follower_after - follower_before + old_follower_gain
    return follower_after >= -limit and own_gain + politeness * others > threshold


@right("worth_changing")
def with_steps(own_gain, follower_before, follower_after, old_follower_gain, politeness, threshold, limit):
    total = own_gain
    total += politeness * old_follower_gain
    total -= politeness * (follower_before - follower_after)
    is_safe = not follower_after < -limit
    return 1 if is_safe and total > threshold else 0


@right("worth_changing")
def unsafe_is_worth_nothing(own_gain, follower_before, follower_after, old_follower_gain, politeness, threshold, limit):
    gains = np.array([own_gain, follower_after - follower_before, old_follower_gain]) @ [1, politeness, politeness]
    return np.where(follower_after + limit >= 0, gains, -np.inf) > threshold


@wrong("worth_changing")
def the_default_s_numbers(own_gain, follower_before, follower_after, old_follower_gain, politeness, threshold, limit):
    others = follower_after - follower_before + old_follower_gain
    return follower_after >= -2.0 and own_gain + politeness * others > 0.2


@wrong("worth_changing")
def safety_turned(own_gain, follower_before, follower_after, old_follower_gain, politeness, threshold, limit):
    others = follower_after - follower_before + old_follower_gain
    return follower_after < -limit and own_gain + politeness * others > threshold


@wrong("worth_changing")
def safe_or_worth_it(own_gain, follower_before, follower_after, old_follower_gain, politeness, threshold, limit):
    others = follower_after - follower_before + old_follower_gain
    return follower_after >= -limit or own_gain + politeness * others > threshold


@wrong("worth_changing")
def politeness_for_everything(
    own_gain, follower_before, follower_after, old_follower_gain, politeness, threshold, limit
):
    total = own_gain + follower_after - follower_before + old_follower_gain
    return follower_after >= -limit and politeness * total > threshold


@right("heading_errors")
def in_a_loop(error, tau, dt, steps):
    errors = [error]
    for _ in range(steps):
        errors.append(errors[-1] - dt * errors[-1] / tau)
    return np.array(errors)


@right("heading_errors")
def by_a_product(error, tau, dt, steps):
    return np.cumprod([error] + steps * [1 - dt / tau])


@right("heading_errors")
def by_recursion(error, tau, dt, steps):
    rest = by_recursion(error * (tau - dt) / tau, tau, dt, steps - 1) if steps else []
    return np.array([error, *rest])


@wrong("heading_errors")
def at_two_hertz(error, tau, dt, steps):
    return error * (1 - 0.5 / tau) ** np.arange(steps + 1)


@wrong("heading_errors", "shape")
def without_the_start(error, tau, dt, steps):
    return error * (1 - dt / tau) ** np.arange(1, steps + 2)[:steps]


@wrong("heading_errors")
def one_step_ahead(error, tau, dt, steps):
    return error * (1 - dt / tau) ** np.arange(1, steps + 2)


@wrong("heading_errors")
def stops_at_zero(error, tau, dt, steps):
    return error * max(0.0, 1 - dt / tau) ** np.arange(steps + 1)
