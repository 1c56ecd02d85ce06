"""Where every car is at any time, computed from a rollout, which records two states a second.

Between two recorded states a car follows the arc of the bicycle model under its command in that step. The simulation
takes one Euler step (`bootcourse.road.formulas.bicycle_step`), which ends a few centimetres beside the arc. This
difference is spread evenly over the step, so that the car is at each recorded state exactly and never jumps.
"""

from dataclasses import dataclass
from functools import cached_property

import numpy as np

from bootcourse.episodes.lookahead import Imagined
from bootcourse.episodes.rollout import Rollout
from bootcourse.road.state import ACCELERATION, CRASHED, HEADING, LANE, SPEED, STEERING, X, Y


def wrap(angle):
    """The same angle in [-π, π)."""
    return (angle + np.pi) % (2 * np.pi) - np.pi


def arc(heading, v, acceleration, steering, length, tau):
    """The bicycle model under a constant command for `tau` seconds: (Δx, Δy, Δheading).

    s = v τ + a τ² / 2;  slip β = arctan(½ tan θ);  the heading turns by κ s with κ = sin β / (length / 2).
    The path is a piece of a circle; its chord has length s · sin(κs/2) / (κs/2) and direction heading + β + κs/2.
    Metres, radians, seconds; scalars or arrays.
    """
    s = v * tau + acceleration * tau**2 / 2
    slip = np.arctan(0.5 * np.tan(steering))
    turn = np.sin(slip) / (length / 2) * s
    chord = s * np.sinc(turn / (2 * np.pi))  # numpy's sinc(x) is sin(πx) / (πx)
    course = heading + slip + turn / 2
    return chord * np.cos(course), chord * np.sin(course), turn


@dataclass(frozen=True)
class Moment:
    """All cars of a drive at one time; each array is (vehicles,), in the road's coordinates (y to the right)."""

    x: np.ndarray  # m
    y: np.ndarray  # m
    heading: np.ndarray  # rad
    speed: np.ndarray  # m/s
    acceleration: np.ndarray  # m/s², in the present simulation step
    steering: np.ndarray  # rad, in the present simulation step
    lane: np.ndarray  # 0 is the leftmost
    crashed: np.ndarray  # bool


def between(before: np.ndarray, after: np.ndarray, tau: float, dt: float, length: float) -> Moment:
    """The cars `tau` seconds after `before`, 0 <= tau <= dt. before, after: (vehicles, 10), one step apart.

    The command of this step is recorded in `after`.
    """
    heading, v = before[:, HEADING], before[:, SPEED]
    acceleration, steering = after[:, ACCELERATION], after[:, STEERING]
    dx, dy, turn = arc(heading, v, acceleration, steering, length, tau)
    dx_end, dy_end, turn_end = arc(heading, v, acceleration, steering, length, dt)
    part = tau / dt
    arrived = after if tau >= dt else before
    return Moment(
        x=before[:, X] + dx + part * (after[:, X] - before[:, X] - dx_end),
        y=before[:, Y] + dy + part * (after[:, Y] - before[:, Y] - dy_end),
        heading=heading + turn + part * wrap(after[:, HEADING] - heading - turn_end),
        speed=v + part * (after[:, SPEED] - v),
        acceleration=acceleration,
        steering=steering,
        lane=arrived[:, LANE].astype(int),
        crashed=arrived[:, CRASHED] != 0,
    )


@dataclass(frozen=True)
class Timeline:
    """A rollout at any time from 0 to `duration` seconds; times before and after show the first and the last state."""

    rollout: Rollout
    imagined: Imagined | None = None  # nine drives from each decision: (decisions, 9, ...)

    @property
    def dt(self) -> float:
        return self.rollout.scenario.clock.dt

    @property
    def duration(self) -> float:
        """Seconds; an accident may end a drive in the middle of a decision."""
        return (len(self.rollout.states) - 1) * self.dt

    @property
    def decisions(self) -> int:
        return len(self.rollout.actions)

    def at(self, t: float) -> Moment:
        t = min(max(t, 0.0), self.duration)
        i = min(int(t / self.dt + 1e-9), len(self.rollout.states) - 2)
        tau = min(max(t - i * self.dt, 0.0), self.dt)
        if self.dt - tau < 1e-9:
            tau = self.dt
        states = self.rollout.states
        return between(states[i], states[i + 1], tau, self.dt, self.rollout.scenario.car.length)

    def decision(self, t: float) -> int:
        """Index of the decision that is being carried out at time t, 0 .. decisions - 1."""
        return min(max(int(t * self.rollout.scenario.clock.decision_rate + 1e-9), 0), self.decisions - 1)

    def earned(self, t: float) -> int:
        """Number of decisions that are over at time t, whose rewards count, 0 .. decisions."""
        if t >= self.duration - 1e-9:
            return self.decisions
        return min(max(int(t * self.rollout.scenario.clock.decision_rate + 1e-9), 0), self.decisions)

    @cached_property
    def returns(self) -> np.ndarray:
        """Return after 0, 1, ... decisions, (decisions + 1,)."""
        return np.concatenate([[0.0], np.cumsum(self.rollout.rewards)])
