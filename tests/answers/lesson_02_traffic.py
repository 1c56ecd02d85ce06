"""Answers to the exercises of the lesson on the other cars."""

import math

import numpy as np

from tests.answers import right, wrong

# desired_gap ----------------------------------------------------------------------------------------


@right("desired_gap")
def three_terms(v, dv, s0, time_gap, a_max, b):
    return s0 + v * time_gap + v * dv / (2 * math.sqrt(a_max * b))


@right("desired_gap")
def factored_out(v, dv, s0, time_gap, a_max, b):
    return s0 + v * (time_gap + 0.5 * dv * (a_max * b) ** -0.5)


@right("desired_gap")
def as_a_sum(v, dv, s0, time_gap, a_max, b):
    return sum([s0, time_gap * v, v * dv / (math.sqrt(4 * a_max * b))])


@right("desired_gap")
def with_numpy(v, dv, s0, time_gap, a_max, b):
    return np.dot([1, v, v * dv], [s0, time_gap, 0.5 / np.sqrt(a_max * b)])


@wrong("desired_gap", "as some versions of IDM do")
def never_negative(v, dv, s0, time_gap, a_max, b):
    return s0 + max(0.0, v * time_gap + v * dv / (2 * math.sqrt(a_max * b)))


@wrong("desired_gap", "parentheses")
def python_reads_from_left_to_right(v, dv, s0, time_gap, a_max, b):
    return s0 + v * time_gap + v * dv / 2 * math.sqrt(a_max * b)


@wrong("desired_gap")
def of_the_scenario(v, dv, s0, time_gap, a_max, b):
    return 10.0 + 1.5 * v + v * dv / (2 * 0.5)


@wrong("desired_gap")
def closing_in_only(v, dv, s0, time_gap, a_max, b):
    return s0 + v * time_gap + max(0.0, v * dv) / (2 * math.sqrt(a_max * b))


@wrong("desired_gap")
def the_size_of_the_difference(v, dv, s0, time_gap, a_max, b):
    return s0 + v * time_gap + v * abs(dv) / (2 * math.sqrt(a_max * b))


@wrong("desired_gap")
def the_mean_of_both(v, dv, s0, time_gap, a_max, b):
    return s0 + v * time_gap + v * dv / (a_max + b)


@wrong("desired_gap")
def the_leader_s_speed(v, dv, s0, time_gap, a_max, b):
    return s0 + (v - dv) * time_gap + v * dv / (2 * math.sqrt(a_max * b))


# drive_behind ---------------------------------------------------------------------------------------


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


@wrong("drive_behind")
def the_next_speed_of_the_leader(leader, v, gap, dt, *driver):
    return into_an_array(np.append(leader[1:], leader[-1]), v, gap, dt, *driver)


@wrong("drive_behind")
def with_the_mean_speed_of_a_step(leader, v, gap, dt, *driver):
    states = into_an_array(leader, v, gap, dt, *driver)
    mean = (states[1:, 1] + states[:-1, 1]) / 2
    states[1:, 0] = gap + np.cumsum(leader - mean) * dt
    return states


@wrong("drive_behind")
def into_whole_numbers(leader, v, gap, dt, *driver):
    return into_an_array(leader, v, gap, dt, *driver).astype(int)


@wrong("drive_behind")
def the_leader_stands(leader, v, gap, dt, *driver):
    return into_an_array(np.zeros(len(leader)), v, gap, dt, *driver)


@wrong("drive_behind")
def never_brakes(leader, v, gap, dt, *driver):
    return into_an_array(leader, v, gap, dt, *driver[:-1], 0.0)


# equilibrium_gap ------------------------------------------------------------------------------------


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


@right("equilibrium_gap")
def with_numpy_s_functions(v, v_desired, s0, time_gap, delta):
    return np.polyval([time_gap, s0], v) / np.sqrt(1 - np.power(v / v_desired, delta))


@wrong("equilibrium_gap")
def a_power_goes_first(v, v_desired, s0, time_gap, delta):
    return (s0 + time_gap * v) / math.sqrt(1 - v / v_desired**delta)


@wrong("equilibrium_gap")
def delta_is_four(v, v_desired, s0, time_gap, delta):
    return (s0 + time_gap * v) / math.sqrt(1 - (v / v_desired) ** 4)


@wrong("equilibrium_gap")
def at_a_standstill(v, v_desired, s0, time_gap, delta):
    return s0


@wrong("equilibrium_gap")
def less_the_car(v, v_desired, s0, time_gap, delta):
    return solved(v, v_desired, s0, time_gap, delta) - 5


@wrong("equilibrium_gap")
def at_the_desired_speed(v, v_desired, s0, time_gap, delta):
    return (s0 + time_gap * v_desired) / math.sqrt(1 - (v / v_desired) ** delta)


@wrong("equilibrium_gap", "a number")
def both_roots(v, v_desired, s0, time_gap, delta):
    return np.array([1, -1]) * solved(v, v_desired, s0, time_gap, delta)


@wrong("equilibrium_gap")
def only_the_time_gap_is_stretched(v, v_desired, s0, time_gap, delta):
    return s0 + time_gap * v / math.sqrt(1 - (v / v_desired) ** delta)


@wrong("equilibrium_gap")
def without_power(v, v_desired, s0, time_gap, delta):
    return (s0 + time_gap * v) / math.sqrt(1 - v / v_desired)


# worth_changing -------------------------------------------------------------------------------------


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


@wrong("worth_changing", "accelerates")
def any_change_is_limited(own_gain, follower_before, follower_after, old_follower_gain, politeness, threshold, limit):
    others = follower_after - follower_before + old_follower_gain
    return -limit <= follower_after <= limit and own_gain + politeness * others > threshold


@wrong("worth_changing")
def the_loss_is_limited(own_gain, follower_before, follower_after, old_follower_gain, politeness, threshold, limit):
    loss = follower_after - follower_before
    return loss >= -limit and own_gain + politeness * (loss + old_follower_gain) > threshold


@wrong("worth_changing")
def weighed_against_the_rest(
    own_gain, follower_before, follower_after, old_follower_gain, politeness, threshold, limit
):
    others = follower_after - follower_before + old_follower_gain
    return follower_after >= -limit and (1 - politeness) * own_gain + politeness * others > threshold


@wrong("worth_changing")
def the_gain_itself(own_gain, follower_before, follower_after, old_follower_gain, politeness, threshold, limit):
    return own_gain + politeness * (follower_after - follower_before + old_follower_gain)


# heading_errors -------------------------------------------------------------------------------------


@right("heading_errors")
def in_a_loop(error, tau, dt, steps):
    errors = [error]
    for _ in range(steps):
        errors.append(errors[-1] - dt * errors[-1] / tau)
    return errors


@right("heading_errors")
def by_a_product(error, tau, dt, steps):
    return np.cumprod([error] + steps * [1 - dt / tau])


@right("heading_errors")
def by_recursion(error, tau, dt, steps):
    rest = by_recursion(error * (tau - dt) / tau, tau, dt, steps - 1) if steps else []
    return np.array([error, *rest])


@wrong("heading_errors", "a NumPy array")
def the_last_one(error, tau, dt, steps):
    return error * (1 - dt / tau) ** steps


@wrong("heading_errors")
def turned_once(error, tau, dt, steps):
    return np.full(steps + 1, error - dt / tau * error)


@wrong("heading_errors")
def the_first_step_is_free(error, tau, dt, steps):
    return error * (1 - dt / tau) ** np.maximum(np.arange(steps + 1) - 1, 0)


@wrong("heading_errors")
def backwards_in_time(error, tau, dt, steps):
    return error / (1 + dt / tau) ** np.arange(steps + 1)


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
