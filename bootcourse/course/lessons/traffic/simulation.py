"""The lesson's traffic without lanes: cars that follow each other by IDM, on a ring or behind one leader."""

import math
from collections.abc import Callable

import numpy as np
import scipy

from bootcourse.road.formulas import desired_gap, idm_acceleration
from bootcourse.scenario import DEFAULT, Traffic


def follow(v: float, dv: float, gap: float, traffic: Traffic = DEFAULT.traffic) -> float:
    """Acceleration (m/s²) of a driver of the traffic at v (m/s), closing in at dv on a car `gap` metres ahead."""
    t = traffic
    s_star = desired_gap(v, dv, t.s0, t.time_gap, t.a_max, t.b)
    return max(idm_acceleration(v, t.desired_speed, gap, s_star, t.a_max, t.delta), -t.braking_limit)


def stronger(speeding_up: float = 1.0, braking: float = 1.0) -> Callable[..., float]:
    """`follow` for drivers who speed up, or brake, so many times as strongly; the hardest braking stays."""

    def acceleration(v: float, dv: float, gap: float, traffic: Traffic = DEFAULT.traffic) -> float:
        a = follow(v, dv, gap, traffic)
        return speeding_up * a if a > 0 else max(braking * a, -traffic.braking_limit)

    return acceleration


def settled_speed(spacing: float) -> float:
    """The speed (m/s) that cars hold which follow each other at this distance (m, more than s0)."""
    return scipy.optimize.brentq(lambda v: follow(v, 0.0, spacing), 0.0, DEFAULT.traffic.desired_speed)


def ring(
    spacing: float,
    first: float = 1.0,
    seconds: float = 400,
    traffic: Traffic = DEFAULT.traffic,
    acceleration: Callable[..., float] = follow,
    dt: float = 0.5,
) -> tuple[np.ndarray, np.ndarray]:
    """Places (m) and speeds (m/s) of 30 cars in a circle, both (steps, cars), in steps of `dt` (s).

    They start at the speed that they hold at this distance (`spacing`, m), one of them at `first` (m/s).
    acceleration: of (v, dv, gap, traffic), as `follow`.
    """
    cars = 30
    x, v = spacing * np.arange(cars, dtype=float), np.full(cars, settled_speed(spacing))
    v[0] = first
    places, speeds = [], []
    for _ in range(round(seconds / dt)):
        gaps = (np.roll(x, -1) - x) % (spacing * cars)
        a = np.array([acceleration(*car, traffic) for car in zip(v, v - np.roll(v, -1), gaps, strict=True)])
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


def leader(slowest: float) -> np.ndarray:
    """Speeds (m/s), in steps of 0.5 s, of a car that drives 10 m/s, brakes to `slowest` in 2 s, and recovers."""
    return np.interp(0.5 * np.arange(240), [30, 32, 50, 54], [10.0, slowest, slowest, 10.0])


def row(ahead: np.ndarray, drivers: int = 8) -> list[np.ndarray]:
    """Speeds (m/s) of drivers of the traffic in a row, 10 m/s and 32.5 m apart at first, behind a car's speeds."""
    speeds = []
    for _ in range(drivers):
        ahead = behind(ahead, v=10.0, gap=32.5)[:-1, 1]
        speeds.append(ahead)
    return speeds
