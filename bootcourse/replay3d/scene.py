"""What is drawn where at time t, as numbers computed from rollouts. `stage.py` draws it in the browser.

On the road y grows to the right (as in highway-env), which with z up is a left-handed system. The world is
right-handed: x along the road, y = minus the road's y, to the left, z up; yaw = minus the road's heading.
`to_world` and `to_yaw` convert.

The world moves with the driver: x = 0 is where the ego is now, and the road slides past. So a camera that does not move
in the world travels with the car, and the mouse can turn it at any time.
"""

import math
from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from bootcourse.episodes.lookahead import nine_drives
from bootcourse.episodes.rollout import Rollout
from bootcourse.episodes.words import ACCIDENTS
from bootcourse.errors import BootcourseError
from bootcourse.plots.figure import styles
from bootcourse.policies import Policy
from bootcourse.replay3d.road import SHOULDER
from bootcourse.replay3d.timeline import Timeline
from bootcourse.road.state import ACCELERATION, CRASHED, EGO, HEADING, TRAP_1, TRAP_2, Accident, X, Y
from bootcourse.scenario import Road

ROAD_GAP = 5.0  # m of ground between two roads side by side
CRUMBS = 80  # dots of the path driven, one per simulation step: the last 40 s
CRUMB_Z, HIDDEN_Z = 0.07, -3.0  # m; dots that do not exist yet are hidden below the ground
BRAKES, PUSHES = -0.15, 0.15  # m/s²: accelerations below and above which the rear lamps change colour
TRAPS = {TRAP_1: "trap 1", TRAP_2: "trap 2"}
NEAR = 80.0  # m: a trap further away than this has no distance label


def to_world(x, y):
    """A point of the road (x, y) in world coordinates."""
    return x, -y


def to_yaw(heading):
    """The world's yaw (rad, left is positive) of a heading on the road (right is positive)."""
    return -heading


def quaternion(yaw: float) -> tuple[float, float, float, float]:
    """A rotation by `yaw` about z, as a quaternion (w, x, y, z)."""
    return math.cos(yaw / 2), 0.0, 0.0, math.sin(yaw / 2)


@dataclass(frozen=True)
class DriveView:
    """One drive at one time, in world coordinates around its ego; (n,) arrays are per car, the ego first."""

    anchor: float  # m along the road that is drawn at the world's x = 0
    x: np.ndarray  # (n,) m
    y: np.ndarray  # (n,) m, from the leftmost lane's centre
    yaw: np.ndarray  # (n,) rad
    lamps: tuple[str, ...]  # (n,) "brake", "power" or "off"
    marked: np.ndarray  # (n,) bool: in an accident
    labels: dict[int, str]  # car -> text above it
    ended: bool
    decision: int  # that is being carried out
    step: int  # of the simulation, the last that is over: the path on the road changes with it


def timelines_of(rollouts: Rollout | Sequence[Rollout], futures: Policy | None = None) -> list[Timeline]:
    """One rollout, or several, ready to be shown together. Raises BootcourseError if they cannot be.

    futures: the base policy of the nine drives that are imagined at each decision of each rollout.
    """
    rollouts = [rollouts] if isinstance(rollouts, Rollout) else list(rollouts)
    if not 1 <= len(rollouts) <= 8:
        raise BootcourseError(f"There are {len(rollouts)} drives to replay: give one to 8.")
    first = rollouts[0]
    for rollout in rollouts:
        if not isinstance(rollout, Rollout):
            raise BootcourseError(f"Cannot replay {type(rollout).__name__}: give a Rollout, or a list of them.")
        if len(rollout.states) < 2 or not np.isfinite(rollout.states).all():
            raise BootcourseError(f"The states of '{rollout.label}' are empty or not finite: record this drive again.")
        if rollout.scenario != first.scenario or rollout.seed != first.seed:
            raise BootcourseError(
                f"'{rollout.label}' drove road {rollout.seed} of the scenario '{rollout.scenario.name}', "
                f"'{first.label}' road {first.seed} of '{first.scenario.name}': compare drives of the same road."
            )
    looks = styles([rollout.label for rollout in rollouts])
    return [
        Timeline(one, nine_drives(one.cars, futures, one.scenario) if futures else None, look.colour)
        for one, look in zip(rollouts, looks, strict=True)
    ]


def offsets(count: int, road: Road) -> list[float]:
    """World y of each drive's leftmost lane, the roads side by side; y = 0 is the middle of all together."""
    pitch = road.lanes * road.lane_width + 2 * SHOULDER + ROAD_GAP
    return [(road.lanes - 1) / 2 * road.lane_width + pitch * ((count - 1) / 2 - k) for k in range(count)]


def span(count: int, road: Road) -> float:
    """Width of all roads together, m."""
    return count * (road.lanes * road.lane_width + 2 * SHOULDER) + (count - 1) * ROAD_GAP


def view(timeline: Timeline, t: float) -> DriveView:
    """A drive at time t (s)."""
    cars, ended = timeline.at(t), t >= timeline.duration
    anchor, marked = float(cars[EGO, X]), cars[:, CRASHED] != 0
    x, y = to_world(cars[:, X] - anchor, cars[:, Y])
    marked[EGO] |= ended and timeline.rollout.accident != Accident.NONE
    return DriveView(
        anchor=anchor,
        x=x,
        y=y,
        yaw=to_yaw(cars[:, HEADING]),
        lamps=tuple("brake" if a < BRAKES else "power" if a > PUSHES else "off" for a in cars[:, ACCELERATION]),
        marked=marked,
        labels=_labels(timeline, cars, ended),
        ended=ended,
        decision=timeline.decision(t),
        step=timeline.step(t),
    )


def crumbs(timeline: Timeline, t: float) -> np.ndarray:
    """The ego's last places, one per simulation step up to time t, newest last: (CRUMBS, 4) x, y, z, yaw.

    x runs along the road (not around the anchor).
    """
    states, newest = timeline.rollout.states, timeline.step(t)
    rows = np.arange(newest - CRUMBS + 1, newest + 1)
    ego = states[np.clip(rows, 0, None), EGO]
    x, y = to_world(ego[:, X], ego[:, Y])
    z = np.where(rows >= 0, CRUMB_Z, HIDDEN_Z)
    return np.column_stack([x, y, z, to_yaw(ego[:, HEADING])])


def _labels(timeline: Timeline, cars: np.ndarray, ended: bool) -> dict[int, str]:
    length, labels = timeline.rollout.scenario.car.length, {}
    for trap, name in TRAPS.items():
        ahead = float(cars[trap, X] - cars[EGO, X])
        gap = abs(ahead) - length
        if gap <= 0:
            labels[trap] = f"{name}: beside you"
        elif abs(ahead) <= NEAR:
            labels[trap] = f"{name}: {gap:.1f} m {'ahead' if ahead > 0 else 'behind'}"
    if ended and timeline.rollout.accident:
        labels[EGO] = ACCIDENTS[Accident(timeline.rollout.accident)]
    return labels
