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


@wrong("decode", "shape")
def two_rows(actions):
    return np.array([actions // 3 - 1, (actions % 3 - 1) * np.pi / 50])


@wrong("decode")
def columns_swapped(actions):
    return by_divmod(actions)[:, ::-1].copy()


@wrong("decode", "shape")
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


@wrong("outcome_rates", "'no accident'")
def no_accident_is_success(x_ego, x_trap_1, accident):
    return np.array([np.mean(accident == 0), *(np.mean(accident == kind) for kind in (1, 2, 3))])


@wrong("outcome_rates", "shifted by one")
def from_zero_on(x_ego, x_trap_1, accident):
    return np.array([np.mean(x_ego > x_trap_1), *(np.mean(accident == kind) for kind in range(3))])


@wrong("outcome_rates", "shape")
def all_accidents_in_one(x_ego, x_trap_1, accident):
    return np.array([np.mean(x_ego > x_trap_1), np.mean(accident > 0)])


@wrong("outcome_rates")
def beyond_the_start(x_ego, x_trap_1, accident):
    return np.array([np.mean(x_ego > 1500), *(np.mean(accident == kind) for kind in (1, 2, 3))])
