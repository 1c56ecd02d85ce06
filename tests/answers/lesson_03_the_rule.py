"""Answers to the exercises of the lesson on the rule controller."""

import numpy as np
import torch

from tests.answers import equivalent, right, wrong

equivalent("target_speed", "range(1, n)  ->  range(0, n)", "the slowest speed is v_min, which is taken anyway")
for _after in ("pass", "p", "check_p(0.9)"):
    equivalent("stochastic_rule", f"check_p(p)  ->  {_after}", "the exercise gives no p outside [1/9, 1)")
equivalent("stochastic_rule", "rule_actions = np.asarray(rule_actions)  ->  pass", "the exercise gives an array")

# safety_distance ------------------------------------------------------------------------------------


@right("safety_distance")
def in_one_line(v_ego, v_current, v_new, t_safe, floor):
    return max(floor, (v_ego - min(v_current, v_new)) * t_safe)


@right("safety_distance")
def the_longer_of_two(v_ego, v_current, v_new, t_safe, floor):
    distance = max((v_ego - v_current) * t_safe, (v_ego - v_new) * t_safe)
    if distance < floor:
        return floor
    return distance


@right("safety_distance")
def with_numpy(v_ego, v_current, v_new, t_safe, floor):
    return np.maximum(floor, t_safe * np.subtract(v_ego, [v_current, v_new]).max())


@right("safety_distance")
def for_each_car(v_ego, v_current, v_new, t_safe, floor):
    return max([floor] + [t_safe * (v_ego - v) for v in (v_current, v_new)])


@wrong("safety_distance", "absolute value")
def how_far_they_drift_apart(v_ego, v_current, v_new, t_safe, floor):
    drift = (v_ego - min(v_current, v_new)) * t_safe
    return drift if drift > floor else max(floor, -drift)


@wrong("safety_distance")
def the_scenario_s_numbers(v_ego, v_current, v_new, t_safe, floor):
    return max(3.0, (v_ego - min(v_current, v_new)) * 1.5)


@wrong("safety_distance")
def the_floor_for_equal_speeds_only(v_ego, v_current, v_new, t_safe, floor):
    distance = (v_ego - min(v_current, v_new)) * t_safe
    return distance if distance > 0 else floor


@wrong("safety_distance")
def the_mean_of_both_cars(v_ego, v_current, v_new, t_safe, floor):
    return max(floor, (v_ego - (v_current + v_new) / 2) * t_safe)


@wrong("safety_distance")
def the_own_lane(v_ego, v_current, v_new, t_safe, floor):
    return max(floor, (v_ego - v_current) * t_safe)


@wrong("safety_distance")
def the_whole_way(v_ego, v_current, v_new, t_safe, floor):
    return max(floor, v_ego * t_safe)


@wrong("safety_distance")
def without_the_time(v_ego, v_current, v_new, t_safe, floor):
    return max(floor, v_ego - min(v_current, v_new))


@wrong("safety_distance")
def the_floor_above(v_ego, v_current, v_new, t_safe, floor):
    return min(floor, (v_ego - min(v_current, v_new)) * t_safe)


@wrong("safety_distance")
def zero_for_the_floor(v_ego, v_current, v_new, t_safe, floor):
    return max(0.0, (v_ego - min(v_current, v_new)) * t_safe)


# target_speed ---------------------------------------------------------------------------------------


@right("target_speed")
def by_a_list(v_current, v_new, v_min, v_max, n):
    return max([v for v in np.linspace(v_min, v_max, n) if v < v_current and v < v_new], default=v_min)


@right("target_speed")
def counted_down(v_current, v_new, v_min, v_max, n):
    step = (v_max - v_min) / (n - 1)
    for i in reversed(range(n)):
        if v_min + i * step < min(v_current, v_new):
            return v_min + i * step
    return v_min


@right("target_speed")
def by_a_mask(v_current, v_new, v_min, v_max, n):
    grid = np.linspace(v_min, v_max, n)
    slow = (grid < v_current) & (grid < v_new)
    return np.max(grid, where=slow, initial=v_min)


@right("target_speed")
def by_searching_the_sorted_grid(v_current, v_new, v_min, v_max, n):
    grid = torch.linspace(v_min, v_max, n, dtype=torch.float64)
    place = torch.searchsorted(grid, torch.tensor(min(v_current, v_new), dtype=torch.float64)).item()
    return grid[max(place - 1, 0)]


@wrong("target_speed", "new lane only")
def slower_than_the_new_car(v_current, v_new, v_min, v_max, n):
    return max([v for v in np.linspace(v_min, v_max, n) if v < v_new], default=v_min)


@wrong("target_speed")
def equal_in_the_new_lane(v_current, v_new, v_min, v_max, n):
    return max([v for v in np.linspace(v_min, v_max, n) if v < v_current and v <= v_new], default=v_min)


@wrong("target_speed")
def five_speeds(v_current, v_new, v_min, v_max, n):
    return max([v for v in np.linspace(v_min, v_max, 5) if v < min(v_current, v_new)], default=v_min)


@wrong("target_speed")
def without_the_fastest(v_current, v_new, v_min, v_max, n):
    return max([v for v in np.linspace(v_min, v_max, n)[:-1] if v < min(v_current, v_new)], default=v_min)


@wrong("target_speed")
def its_number(v_current, v_new, v_min, v_max, n):
    return int(np.sum(np.linspace(v_min, v_max, n) < min(v_current, v_new)))


@wrong("target_speed", "has to be *slower*")
def equal_is_allowed(v_current, v_new, v_min, v_max, n):
    return max([v for v in np.linspace(v_min, v_max, n) if v <= min(v_current, v_new)], default=v_min)


@wrong("target_speed", "own lane only")
def own_lane(v_current, v_new, v_min, v_max, n):
    return max([v for v in np.linspace(v_min, v_max, n) if v < v_current], default=v_min)


@wrong("target_speed", "slower than *both*")
def than_the_faster(v_current, v_new, v_min, v_max, n):
    return max([v for v in np.linspace(v_min, v_max, n) if v < max(v_current, v_new)], default=v_min)


@wrong("target_speed", "the slowest of the speeds")
def the_slowest(v_current, v_new, v_min, v_max, n):
    return min([v for v in np.linspace(v_min, v_max, n) if v < min(v_current, v_new)], default=v_min)


@wrong("target_speed", "n - 1 steps")
def n_steps(v_current, v_new, v_min, v_max, n):
    grid = [v_min + i / n * (v_max - v_min) for i in range(n)]
    return max([v for v in grid if v < min(v_current, v_new)], default=v_min)


@wrong("target_speed", "NaN")
def nothing_is_left(v_current, v_new, v_min, v_max, n):
    return max([v for v in np.linspace(v_min, v_max, n) if v < min(v_current, v_new)], default=np.nan)


@wrong("target_speed", "raises an error")
def without_a_default(v_current, v_new, v_min, v_max, n):
    return max([v for v in np.linspace(v_min, v_max, n) if v < min(v_current, v_new)])


@wrong("target_speed")
def the_nearest(v_current, v_new, v_min, v_max, n):
    grid = np.linspace(v_min, v_max, n)
    return grid[np.argmin(abs(grid - min(v_current, v_new, 1e6)))]


# room_to_change -------------------------------------------------------------------------------------


@right("room_to_change")
def two_questions(dx_front, dx_rear, length, d_s, v_ego, v_rear, t_safe, floor):
    if dx_front - length <= d_s:
        return False
    if dx_rear - length <= floor:
        return False
    return dx_rear - length > (v_rear - v_ego) * t_safe


@right("room_to_change")
def lengths_on_the_other_side(dx_front, dx_rear, length, d_s, v_ego, v_rear, t_safe, floor):
    behind = (v_rear - v_ego) * t_safe
    return int(dx_front > d_s + length) * int(dx_rear > (behind if behind > floor else floor) + length)


@right("room_to_change")
def by_the_shorter_margin(dx_front, dx_rear, length, d_s, v_ego, v_rear, t_safe, floor):
    behind = max(floor, (v_rear - v_ego) * t_safe)
    return min(dx_front - d_s, dx_rear - behind) > length


@wrong("room_to_change")
def our_own_numbers(dx_front, dx_rear, length, d_s, v_ego, v_rear, t_safe, floor):
    return dx_front - 5 > d_s and dx_rear - 5 > max(3.0, (v_rear - v_ego) * 1.5)


@wrong("room_to_change")
def the_same_distance_behind(dx_front, dx_rear, length, d_s, v_ego, v_rear, t_safe, floor):
    return dx_front - length > d_s and dx_rear - length > d_s


@wrong("room_to_change", "half a length")
def half_a_length(dx_front, dx_rear, length, d_s, v_ego, v_rear, t_safe, floor):
    half = length / 2
    return dx_front - half > d_s and dx_rear - half > max(floor, (v_rear - v_ego) * t_safe)


@wrong("room_to_change")
def the_floor_and_the_closing_distance(dx_front, dx_rear, length, d_s, v_ego, v_rear, t_safe, floor):
    return dx_front - length > d_s and dx_rear - length > floor + max(0.0, (v_rear - v_ego) * t_safe)


@wrong("room_to_change")
def a_slower_car_behind_does_not_count(dx_front, dx_rear, length, d_s, v_ego, v_rear, t_safe, floor):
    behind = v_rear <= v_ego or dx_rear - length > max(floor, (v_rear - v_ego) * t_safe)
    return dx_front - length > d_s and behind


@wrong("room_to_change")
def a_length_ahead_only(dx_front, dx_rear, length, d_s, v_ego, v_rear, t_safe, floor):
    return dx_front - length > d_s and dx_rear > max(floor, (v_rear - v_ego) * t_safe)


@wrong("room_to_change")
def always(dx_front, dx_rear, length, d_s, v_ego, v_rear, t_safe, floor):
    return True


@wrong("room_to_change", "a number")
def both_answers(dx_front, dx_rear, length, d_s, v_ego, v_rear, t_safe, floor):
    return dx_front - length > d_s, dx_rear - length > max(floor, (v_rear - v_ego) * t_safe)


# best_first_step ------------------------------------------------------------------------------------


@right("best_first_step")
def unravelled(costs):
    return np.unravel_index(np.argmin(costs), costs.shape)[0]


@right("best_first_step")
def row_by_row(costs):
    best = [min(cost for second in first for cost in second) for first in costs]
    return best.index(min(best))


@right("best_first_step")
def with_torch(costs):
    return torch.from_numpy(costs).amin(dim=(1, 2)).argmin()


@right("best_first_step")
def nine_plans_each(costs):
    return int(np.argmin(costs)) // 9


@wrong("best_first_step")
def greedy(costs):
    return costs[:, 0, 0].argmin()


@wrong("best_first_step", "only its first step")
def the_best_of_27(costs):
    return min(range(27), key=lambda plan: costs.flat[plan])


@wrong("best_first_step")
def the_remainder(costs):
    return costs.argmin() % 9 // 3


@wrong("best_first_step")
def right_in_the_examples(costs):
    return 2 if costs[2, 0, 1] == 1.0 else 0


@wrong("best_first_step", "a number")
def the_whole_plan(costs):
    return np.unravel_index(costs.argmin(), costs.shape)


@wrong("best_first_step")
def the_lowest_cost(costs):
    return costs.min()


@wrong("best_first_step")
def the_middle_step(costs):
    return costs.min(axis=(0, 2)).argmin()


@wrong("best_first_step")
def counted_from_minus_one(costs):
    return costs.min(axis=(1, 2)).argmin() - 1


@wrong("best_first_step", "a number")
def the_three_costs(costs):
    return costs.min(axis=(1, 2))


# stochastic_rule ------------------------------------------------------------------------------------


@right("stochastic_rule")
def filled(rule_actions, p):
    pi = np.full((len(rule_actions), 9), (1 - p) / 8)
    pi[np.arange(len(rule_actions)), rule_actions] = p
    return pi


@right("stochastic_rule")
def with_an_identity(rule_actions, p):
    own = np.eye(9)[rule_actions]
    return p * own + (1 - p) / 8 * (1 - own)


@right("stochastic_rule")
def row_by_row_in_lists(rule_actions, p):
    return [[p if a == own else (1 - p) / 8 for a in range(9)] for own in rule_actions]


@right("stochastic_rule")
def one_hot(rule_actions, p):
    own = torch.nn.functional.one_hot(torch.from_numpy(rule_actions), 9)
    return torch.where(own == 1, p, (1 - p) / 8)


@wrong("stochastic_rule", "*every* row")
def columns_of_all_rows(rule_actions, p):
    pi = np.full((len(rule_actions), 9), (1 - p) / 8)
    pi[:, rule_actions] = p
    return pi


@wrong("stochastic_rule")
def nine_tenths(rule_actions, p):
    return filled(rule_actions, 0.9)


@wrong("stochastic_rule")
def counted_from_one(rule_actions, p):
    return filled((rule_actions - 1) % 9, p)


@wrong("stochastic_rule")
def into_whole_numbers(rule_actions, p):
    return filled(rule_actions, p).astype(int)


@wrong("stochastic_rule", "shape")
def the_first_state_only(rule_actions, p):
    return filled(rule_actions, p)[0]


@wrong("stochastic_rule")
def deterministic(rule_actions, p):
    return np.eye(9)[rule_actions]


@wrong("stochastic_rule", "shape")
def states_in_columns(rule_actions, p):
    return filled(rule_actions, p).T.copy()


@wrong("stochastic_rule")
def logarithms(rule_actions, p):
    return np.log(filled(rule_actions, p))


# direct_plan ----------------------------------------------------------------------------------------


@right("direct_plan")
def second_by_second():
    words = {"l": "keep left", "r": "keep right", "a": "accelerate straight"}
    return [words[letter] for letter in "llrlrrrlaaaaa"]


@right("direct_plan")
def a_tuple_of_pairs():
    left, right = "keep left", "keep right"
    return ((left, 2), (right, 1), (left, 1), (right, 3), (left, 1), ("accelerate straight", 8))


@right("direct_plan")
def idle_at_the_end():
    return [*second_by_second(), ("keep straight", 30)]


@wrong("direct_plan", "brake")
def the_rule_s_way():
    return [("brake straight", 2), ("keep straight", 4), ("keep left", 2), ("keep right", 2), ("keep left", 2)]


@wrong("direct_plan")
def around_trap_2():
    return [("keep left", 2), ("keep right", 3), ("accelerate straight", 5)]


@wrong("direct_plan", "off the road")
def to_the_right():
    return [("keep right", 3)]


@wrong("direct_plan", "ahead of trap 1")
def stay():
    return [("keep straight", 10)]


@wrong("direct_plan", "Your plan cannot be driven: Action 'keep lft' is unknown: did you mean 'keep left'?")
def misspelt():
    return [("keep lft", 2)]


@wrong("direct_plan", "returns a NumPy array: the exercise asks for a list of actions in words")
def numbers():
    return np.array([3, 3, 5, 3, 5, 5, 5, 3])


@wrong("direct_plan", "Your plan cannot be driven: each of its parts")
def numbers_in_a_list():
    return [3, 3, 5, 3, 5, 5, 5, 3]


@wrong("direct_plan", "ahead of trap 1")
def nothing_at_all():
    return []
