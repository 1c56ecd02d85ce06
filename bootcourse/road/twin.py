"""The compiled road: one decision on thousands of roads per call, arrays in, arrays out.

It computes the same steps as `TrapEnv` on highway-env; `tests/agreement.py` compares the two.
"""

import math

import numpy as np

from bootcourse.road.compiled import compiled, compiled_loop
from bootcourse.road.formulas import (
    bicycle_step,
    centring_reward,
    direction,
    nearest_lane,
    overlap,
    speed_reward,
    steering_reward,
    weighted_reward,
)
from bootcourse.road.state import (
    ACCELERATION,
    COLUMNS,
    CRASHED,
    EGO,
    HEADING,
    LANE,
    SPEED,
    STEERING,
    TARGET_LANE,
    TIMER,
    TRAFFIC,
    TRAP_1,
    TRAP_2,
    Accident,
    X,
    Y,
)
from bootcourse.road.traffic import act, look_around, new_around, sort_by_x

NO_ACCIDENT, COLLISION = int(Accident.NONE), int(Accident.COLLISION)
ROAD_DEPARTURE, STOPPAGE = int(Accident.ROAD_DEPARTURE), int(Accident.STOPPAGE)
NO_TRACE = np.empty((0, 0, 0, 0))


def uniforms_needed(vehicles: int) -> int:
    """How many random numbers in [0, 1) one start needs: D1, D2, and the traffic's lanes, speeds and spacings."""
    return 2 + max(0, 3 * (vehicles - TRAFFIC) - 1)


@compiled
def place(uniforms, c, cars):
    """Fill `cars` (vehicles, 10) with the start of an episode (Table 1); uniforms: (uniforms_needed(vehicles),)."""
    traffic = cars.shape[0] - TRAFFIC
    cars[:] = 0.0
    rightmost = c.lanes - 1
    d1 = c.d1_low + uniforms[0] * (c.d1_high - c.d1_low)
    d2 = c.d2_low + uniforms[1] * (c.d2_high - c.d2_low)
    for i in range(cars.shape[0]):
        if i == EGO:
            x, lane, speed = 0.0, rightmost, c.ego_speed
        elif i == TRAP_1:
            x, lane, speed = d1, rightmost, c.trap_speed
        elif i == TRAP_2:
            x, lane, speed = d2, rightmost - 1, c.trap_speed
        else:
            k = 2 + i - TRAFFIC
            lane = min(int(uniforms[k] * c.lanes), rightmost)
            speed = c.speed_low + uniforms[k + traffic] * (c.speed_high - c.speed_low)
            x = d1 + c.lead
            if i > TRAFFIC:
                spacing = c.spacing_low + uniforms[k - 1 + 2 * traffic] * (c.spacing_high - c.spacing_low)
                x = cars[i - 1, X] + c.headway * spacing
        cars[i, X], cars[i, Y], cars[i, SPEED] = x, lane * c.lane_width, speed
        cars[i, LANE] = cars[i, TARGET_LANE] = lane
        if i != EGO:  # as in highway-env, so that the cars consider lane changes at different times
            cars[i, TIMER] = (x + cars[i, Y]) * math.pi % c.lane_change_delay if c.lane_change_delay > 0 else 0.0


@compiled
def move(cars, i, c):
    """Move car i by one simulation step under its present steering and acceleration."""
    v = cars[i, SPEED]
    fastest = c.max_speed if i == EGO else c.speed_limit
    if cars[i, CRASHED] != 0:
        cars[i, STEERING], cars[i, ACCELERATION] = 0.0, -v
    if v > fastest:
        cars[i, ACCELERATION] = min(cars[i, ACCELERATION], fastest - v)
    elif v < 0:
        cars[i, ACCELERATION] = max(cars[i, ACCELERATION], -v)
    if i != EGO:
        cars[i, TIMER] += c.dt
    cars[i, X], cars[i, Y], cars[i, HEADING], cars[i, SPEED] = bicycle_step(
        cars[i, X], cars[i, Y], cars[i, HEADING], v, cars[i, ACCELERATION], cars[i, STEERING], c.length, c.dt
    )
    cars[i, LANE] = nearest_lane(cars[i, Y], cars[i, HEADING], c.lanes, c.lane_width)
    if i == EGO:  # the other cars cannot see the lane that the ego changes to
        cars[i, TARGET_LANE] = cars[i, LANE]


@compiled
def collide(cars, order, c):
    """Mark every car that touches another. `order` must be sorted: only the next few cars can be close enough."""
    reach = math.sqrt(c.length**2 + c.width**2)
    for k in range(len(order)):
        i = order[k]
        for m in range(k + 1, len(order)):
            j = order[m]
            if cars[j, X] - cars[i, X] > reach:
                break
            if overlap(
                cars[i, X], cars[i, Y], cars[i, HEADING], cars[j, X], cars[j, Y], cars[j, HEADING], c.length, c.width
            ):
                cars[i, CRASHED] = cars[j, CRASHED] = 1.0


@compiled
def ego_accident(cars, c):
    """The ego's accident, the number of an `Accident`."""
    if cars[EGO, CRASHED] != 0:
        return COLLISION
    if not -c.lane_width / 2 <= cars[EGO, Y] <= (c.lanes - 0.5) * c.lane_width:
        return ROAD_DEPARTURE
    if cars[EGO, SPEED] < c.min_speed:
        return STOPPAGE
    return NO_ACCIDENT


@compiled
def command(cars, action, c):
    """Set the ego's controls to an action (Equation 8): 3 x (brake, keep, accelerate) + (left, straight, right)."""
    cars[EGO, ACCELERATION] = (action // 3 - 1) * c.ego_acceleration
    cars[EGO, STEERING] = (action % 3 - 1) * c.ego_steering


@compiled
def simulate(cars, order, around, directions, c):
    """One simulation step of one road; `order` must be sorted. Returns the ego's accident."""
    look_around(cars, order, around, c)
    for i in range(cars.shape[0]):
        directions[i, 0], directions[i, 1] = direction(cars[i, HEADING])
    for i in range(1, cars.shape[0]):
        act(cars, around, directions, i, c)
    for i in range(cars.shape[0]):
        move(cars, i, c)
    sort_by_x(cars, order)
    collide(cars, order, c)
    return ego_accident(cars, c)


@compiled
def reward_terms(cars, c):
    """(r_v, r_y, r_θ) of the ego's state (Equations 10 to 12)."""
    offset = cars[EGO, Y] - cars[EGO, LANE] * c.lane_width
    return (
        speed_reward(cars[EGO, SPEED] * math.cos(cars[EGO, HEADING])),
        centring_reward(offset),
        steering_reward(cars[EGO, STEERING]),
    )


@compiled
def copy_state(cars, copy):
    """Copy a state number by number: numba compiles `copy[:] = cars` much longer, for the words of its error."""
    for i in range(cars.shape[0]):
        for column in range(cars.shape[1]):
            copy[i, column] = cars[i, column]


@compiled_loop
def decide(cars, actions, asleep, c, rewards, terms, accidents, trace):
    """One decision on every road that is not asleep, in place.

    Reads cars (roads, vehicles, 10), actions (roads,) in 0..8 and asleep (roads,) bool; writes cars, rewards (roads,),
    terms (roads, 3) and accidents (roads,). trace (roads, steps, vehicles, 10) receives the state after each
    simulation step (after an accident, the last state again); NO_TRACE records none.
    """
    vehicles = cars.shape[1]
    order, around, directions = np.arange(vehicles), new_around(vehicles, c), np.empty((vehicles, 2))
    for road in range(cars.shape[0]):
        if asleep[road]:
            continue
        command(cars[road], actions[road], c)
        sort_by_x(cars[road], order)
        accident = NO_ACCIDENT
        for step in range(c.steps):
            if accident == NO_ACCIDENT:
                accident = simulate(cars[road], order, around, directions, c)
            if trace.shape[0] > 0:
                copy_state(cars[road], trace[road, step])
        accidents[road] = accident
        r_v, r_y, r_theta = reward_terms(cars[road], c)
        terms[road, 0], terms[road, 1], terms[road, 2] = r_v, r_y, r_theta
        if accident == NO_ACCIDENT:
            rewards[road] = weighted_reward(r_v, r_y, r_theta, c.w_v, c.w_y, c.w_theta)
        else:
            rewards[road] = c.accident


def empty_cars(roads: int, vehicles: int) -> np.ndarray:
    """The state of some roads, all zero: (roads, vehicles, 10)."""
    return np.zeros((roads, vehicles, COLUMNS))
