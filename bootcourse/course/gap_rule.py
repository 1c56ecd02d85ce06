"""A rule of ten lines with gap acceptance, which the board shows beside the methods that learn.

It changes to the left only into a gap that is long enough, ahead and behind, and follows the car ahead at a distance
that grows with the speed. `TIME_GAP`, `ROOM` and `SPEED` were chosen by the
mean return on 60 roads of block 21; the board drives those of block 1.
"""

import numpy as np

from bootcourse.learn.teachers import ahead, toward
from bootcourse.road.state import EGO, LANE, X, Y
from bootcourse.road.state import SPEED as V
from bootcourse.scenario import Scenario

TIME_GAP = 1.0  # s behind a car in the leftmost lane
ROOM = 3.0  # m ahead and behind in the lane to the left before a change
SPEED = 15.0  # m/s on a free road


def gap_rule(cars: np.ndarray, scenario: Scenario) -> int:
    """Falls back, changes into a gap, and drives as fast as the car ahead allows: one road's cars -> an action."""
    lane, v = int(cars[EGO, LANE]), cars[EGO, V]
    gap, front = ahead(cars, lane, scenario)
    if lane == 0:
        return toward(cars, min(SPEED, front + (gap - ROOM) / TIME_GAP - v / 2), 0, scenario)
    left_gap, left_front = ahead(cars, lane - 1, scenario)
    behind = cars[(cars[:, LANE] == lane - 1) & (cars[:, X] <= cars[EGO, X])]
    back = (cars[EGO, X] - behind[:, X] - scenario.car.length - TIME_GAP * np.maximum(0, behind[:, V] - v)).min(
        initial=1e9
    )
    arrived = abs(cars[EGO, Y] - lane * scenario.road.lane_width) < 0.5
    goal = lane - 1 if arrived and min(left_gap, back) > ROOM else lane
    return toward(cars, min(front, left_front, 14.0) - 1.5, goal, scenario)
