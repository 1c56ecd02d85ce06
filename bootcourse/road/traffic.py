"""What the other cars decide at each simulation step: IDM along the road, MOBIL across it.

The order of the decisions, and the few rules around the two models (when a driver thinks about a
lane change, when it gives one up), are highway-env's, so that the compiled road and `TrapEnv`
agree. Every function works on one road: `cars` is (vehicles, 10), `directions` holds the cosine
and sine of each car's heading, (vehicles, 2).
"""

import math

from bootcourse.road.compiled import compiled
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


@compiled
def neighbours(cars, i, lane, c):
    """Rows of the nearest car ahead of car i and behind it in a lane; NOBODY where there is none."""
    front, rear = NOBODY, NOBODY
    x, centre, reach = cars[i, X], lane * c.lane_width, c.lane_width / 2 + LANE_MARGIN
    x_front, x_rear = math.inf, -math.inf
    for j in range(cars.shape[0]):
        if j == i or abs(cars[j, Y] - centre) > reach:
            continue
        x_j = cars[j, X]
        if x <= x_j <= x_front:
            front, x_front = j, x_j
        elif x_rear < x_j < x:
            rear, x_rear = j, x_j
    return front, rear


@compiled
def wanted_speed(i, c):
    """The speed (m/s) that car i wants. Traffic takes the ego for one of its own."""
    wanted = c.trap_speed if EGO < i < TRAFFIC else c.desired_speed
    return clip(wanted, 0.0, c.speed_limit)


@compiled
def gap_wanted(cars, directions, i, front, c):
    """s* of car i behind car `front`; their velocities are projected on the heading of car i."""
    v, v_front = cars[i, SPEED], cars[front, SPEED]
    dv = (v * directions[i, 0] - v_front * directions[front, 0]) * directions[i, 0] + (
        v * directions[i, 1] - v_front * directions[front, 1]
    ) * directions[i, 1]
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
def worth_changing(cars, directions, i, lane, own_now, old_follower_gain, c):
    """MOBIL: is the change of car i into `lane` safe for its new follower, and worth it?

    own_now: its present IDM acceleration; old_follower_gain: what the car behind it would gain (m/s²).
    """
    new_front, new_rear = neighbours(cars, i, lane, c)
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
def choose_lane(cars, directions, i, front, rear, own_now, c):
    """Set car i's target lane: give up a change in progress, or think about a new one now and then.

    front, rear: its neighbours in the lane that it drives in; own_now: its IDM acceleration there.
    """
    lane = cars[i, LANE]
    if lane != cars[i, TARGET_LANE]:
        if _somebody_else_wants_it(cars, directions, i, c):
            cars[i, TARGET_LANE] = lane
        return
    if not c.lane_change_delay < cars[i, TIMER]:
        return
    cars[i, TIMER] = 0.0
    if abs(cars[i, SPEED]) < MIN_LANE_CHANGE_SPEED:
        return
    old_follower_gain = following_acceleration(cars, directions, rear, front, c) - following_acceleration(
        cars, directions, rear, i, c
    )
    for side in (int(lane) - 1, int(lane) + 1):
        if 0 <= side < c.lanes and worth_changing(cars, directions, i, side, own_now, old_follower_gain, c):
            cars[i, TARGET_LANE] = side


@compiled
def act(cars, directions, i, c):
    """Set steering and acceleration of car i, a trap or traffic, for the coming simulation step."""
    if cars[i, CRASHED] != 0:
        return
    lane = cars[i, LANE]
    front, rear = neighbours(cars, i, lane, c)
    acceleration = following_acceleration(cars, directions, i, front, c)
    if i >= TRAFFIC:
        choose_lane(cars, directions, i, front, rear, acceleration, c)
    target = cars[i, TARGET_LANE]
    offset = cars[i, Y] - target * c.lane_width
    cars[i, STEERING] = lane_keeping_steering(
        offset, cars[i, HEADING], cars[i, SPEED], c.length, c.tau_lateral, c.tau_heading
    )
    if target != lane:
        front, rear = neighbours(cars, i, target, c)
        acceleration = min(acceleration, following_acceleration(cars, directions, i, front, c))
    cars[i, ACCELERATION] = clip(acceleration, -c.braking_limit, c.braking_limit)
