"""Answers to the exercises of the lesson on the road, its actions and its reward."""

import math

import numpy as np

from tests.answers import right, wrong


@right("decode")
def by_a_table(actions):
    turn = math.pi / 50
    table = np.array([(a, s) for a in (-1, 0, 1) for s in (-turn, 0, turn)])
    return table[actions]


@right("decode")
def by_divmod(actions):
    row, column = np.divmod(actions, 3)
    return np.column_stack([row - 1.0, (column - 1.0) * np.pi / 50])


@wrong("decode", "the other way round")
def swapped(actions):
    column, row = np.divmod(actions, 3)
    return np.column_stack([row - 1, (column - 1) * np.pi / 50])


@wrong("decode", "never brake")
def from_zero(actions):
    return np.stack([actions // 3, actions % 3 * np.pi / 50], axis=1)


@wrong("decode", "left and right are swapped")
def left_is_positive(actions):
    return np.stack([actions // 3 - 1, -(actions % 3 - 1) * np.pi / 50], axis=1)


@wrong("decode", "57°")
def without_the_angle(actions):
    return np.stack([actions // 3 - 1, actions % 3 - 1], axis=1)


@wrong("decode", "degrees")
def in_degrees(actions):
    return np.stack([actions // 3 - 1.0, np.degrees((actions % 3 - 1) * np.pi / 50)], axis=1)


@wrong("decode", "shape")
def two_rows(actions):
    return np.array([actions // 3 - 1, (actions % 3 - 1) * np.pi / 50])


@wrong("decode")
def columns_swapped(actions):
    return by_divmod(actions)[:, ::-1].copy()


@wrong("decode", "2 values")
def a_tuple(actions):
    return actions // 3 - 1, (actions % 3 - 1) * np.pi / 50


@right("speed_reward")
def from_below(v_lon):
    if v_lon <= 5:
        return 0.0
    if v_lon <= 12.5:
        return (2 * v_lon - 10) / 75
    if v_lon <= 15:
        return 0.32 * v_lon - 3.8
    return math.exp(-((v_lon - 15) ** 2))


@right("speed_reward")
def by_interpolation(v_lon):
    return float(np.interp(v_lon, [5, 12.5, 15], [0, 0.2, 1]) if v_lon <= 15 else np.exp(-((v_lon - 15) ** 2)))


@wrong("speed_reward", "rising above 15")
def without_an_end(v_lon):
    if v_lon > 12.5:
        return 8 / 25 * v_lon - 19 / 5
    return max(0.0, 2 / 75 * v_lon - 2 / 15)


@wrong("speed_reward", "stays at 1")
def capped(v_lon):
    return float(np.interp(v_lon, [5, 12.5, 15], [0, 0.2, 1]))


@wrong("speed_reward", "negative below 5")
def a_fine_for_slowness(v_lon):
    if v_lon > 15:
        return math.exp(-((v_lon - 15) ** 2))
    return 8 / 25 * v_lon - 19 / 5 if v_lon > 12.5 else 2 / 75 * v_lon - 2 / 15


@wrong("speed_reward", "flat line up to 15")
def only_the_flat_line(v_lon):
    if v_lon > 15:
        return math.exp(-((v_lon - 15) ** 2))
    return max(0.0, 2 / 75 * v_lon - 2 / 15)


@wrong("speed_reward", "squared")
def without_the_square(v_lon):
    return math.exp(-(v_lon - 15)) if v_lon > 15 else from_below(v_lon)


@wrong("speed_reward")
def growing_exponential(v_lon):
    return math.exp((v_lon - 15) ** 2) if v_lon > 15 else from_below(v_lon)


@wrong("speed_reward")
def proportional(v_lon):
    return v_lon / 15


@wrong("speed_reward")
def steep_from_the_start(v_lon):
    return from_below(v_lon) if not 5 < v_lon <= 12.5 else max(0.0, 8 / 25 * v_lon - 19 / 5)


def terms(v_lon, offset, theta):
    return from_below(v_lon), math.exp(-1.5 * offset**2), -abs(math.sin(theta))


@right("reward")
def with_numpy_s_average(v_lon, offset, theta, accident):
    return -10.0 if accident > 0 else float(np.average(terms(v_lon, offset, theta), weights=[1.5, 0.05, 0.05]))


@right("reward")
def term_by_term(v_lon, offset, theta, accident):
    total = 0.0
    for weight, term in zip((1.5, 0.05, 0.05), terms(v_lon, offset, theta), strict=True):
        total += weight / 1.6 * term
    return total if accident == 0 else -10


def summed(v_lon, offset, theta):
    return float(np.dot(terms(v_lon, offset, theta), [1.5, 0.05, 0.05]))


@wrong("reward", "collisions only")
def one_kind_of_accident(v_lon, offset, theta, accident):
    return -10.0 if accident == 1 else summed(v_lon, offset, theta) / 1.6


@wrong("reward", "replaces them")
def fined_on_top(v_lon, offset, theta, accident):
    return summed(v_lon, offset, theta) / 1.6 + (-10 if accident else 0)


@wrong("reward", "weighted mean")
def a_sum(v_lon, offset, theta, accident):
    return -10.0 if accident else summed(v_lon, offset, theta)


@wrong("reward", "pay for steering")
def steering_is_paid(v_lon, offset, theta, accident):
    r_v, r_y, r_theta = terms(v_lon, offset, theta)
    return -10.0 if accident else (1.5 * r_v + 0.05 * r_y - 0.05 * r_theta) / 1.6


@wrong("reward", "to the left is rewarded")
def without_bars(v_lon, offset, theta, accident):
    r_v, r_y, _ = terms(v_lon, offset, theta)
    return -10.0 if accident else (1.5 * r_v + 0.05 * r_y - 0.05 * math.sin(theta)) / 1.6


@wrong("reward")
def ten_for_an_accident(v_lon, offset, theta, accident):
    return 10.0 if accident else summed(v_lon, offset, theta) / 1.6


@wrong("reward")
def divided_by_three(v_lon, offset, theta, accident):
    return -10.0 if accident else summed(v_lon, offset, theta) / 3


@wrong("reward")
def turned(v_lon, offset, theta, accident):
    return summed(v_lon, offset, theta) / 1.6 if accident else -10.0


@right("idle_return")
def by_the_line(speed, seconds):
    return (0.025 * speed - 0.09375) * seconds


@right("idle_return")
def second_by_second(speed, seconds):
    total = 0.0
    for _ in range(seconds):
        total += (1.5 * (2 * speed / 75 - 2 / 15) + 0.05) / 1.6
    return total


@wrong("idle_return", "middle of the lane unpaid")
def speed_alone(speed, seconds):
    return seconds * (1.5 * (2 / 75 * speed - 2 / 15)) / 1.6


@wrong("idle_return", "divide by 1.55")
def two_weights(speed, seconds):
    return seconds * (1.5 * (2 / 75 * speed - 2 / 15) + 0.05) / (1.5 + 0.05)


@wrong("idle_return", "did not divide")
def not_divided(speed, seconds):
    return (1.5 * (2 / 75 * speed - 2 / 15) + 0.05) * seconds


@wrong("idle_return", "one second pays")
def one_second(speed, seconds):
    return 0.025 * speed - 0.09375


@wrong("idle_return", "same weight")
def equal_weights(speed, seconds):
    return (2 / 75 * speed - 2 / 15 + 1 + 0) / 3 * seconds


@wrong("idle_return", "driving straight")
def straight_is_paid(speed, seconds):
    return seconds * (1.5 * (2 / 75 * speed - 2 / 15) + 0.05 + 0.05) / 1.6


@wrong("idle_return")
def the_distance(speed, seconds):
    return speed * seconds


@wrong("idle_return")
def always_the_default(speed, seconds):
    return 23.4375


@right("outcome_rates")
def with_bincount(x_ego, x_trap_1, accident):
    counts = np.bincount(accident, minlength=4)[1:]
    return np.concatenate([[(x_ego > x_trap_1).sum()], counts]) / len(x_ego)


@right("outcome_rates")
def one_by_one(x_ego, x_trap_1, accident):
    found = np.zeros(4)
    for ego, trap, kind in zip(x_ego, x_trap_1, accident, strict=True):
        found[0] += ego > trap
        if kind:
            found[kind] += 1
    return found / len(x_ego)


@wrong("outcome_rates", "crash after overtaking")
def safe_success(x_ego, x_trap_1, accident):
    answer = one_by_one(x_ego, x_trap_1, accident)
    answer[0] = np.mean((x_ego > x_trap_1) & (accident == 0))
    return answer


@wrong("outcome_rates", "'no accident'")
def no_accident_is_success(x_ego, x_trap_1, accident):
    return np.array([np.mean(accident == 0), *(np.mean(accident == kind) for kind in (1, 2, 3))])


@wrong("outcome_rates", "how many")
def counts(x_ego, x_trap_1, accident):
    return one_by_one(x_ego, x_trap_1, accident) * len(accident)


@wrong("outcome_rates", "percentages")
def per_cent(x_ego, x_trap_1, accident):
    return 100 * one_by_one(x_ego, x_trap_1, accident)


@wrong("outcome_rates", "shifted by one")
def from_zero_on(x_ego, x_trap_1, accident):
    return np.array([np.mean(x_ego > x_trap_1), *(np.mean(accident == kind) for kind in range(3))])


@wrong("outcome_rates", "*behind*")
def behind(x_ego, x_trap_1, accident):
    answer = one_by_one(x_ego, x_trap_1, accident)
    answer[0] = np.mean(x_ego < x_trap_1)
    return answer


@wrong("outcome_rates", "shape")
def all_accidents_in_one(x_ego, x_trap_1, accident):
    return np.array([np.mean(x_ego > x_trap_1), np.mean(accident > 0)])


@wrong("outcome_rates")
def beyond_the_start(x_ego, x_trap_1, accident):
    return np.array([np.mean(x_ego > 1500), *(np.mean(accident == kind) for kind in (1, 2, 3))])
