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


@right("idm_acceleration")
def as_printed(v, v_desired, gap, s_star, a_max, delta):
    return a_max * (1 - (v / v_desired) ** delta - (s_star / gap) ** 2)


@right("idm_acceleration")
def in_two_parts(v, v_desired, gap, s_star, a_max, delta):
    free_road = a_max - a_max * pow(v / v_desired, delta)
    braking = 0.0 if math.isinf(gap) else a_max * s_star**2 / gap**2
    return free_road - braking


@wrong("idm_acceleration")
def on_a_free_road_only(v, v_desired, gap, s_star, a_max, delta):
    return a_max * (1 - (v / v_desired) ** delta)


@wrong("idm_acceleration")
def delta_everywhere(v, v_desired, gap, s_star, a_max, delta):
    return a_max * (1 - (v / v_desired) ** delta - (s_star / gap) ** delta)


@wrong("idm_acceleration")
def never_brakes(v, v_desired, gap, s_star, a_max, delta):
    return max(0.0, as_printed(v, v_desired, gap, s_star, a_max, delta))


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


@wrong("heading_errors", "shape")
def without_the_start(error, tau, dt, steps):
    return error * (1 - dt / tau) ** np.arange(1, steps + 2)[:steps]


@wrong("heading_errors")
def one_step_ahead(error, tau, dt, steps):
    return error * (1 - dt / tau) ** np.arange(1, steps + 2)


@wrong("heading_errors")
def stops_at_zero(error, tau, dt, steps):
    return error * max(0.0, 1 - dt / tau) ** np.arange(steps + 1)
