"""What the other cars decide at each simulation step: IDM along the road, MOBIL across it.

The order of the decisions, and the few rules around the two models (when a driver thinks about a
lane change, when it gives one up), are highway-env's, so that the compiled road and `TrapEnv`
agree. Every function works on one road: `cars` is (vehicles, 10), `directions` holds the cosine
and sine of each car's heading, (vehicles, 2), and `around` who is next to whom (`look_around`).
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
    """Bring the rows in `order` (vehicles,) from the rearmost car to the foremost; they hardly ever change."""
    for k in range(1, len(order)):
        i, place = order[k], k
        while place > 0 and cars[order[place - 1], X] > cars[i, X]:
            order[place] = order[place - 1]
            place -= 1
        order[place] = i


@compiled
def look_around(cars, order, around, c):
    """Who is next to whom: around[lane, i] becomes the rows of the nearest car ahead of car i and behind it.

    For every lane, whether car i drives in it or not, and NOBODY where there is none. around is
    (lanes, vehicles, 2). `order` is sorted: one walk forwards finds who is behind, one back who is ahead.
    (Of two cars at exactly the same x one counts as ahead; highway-env says so of both.)
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
    """The speed (m/s) that car i wants. Traffic takes the ego for one of its own."""
    wanted = c.trap_speed if EGO < i < TRAFFIC else c.desired_speed
    return clip(wanted, 0.0, c.speed_limit)


@compiled
def gap_wanted(cars, directions, i, front, c):
    """s* of car i behind car `front`; their velocities are projected on the heading of car i."""
    v, v_front = cars[i, SPEED], cars[front, SPEED]
    dv_x = v * directions[i, 0] - v_front * directions[front, 0]
    dv_y = v * directions[i, 1] - v_front * directions[front, 1]
    dv = dv_x * directions[i, 0] + dv_y * directions[i, 1]
    return desired_gap(v, dv, c.s0, c.time_gap, c.a_max, c.b)


@compiled
def following_acceleration(cars, directions, i, front, c):
    """IDM acceleration (m/s²) of car i if `front` were the car ahead of it; 0 for nobody."""
    if i == NOBODY:
        return 0.0
    if front == NOBODY:
        return idm_acceleration(cars[i, SPEED], wanted_speed(i, c), math.inf, 0.0, c.a_max, c.delta)
    gap = cars[front, X] - cars[i, X]
    s_star = gap_wanted(cars, directions, i, front, c)
    return idm_acceleration(cars[i, SPEED], wanted_speed(i, c), gap, s_star, c.a_max, c.delta)


@compiled
def worth_changing(cars, around, directions, i, lane, own_now, old_follower_gain, c):
    """MOBIL (Equation 5): is the change of car i into `lane` safe for its new follower, and worth it?

    own_now: its present IDM acceleration; old_follower_gain: what the car behind it would gain (m/s²).
    """
    new_front, new_rear = around[lane, i, FRONT], around[lane, i, REAR]
    new_rear_after = following_acceleration(cars, directions, new_rear, i, c)
    if new_rear_after < -c.safe_braking:
        return False
    own_gain = following_acceleration(cars, directions, i, new_front, c) - own_now
    new_follower_gain = new_rear_after - following_acceleration(cars, directions, new_rear, new_front, c)
    return mobil_incentive(own_gain, new_follower_gain, old_follower_gain, c.politeness) >= c.a_threshold


@compiled
def _somebody_else_wants_it(cars, directions, i, c):
    """Is another car, close ahead, already changing into the lane that car i is changing into?"""
    target = cars[i, TARGET_LANE]
    for j in range(1, cars.shape[0]):
        if j != i and cars[j, LANE] != target and cars[j, TARGET_LANE] == target:
            gap = cars[j, X] - cars[i, X]
            if 0 < gap < gap_wanted(cars, directions, i, j, c):
                return True
    return False


@compiled
def choose_lane(cars, around, directions, i, own_now, c):
    """Set car i's target lane: give up a change in progress, or think about a new one now and then.

    own_now: its IDM acceleration in the lane that it drives in (m/s²).
    """
    lane = int(cars[i, LANE])
    if lane != cars[i, TARGET_LANE]:
        if _somebody_else_wants_it(cars, directions, i, c):
            cars[i, TARGET_LANE] = lane
        return
    if not c.lane_change_delay < cars[i, TIMER]:
        return
    cars[i, TIMER] = 0.0
    if abs(cars[i, SPEED]) < MIN_LANE_CHANGE_SPEED:
        return
    front, rear = around[lane, i, FRONT], around[lane, i, REAR]
    rear_without_me = following_acceleration(cars, directions, rear, front, c)
    old_follower_gain = rear_without_me - following_acceleration(cars, directions, rear, i, c)
    for side in (lane - 1, lane + 1):
        if 0 <= side < c.lanes and worth_changing(cars, around, directions, i, side, own_now, old_follower_gain, c):
            cars[i, TARGET_LANE] = side


@compiled
def act(cars, around, directions, i, c):
    """Set steering and acceleration of car i, a trap or traffic, for the coming simulation step."""
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
