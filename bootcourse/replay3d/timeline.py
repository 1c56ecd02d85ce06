"""A rollout holds two states a second; a timeline says where every car is at any time."""

from dataclasses import dataclass

import numpy as np

from bootcourse.colours import OTHER
from bootcourse.episodes.lookahead import Imagined
from bootcourse.episodes.rollout import Rollout, interpolate_states
from bootcourse.road.state import ACCELERATION, CRASHED, LANE


@dataclass(frozen=True)
class Timeline:
    """A rollout from 0 to `duration` seconds; times before and after show the first and the last state."""

    rollout: Rollout
    imagined: Imagined | None = None  # nine drives from each decision: (decisions, 9, ...)
    colour: str = OTHER.colour  # of the driver, "#rrggbb"

    @property
    def dt(self) -> float:
        return self.rollout.scenario.clock.dt

    @property
    def duration(self) -> float:
        """Seconds; an accident may end a drive in the middle of a decision."""
        return (len(self.rollout.states) - 1) * self.dt

    def at(self, t: float) -> np.ndarray:
        """All cars at a time, (vehicles, 10): on the straight line from one recorded state to the next.

        The lane and the mark of a crash are those of the state before; the acceleration, which holds for the whole
        step, that of the state after.
        """
        states, step = self.rollout.states, min(max(t, 0.0), self.duration) / self.dt
        before = int(step + 1e-9)
        cars = interpolate_states(states, step)
        cars[:, [LANE, CRASHED]] = states[before][:, [LANE, CRASHED]]
        cars[:, ACCELERATION] = states[min(before + 1, len(states) - 1), :, ACCELERATION]
        return cars

    def step(self, t: float) -> int:
        """Number of simulation steps that are over at time t, 0 .. states - 1."""
        return min(int(t / self.dt + 1e-9), len(self.rollout.states) - 1)

    def decision(self, t: float) -> int:
        """Index of the decision that is being carried out at time t, 0 .. decisions - 1."""
        return min(self.earned(t), len(self.rollout.actions) - 1)

    def earned(self, t: float) -> int:
        """Number of decisions that are over at time t, whose rewards count, 0 .. decisions."""
        decisions = len(self.rollout.actions)
        if t >= self.duration - 1e-9:
            return decisions
        return min(max(int(t * self.rollout.scenario.clock.decision_rate + 1e-9), 0), decisions)
