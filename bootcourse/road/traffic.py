"""The controllers of the traps and the traffic at each simulation step: IDM for speed, MOBIL for lane changes.

The order of the computations and the rules for considering and aborting a lane change are highway-env's, so that the
compiled road and `TrapEnv` agree. Every function works on one road: `cars` (vehicles, 10), `directions` (vehicles, 2)
with the cosine and sine of each heading, and `around` (lanes, vehicles, 2) with the neighbours (see `look_around`).
"""

import math

import numpy as np

from bootcourse.road.compiled import compiled, compiled_loop
from bootcourse.road.formulas import (
    clip,
    desired_gap,
    idm_acceleration,
    lane_keeping_steering,
    mobil_incentive,
)
from bootcourse.road.state import (
    ACCELERATION,
    CRASHED,
    EGO,
    HEADING,
    LANE,
    SPEED,
    STEERING,
    TARGET_LANE,
    TIMER,
    TRAFFIC,
    X,
    Y,
)

NOBODY = -1
LANE_MARGIN = 1.0  # m; a car this far over the line still counts as in the lane (highway-env)
MIN_LANE_CHANGE_SPEED = 1.0  # m/s (highway-env)
FRONT, REAR = 0, 1  # the last index of `around`


@compiled_loop
def new_around(vehicles, c):
    """An empty `around`, (lanes, vehicles, 2)."""
    return np.empty((c.lanes, vehicles, 2), np.int64)


@compiled
def sort_by_x(cars, order):
    """Sort `order` (vehicles,), the cars' rows, from rearmost to foremost, by insertion: it is almost sorted."""
    for k in range(1, len(order)):
        i, place = order[k], k
        while place > 0 and cars[order[place - 1], X] > cars[i, X]:
            order[place] = order[place - 1]
            place -= 1
        order[place] = i


@compiled
def look_around(cars, order, around, c):
    """Set around[lane, i] to the rows of the nearest cars ahead of and behind car i in that lane, NOBODY for none.

    `order` must be sorted: one pass forwards finds the cars behind, one pass backwards the cars ahead. Of two cars
    at exactly the same x, one counts as ahead (in highway-env, both do).
    """
    vehicles, reach = len(order), c.lane_width / 2 + LANE_MARGIN
    for lane in range(c.lanes):
        centre, rear, front = lane * c.lane_width, NOBODY, NOBODY
        for k in range(vehicles):
            i, j = order[k], order[vehicles - 1 - k]
            around[lane, i, REAR], around[lane, j, FRONT] = rear, front
            rear = i if abs(cars[i, Y] - centre) <= reach else rear
            front = j if abs(cars[j, Y] - centre) <= reach else front


@compiled
def wanted_speed(i, c):
    """The desired speed of car i (m/s). For the ego, which MOBIL also evaluates, it is the traffic's."""
    wanted = c.trap_speed if EGO < i < TRAFFIC else c.desired_speed
    return clip(wanted, 0.0, c.speed_limit)


@compiled
def gap_wanted(cars, directions, i, front, c):
    """s* (m) of car i behind car `front`; the relative velocity is projected on the heading of car i."""
    v, v_front = cars[i, SPEED], cars[front, SPEED]
    dv_x = v * directions[i, 0] - v_front * directions[front, 0]
    dv_y = v * directions[i, 1] - v_front * directions[front, 1]
    dv = dv_x * directions[i, 0] + dv_y * directions[i, 1]
    return desired_gap(v, dv, c.s0, c.time_gap, c.a_max, c.b)


@compiled
def following_acceleration(cars, directions, i, front, c):
    """IDM acceleration (m/s²) of car i behind car `front`; 0 if i is NOBODY, a free road if front is."""
    if i == NOBODY:
        return 0.0
    if front == NOBODY:
        return idm_acceleration(cars[i, SPEED], wanted_speed(i, c), math.inf, 0.0, c.a_max, c.delta)
    gap = cars[front, X] - cars[i, X]
    s_star = gap_wanted(cars, directions, i, front, c)
    return idm_acceleration(cars[i, SPEED], wanted_speed(i, c), gap, s_star, c.a_max, c.delta)


@compiled
def worth_changing(cars, around, directions, i, lane, own_now, old_follower_gain, c):
    """MOBIL (Equation 5): whether the change of car i into `lane` is safe for its new follower and gains enough.

    own_now: present IDM acceleration of car i (m/s²); old_follower_gain: gain of the car behind it (m/s²).
    """
    new_front, new_rear = around[lane, i, FRONT], around[lane, i, REAR]
    new_rear_after = following_acceleration(cars, directions, new_rear, i, c)
    if new_rear_after < -c.safe_braking:
        return False
    own_gain = following_acceleration(cars, directions, i, new_front, c) - own_now
    new_follower_gain = new_rear_after - following_acceleration(cars, directions, new_rear, new_front, c)
    return mobil_incentive(own_gain, new_follower_gain, old_follower_gain, c.politeness) >= c.a_threshold


@compiled
def _target_lane_contested(cars, directions, i, c):
    """Whether another car, closer ahead than s*, is changing into the target lane of car i."""
    target = cars[i, TARGET_LANE]
    for j in range(1, cars.shape[0]):
        if j != i and cars[j, LANE] != target and cars[j, TARGET_LANE] == target:
            gap = cars[j, X] - cars[i, X]
            if 0 < gap < gap_wanted(cars, directions, i, j, c):
                return True
    return False


@compiled
def choose_lane(cars, around, directions, i, own_now, c):
    """Set the target lane of car i: abort a contested change, or consider a new one every lane_change_delay seconds.

    own_now: IDM acceleration of car i in its present lane (m/s²).
    """
    lane = int(cars[i, LANE])
    if lane != cars[i, TARGET_LANE]:
        if _target_lane_contested(cars, directions, i, c):
            cars[i, TARGET_LANE] = lane
        return
    if not c.lane_change_delay < cars[i, TIMER]:
        return
    cars[i, TIMER] = 0.0
    if abs(cars[i, SPEED]) < MIN_LANE_CHANGE_SPEED:
        return
    front, rear = around[lane, i, FRONT], around[lane, i, REAR]
    rear_after = following_acceleration(cars, directions, rear, front, c)
    old_follower_gain = rear_after - following_acceleration(cars, directions, rear, i, c)
    for side in (lane - 1, lane + 1):
        if 0 <= side < c.lanes and worth_changing(cars, around, directions, i, side, own_now, old_follower_gain, c):
            cars[i, TARGET_LANE] = side


@compiled
def act(cars, around, directions, i, c):
    """Set the steering and the acceleration of car i, a trap or a traffic car, for the next simulation step."""
    if cars[i, CRASHED] != 0:
        return
    lane = int(cars[i, LANE])
    acceleration = following_acceleration(cars, directions, i, around[lane, i, FRONT], c)
    if i >= TRAFFIC:
        choose_lane(cars, around, directions, i, acceleration, c)
    target = int(cars[i, TARGET_LANE])
    offset = cars[i, Y] - target * c.lane_width
    cars[i, STEERING] = lane_keeping_steering(
        offset, cars[i, HEADING], cars[i, SPEED], c.length, c.tau_lateral, c.tau_heading
    )
    if target != lane:
        acceleration = min(acceleration, following_acceleration(cars, directions, i, around[target, i, FRONT], c))
    cars[i, ACCELERATION] = clip(acceleration, -c.braking_limit, c.braking_limit)
