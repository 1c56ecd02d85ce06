"""The observation: 26 numbers (Section III-C, "State"), scaled to order one.

(p, x, y, v_lon, v_lat, d_e) of the ego, then (p, Δx, Δy, Δv_lon, Δv_lat) of the four nearest cars within 200 m,
nearest first; a missing car is five zeros.
"""

import math

import numpy as np

from bootcourse.road.compiled import compiled
from bootcourse.road.state import EGO, HEADING, LANE, SPEED, X, Y
from bootcourse.scenario import Scenario

# An observation is the physical number divided by its scale.
X_SCALE = 1000.0  # m
Y_SCALE = 4.0  # m, one lane
V_LON_SCALE = 15.0  # m/s, the speed that pays best
V_LAT_SCALE = 2.0  # m/s
OFFSET_SCALE = 2.0  # m, half a lane
DX_SCALE = 50.0  # m
DV_SCALE = 5.0  # m/s

EGO_NAMES = ("presence", "x", "y", "v_lon", "v_lat", "d_e")
NEIGHBOUR_NAMES = ("presence", "dx", "dy", "dv_lon", "dv_lat")
EGO_SCALES = (1.0, X_SCALE, Y_SCALE, V_LON_SCALE, V_LAT_SCALE, OFFSET_SCALE)
NEIGHBOUR_SCALES = (1.0, DX_SCALE, Y_SCALE, DV_SCALE, V_LAT_SCALE)


def scales(scenario: Scenario) -> np.ndarray:
    """The scale that each number of an observation is divided by, (observation_size,)."""
    return np.array(EGO_SCALES + scenario.sight.neighbours * NEIGHBOUR_SCALES)


def names(scenario: Scenario) -> list[str]:
    """A name for each number of an observation, such as "x" and "car 2 dx"."""
    cars = range(1, scenario.sight.neighbours + 1)
    return [*EGO_NAMES, *(f"car {n} {name}" for n in cars for name in NEIGHBOUR_NAMES)]


def bounds(scenario: Scenario) -> tuple[np.ndarray, np.ndarray]:
    """Lower and upper limits of the observations, finite: two float32 arrays (observation_size,)."""
    s = scenario
    hardest = max(s.ego.acceleration, s.traffic.a_max, s.traffic.braking_limit)  # m/s²
    fastest = max(s.ego.max_speed, s.road.speed_limit) + hardest * s.clock.dt  # m/s, one step above the limit
    overshoot = fastest * s.clock.dt  # m, the last step may end this far beyond the edge
    across = s.road.lanes * s.road.lane_width + overshoot
    ego = [1, s.road.length + overshoot, across, fastest, fastest, across]
    neighbour = [1, s.sight.distance, s.sight.distance, 2 * fastest, 2 * fastest]
    high = np.array(ego + s.sight.neighbours * neighbour) / scales(s)
    low = np.where(["presence" in name for name in names(s)], 0.0, -high)
    return low.astype(np.float32), high.astype(np.float32)


@compiled
def observe(cars, c, out):
    """Write the observation of one road (Equation 7) into out (observation_size,); cars (vehicles, 10)."""
    x, y = cars[EGO, X], cars[EGO, Y]
    v_lon, v_lat = cars[EGO, SPEED] * math.cos(cars[EGO, HEADING]), cars[EGO, SPEED] * math.sin(cars[EGO, HEADING])
    out[0] = 1.0
    out[1], out[2] = x / X_SCALE, y / Y_SCALE
    out[3], out[4] = v_lon / V_LON_SCALE, v_lat / V_LAT_SCALE
    out[5] = (y - cars[EGO, LANE] * c.lane_width) / OFFSET_SCALE
    out[6:] = 0.0
    previous, previous_row = -1.0, -1
    for n in range(c.neighbours):
        row, best = -1, c.sight**2
        for j in range(1, cars.shape[0]):
            squared = (cars[j, X] - x) ** 2 + (cars[j, Y] - y) ** 2
            later = squared > previous or (squared == previous and j > previous_row)
            if later and squared < best:
                row, best = j, squared
        if row < 0:
            return
        previous, previous_row = best, row
        k = 6 + 5 * n
        out[k] = 1.0
        out[k + 1], out[k + 2] = (cars[row, X] - x) / DX_SCALE, (cars[row, Y] - y) / Y_SCALE
        out[k + 3] = (cars[row, SPEED] * math.cos(cars[row, HEADING]) - v_lon) / DV_SCALE
        out[k + 4] = (cars[row, SPEED] * math.sin(cars[row, HEADING]) - v_lat) / V_LAT_SCALE


@compiled
def observe_all(cars, c, out):
    """Write the observations of all roads into out (roads, observation_size); cars (roads, vehicles, 10)."""
    for road in range(cars.shape[0]):
        observe(cars[road], c, out[road])
