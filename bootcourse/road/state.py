"""How a road is stored: one row of numbers for each car.

`cars` is a float64 array of shape (roads, vehicles, 10) or (vehicles, 10); car 0 is the ego, 1 and
2 are the traps, the rest is traffic. The column names below are its index.
"""

from enum import IntEnum

X, Y = 0, 1  # m; x along the road, y across it: 0 is the centre of the leftmost lane, right is positive
HEADING = 2  # rad; 0 is along the road, right is positive
SPEED = 3  # m/s
STEERING = 4  # rad; the front wheels' angle, right is positive
ACCELERATION = 5  # m/s²
LANE, TARGET_LANE = 6, 7  # 0 is the leftmost
TIMER = 8  # s since this car last thought about a lane change
CRASHED = 9  # 0 or 1
COLUMNS = 10

EGO, TRAP_1, TRAP_2, TRAFFIC = 0, 1, 2, 3  # rows; TRAFFIC is the first of several


class Accident(IntEnum):
    """How an episode can end badly. The paper's "collision rate" adds the three up; we do not."""

    NONE = 0
    COLLISION = 1
    ROAD_DEPARTURE = 2
    STOPPAGE = 3
