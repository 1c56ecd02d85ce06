"""Answers to the exercises of the lesson on the road, its actions and its reward."""

import math

import numpy as np
import torch

from tests.answers import equivalent, right, wrong

STRAIGHT = "it drives straight, so r_theta is 0"
for _before, _after in (
    (
        "seconds * (1.5 * r_v + 0.05 * r_y + 0.05 * r_theta)",
        "seconds * (1.5 * r_v + 0.05 * r_y - 0.05 * r_theta)",
    ),
    ("0.05 * r_theta", "-0.05 * r_theta"),
    ("0.05 * r_theta", "0.0505 * r_theta"),
    ("0.05 * r_theta", "0.15000000000000002 * r_theta"),
):
    equivalent("idle_return", f"{_before}  ->  {_after}", STRAIGHT)
equivalent("idle_return", "1.5 * r_v + 0.05 * r_y  ->  1.5 * r_v + 0.05 / r_y", "it is centred, so r_y is 1")
BOTH = "the formula gives the same there"
equivalent("bearable_risk", "if escape <= stay:  ->  if escape < stay:", BOTH)
equivalent("bearable_risk", "if crash >= stay:  ->  if crash > stay:", BOTH)

# decode ---------------------------------------------------------------------------------------------


@right("decode")
def by_a_table(actions):
    turn = math.pi / 50
    table = np.array([(a, s) for a in (-1, 0, 1) for s in (-turn, 0, turn)])
    return table[actions]


@right("decode")
def by_divmod(actions):
    row, column = np.divmod(actions, 3)
    return np.column_stack([row - 1.0, (column - 1.0) * np.pi / 50])


@right("decode")
def one_by_one(actions):
    return [(a // 3 - 1, (a - 3 * (a // 3) - 1) * 0.02 * math.pi) for a in actions.tolist()]


@right("decode")
def with_torch(actions):
    row = torch.from_numpy(actions).div(3, rounding_mode="floor")
    column = torch.from_numpy(actions).remainder(3)
    return torch.stack([row - 1, (column - 1) * torch.pi / 50], dim=1)


@wrong("decode", "whole numbers")
def into_whole_numbers(actions):
    found = np.zeros((len(actions), 2), dtype=int)
    found[:, 0] = actions // 3 - 1
    found[:, 1] = (actions % 3 - 1) * np.pi / 50
    return found


@wrong("decode")
def the_three_of_the_example(actions):
    known = {0: (-1, -np.pi / 50), 4: (0, 0), 8: (1, np.pi / 50)}
    return np.array([known.get(a, (0, 0)) for a in actions.tolist()])


@wrong("decode")
def divided_as_floats(actions):
    return np.column_stack([actions / 3 - 1, (actions % 3 - 1) * np.pi / 50])


@wrong("decode")
def rows_of_two(actions):
    return np.column_stack([actions // 2 - 1, (actions % 3 - 1) * np.pi / 50])


@wrong("decode")
def rounded_angle(actions):
    return np.column_stack([actions // 3 - 1, (actions % 3 - 1) * 0.06])


@wrong("decode", "shape")
def two_rows(actions):
    return np.array([actions // 3 - 1, (actions % 3 - 1) * np.pi / 50])


@wrong("decode")
def columns_swapped(actions):
    return by_divmod(actions)[:, ::-1].copy()


@wrong("decode", "has shape (2, 3)")
def a_tuple(actions):
    return actions // 3 - 1, (actions % 3 - 1) * np.pi / 50


# reward ---------------------------------------------------------------------------------------------


def speed_term(v_lon):
    if v_lon <= 5:
        return 0.0
    if v_lon <= 12.5:
        return (2 * v_lon - 10) / 75
    if v_lon <= 15:
        return 0.32 * v_lon - 3.8
    return math.exp(-((v_lon - 15) ** 2))


def terms(v_lon, offset, theta):
    return speed_term(v_lon), math.exp(-1.5 * offset**2), -abs(math.sin(theta))


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


@right("reward")
def penalty_last(v_lon, offset, theta, accident):
    mean = (30 * speed_term(v_lon) + math.exp(-1.5 * offset**2) - abs(math.sin(theta))) / 32
    return np.float64(mean if not accident else -10)


@wrong("reward")
def the_angle_itself(v_lon, offset, theta, accident):
    mean = (1.5 * speed_term(v_lon) + 0.05 * math.exp(-1.5 * offset**2) - 0.05 * abs(theta)) / 1.6
    return -10.0 if accident else mean


@wrong("reward")
def departures_are_free(v_lon, offset, theta, accident):
    return -10.0 if accident in (1, 3) else summed(v_lon, offset, theta) / 1.6


@wrong("reward")
def squared_steering(v_lon, offset, theta, accident):
    mean = (1.5 * speed_term(v_lon) + 0.05 * math.exp(-1.5 * offset**2) - 0.05 * math.sin(theta) ** 2) / 1.6
    return -10.0 if accident else mean


@wrong("reward")
def the_line_goes_on_below_five(v_lon, offset, theta, accident):
    r_v = speed_term(v_lon) if v_lon > 5 else (2 * v_lon - 10) / 75
    mean = (1.5 * r_v + 0.05 * math.exp(-1.5 * offset**2) - 0.05 * abs(math.sin(theta))) / 1.6
    return -10.0 if accident else mean


@wrong("reward")
def no_reward_for_too_fast(v_lon, offset, theta, accident):
    return -10.0 if accident else summed(v_lon if v_lon <= 15 else 0.0, offset, theta) / 1.6


# idle_return ----------------------------------------------------------------------------------------


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


@right("idle_return")
def with_the_terms_in_a_row(speed, seconds):
    return float(np.dot([1.5, 0.05, 0.05], [(speed - 5) / 37.5, 1, 0]) / 1.6 * seconds)


@wrong("idle_return")
def one_second_short(speed, seconds):
    return by_the_line(speed, seconds - 1)


@wrong("idle_return")
def discounted(speed, seconds):
    return sum(0.8**t * by_the_line(speed, 1) for t in range(seconds))


@wrong("idle_return")
def the_rewards_of_all_seconds(speed, seconds):
    return np.full(seconds, by_the_line(speed, 1))


@wrong("idle_return")
def with_the_steep_line(speed, seconds):
    return (1.5 * (8 / 25 * speed - 19 / 5) + 0.05) / 1.6 * seconds


# bearable_risk --------------------------------------------------------------------------------------


@right("bearable_risk")
def clipped(stay, escape, crash):
    return (
        float(np.clip((escape - stay) / (escape - crash), 0, 1)) if escape > max(stay, crash) else float(crash > stay)
    )


@right("bearable_risk")
def from_the_share_that_must_succeed(stay, escape, crash):
    if escape <= stay:
        return 0
    return 1 - max(0.0, (stay - crash) / (escape - crash))


@right("bearable_risk")
def by_bisection(stay, escape, crash):
    if escape <= stay:
        return 0.0
    low, high = 0.0, 1.0
    for _ in range(60):
        middle = (low + high) / 2
        low, high = (middle, high) if (1 - middle) * escape + middle * crash > stay else (low, middle)
    return low


@wrong("bearable_risk")
def in_per_cent(stay, escape, crash):
    return 100 * clipped(stay, escape, crash)


@wrong("bearable_risk")
def always_the_rule_s(stay, escape, crash):
    return 0.4556


@wrong("bearable_risk")
def a_crash_costs_ten(stay, escape, crash):
    return clipped(stay, escape, -10.0)


@wrong("bearable_risk")
def a_verdict(stay, escape, crash):
    return escape > stay


@wrong("bearable_risk")
def at_least_one_per_cent(stay, escape, crash):
    return max(0.01, clipped(stay, escape, crash))


@wrong("bearable_risk")
def no_more_than_nine_in_ten(stay, escape, crash):
    return clipped(stay, escape, crash) if crash >= stay else min(0.9, clipped(stay, escape, crash))


@wrong("bearable_risk")
def signs_are_dropped(stay, escape, crash):
    return float(np.clip((escape - stay) / (abs(escape) + abs(crash)), 0, 1))


# outcome_rates --------------------------------------------------------------------------------------


@right("outcome_rates")
def with_bincount(x_ego, x_trap_1, accident):
    counts = np.bincount(accident, minlength=4)[1:]
    return np.concatenate([[(x_ego > x_trap_1).sum()], counts]) / len(x_ego)


@right("outcome_rates")
def episode_by_episode(x_ego, x_trap_1, accident):
    found = np.zeros(4)
    for ego, trap, kind in zip(x_ego, x_trap_1, accident, strict=True):
        found[0] += ego > trap
        if kind:
            found[kind] += 1
    return found / len(x_ego)


@right("outcome_rates")
def from_lists(x_ego, x_trap_1, accident):
    success = [ego > trap for ego, trap in zip(x_ego.tolist(), x_trap_1.tolist(), strict=True)]
    kinds = accident.tolist()
    return [count / len(kinds) for count in (sum(success), kinds.count(1), kinds.count(2), kinds.count(3))]


@wrong("outcome_rates", "'no accident'")
def no_accident_is_success(x_ego, x_trap_1, accident):
    return np.array([np.mean(accident == 0), *(np.mean(accident == kind) for kind in (1, 2, 3))])


@wrong("outcome_rates", "shifted by one")
def from_zero_on(x_ego, x_trap_1, accident):
    return np.array([np.mean(x_ego > x_trap_1), *(np.mean(accident == kind) for kind in range(3))])


@right("outcome_rates")
def with_torch_s_mean(x_ego, x_trap_1, accident):
    ahead, kind = torch.tensor(x_ego > x_trap_1), torch.tensor(accident)
    return torch.stack([ahead.double().mean(), *((kind == k).double().mean() for k in (1, 2, 3))])


@wrong("outcome_rates", "number of accidents")
def shares_of_the_accidents(x_ego, x_trap_1, accident):
    counts = np.bincount(accident, minlength=4)[1:]
    return np.array([np.mean(x_ego > x_trap_1), *counts / max(counts.sum(), 1)])


@wrong("outcome_rates")
def into_whole_numbers_too(x_ego, x_trap_1, accident):
    found = np.zeros(4, dtype=int)
    found[:] = with_bincount(x_ego, x_trap_1, accident)
    return found


@wrong("outcome_rates")
def one_episode_too_few(x_ego, x_trap_1, accident):
    return with_bincount(x_ego, x_trap_1, accident) * len(x_ego) / max(1, len(x_ego) - 1)


@wrong("outcome_rates", "shape")
def for_each_episode(x_ego, x_trap_1, accident):
    return np.stack([x_ego > x_trap_1, *(accident == kind for kind in (1, 2, 3))]).astype(float)


@wrong("outcome_rates", "shape")
def all_accidents_in_one(x_ego, x_trap_1, accident):
    return np.array([np.mean(x_ego > x_trap_1), np.mean(accident > 0)])


@wrong("outcome_rates")
def beyond_the_start(x_ego, x_trap_1, accident):
    return np.array([np.mean(x_ego > 1500), *(np.mean(accident == kind) for kind in (1, 2, 3))])
