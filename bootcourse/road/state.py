"""The state of a road: `cars`, a float64 array (roads, vehicles, 10) or (vehicles, 10), one row for each car.

Car 0 is the ego, 1 and 2 are the traps, the rest is traffic. The column numbers are below.
"""

from enum import IntEnum

X, Y = 0, 1  # m; x along the road, y across it: 0 is the centre of the leftmost lane, right is positive
HEADING = 2  # rad; 0 is along the road, right is positive
SPEED = 3  # m/s
STEERING = 4  # rad; the front wheels' angle, right is positive
ACCELERATION = 5  # m/s²
LANE, TARGET_LANE = 6, 7  # 0 is the leftmost
TIMER = 8  # s since this car last considered a lane change
CRASHED = 9  # 0 or 1
COLUMNS = 10

EGO, TRAP_1, TRAP_2, TRAFFIC = 0, 1, 2, 3  # rows; TRAFFIC is the first of several


class Accident(IntEnum):
    """The accidents that end an episode. The paper's "collision rate" is the sum of the three; ours are separate."""

    NONE = 0
    COLLISION = 1
    ROAD_DEPARTURE = 2
    STOPPAGE = 3
