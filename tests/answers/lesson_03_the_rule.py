"""Answers to the exercises of the lesson on the rule controller."""

from tests.answers import right, wrong


@right("safety_distance")
def in_one_line(v_ego, v_current, v_new, t_safe, floor):
    return max(floor, (v_ego - min(v_current, v_new)) * t_safe)


@right("safety_distance")
def the_longer_of_two(v_ego, v_current, v_new, t_safe, floor):
    distance = max((v_ego - v_current) * t_safe, (v_ego - v_new) * t_safe)
    if distance < floor:
        return floor
    return distance


@wrong("safety_distance", "never be shorter than `floor`")
def without_a_floor(v_ego, v_current, v_new, t_safe, floor):
    return t_safe * v_ego - t_safe * min(v_current, v_new)


@wrong("safety_distance", "faster of the two")
def the_faster_car(v_ego, v_current, v_new, t_safe, floor):
    return max((v_ego - max(v_current, v_new)) * t_safe, floor)


@wrong("safety_distance", "sign is turned")
def theirs_minus_mine(v_ego, v_current, v_new, t_safe, floor):
    return max(floor, -(v_ego - min(v_current, v_new)) * t_safe)


@wrong("safety_distance", "add `floor`")
def a_floor_on_top(v_ego, v_current, v_new, t_safe, floor):
    return (v_ego - min(v_current, v_new)) * t_safe + floor


@wrong("safety_distance", "new lane only")
def the_new_lane(v_ego, v_current, v_new, t_safe, floor):
    return max(floor, (v_ego - v_new) * t_safe)


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
