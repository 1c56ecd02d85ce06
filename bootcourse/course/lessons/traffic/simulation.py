"""The lesson's traffic without lanes: cars that follow each other by IDM, on a ring or behind one leader."""

import math

import numpy as np

from bootcourse.road.formulas import desired_gap, idm_acceleration
from bootcourse.scenario import DEFAULT


def follow(v: float, dv: float, gap: float) -> float:
    """Acceleration (m/s²) of a driver of the traffic at v (m/s), closing in at dv on a car `gap` metres ahead."""
    t = DEFAULT.traffic
    s_star = desired_gap(v, dv, t.s0, t.time_gap, t.a_max, t.b)
    return max(idm_acceleration(v, t.desired_speed, gap, s_star, t.a_max, t.delta), -t.braking_limit)


def ring(spacing: float, cars: int = 30, seconds: float = 400, dt: float = 0.5) -> tuple[np.ndarray, np.ndarray]:
    """Places (m) and speeds (m/s) of cars in a circle, both (steps, cars). They start at 6 m/s, one of them at 1."""
    x, v = spacing * np.arange(cars, dtype=float), np.full(cars, 6.0)
    v[0] = 1.0
    places, speeds = [], []
    for _ in range(int(seconds / dt)):
        gaps = (np.roll(x, -1) - x) % (spacing * cars)
        a = np.array([follow(*car) for car in zip(v, v - np.roll(v, -1), gaps, strict=True)])
        x, v = x + v * dt, np.maximum(v + a * dt, 0)
        places.append(x % (spacing * cars))
        speeds.append(v)
    return np.array(places), np.array(speeds)


def drive_behind(leader, v, gap, dt, v_desired, s0, time_gap, a_max, b, delta, limit):
    """Gap (m) and speed (m/s) of an IDM driver behind a car of given speeds: (steps,) -> (steps + 1, 2)."""
    states = [(gap, v)]
    for v_leader in leader:
        s_star = s0 + time_gap * v + v * (v - v_leader) / (2 * math.sqrt(a_max * b))
        a = a_max * (1 - (v / v_desired) ** delta - (s_star / gap) ** 2)
        gap, v = gap + (v_leader - v) * dt, max(v + max(a, -limit) * dt, 0.0)
        states.append((gap, v))
    return np.array(states)


def behind(leader: np.ndarray, v: float, gap: float, dt: float = 0.5) -> np.ndarray:
    """The same for a driver of the traffic."""
    t = DEFAULT.traffic
    return drive_behind(
        leader, v, gap, dt, t.desired_speed, t.s0, t.time_gap, t.a_max, t.b, t.delta, t.braking_limit
    )  # fmt: skip
