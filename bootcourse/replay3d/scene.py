"""What is drawn where at time t, as numbers computed from rollouts. `stage.py` draws it in the browser.

On the road y grows to the right (as in highway-env), which with z up is a left-handed system. The world is
right-handed: x along the road, y = minus the road's y, to the left, z up; yaw = minus the road's heading.
`to_world` and `to_yaw` convert.

The world moves with the driver: x = 0 is where the followed car is now, and the road slides past. So a camera that
does not move in the world travels with the car, and the mouse can turn it at any time.
"""

import math
from dataclasses import dataclass

import numpy as np

from bootcourse.episodes.lookahead import nine_drives
from bootcourse.episodes.rollout import Rollout
from bootcourse.episodes.words import ACCIDENTS
from bootcourse.errors import BootcourseError
from bootcourse.policies import Policy
from bootcourse.replay3d.road import SHOULDER
from bootcourse.replay3d.timeline import Moment, Timeline
from bootcourse.road.state import EGO, HEADING, TRAP_1, TRAP_2, Accident, X, Y
from bootcourse.rule import Reason
from bootcourse.scenario import Road

ROADS, GHOSTS = "side by side", "ghosts on one road"
LAYOUTS = (ROADS, GHOSTS)
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
class RuleMarks:
    """The rule's target lane and the gap that its lane change needs, to be drawn on the road."""

    lane_y: float  # world y of the target lane's centre
    gap_x: float  # world x of the front bumper, from which the gap is measured
    gap_y: float  # world y of the lane whose gap counts
    gap: float  # m, the safety distance
    blocked: bool  # does the rule hold back because of it?


@dataclass(frozen=True)
class DriveView:
    """One drive at one time, in world coordinates around `anchor`; (n,) arrays are per car, the ego first."""

    anchor: float  # m along the road that is drawn at the world's x = 0
    offset: float  # world y of the leftmost lane's centre
    x: np.ndarray  # (n,) m
    y: np.ndarray  # (n,) m, before `offset`
    yaw: np.ndarray  # (n,) rad
    lamps: tuple[str, ...]  # (n,) "brake", "power" or "off"
    marked: np.ndarray  # (n,) bool: in an accident
    crumbs: np.ndarray  # (CRUMBS, 4): x along the road (not around the anchor), y, z, yaw
    rule: RuleMarks | None
    labels: dict[int, str]  # car -> text above it
    ended: bool
    decision: int  # that is being carried out


def timelines_of(rollouts, futures: Policy | None = None) -> list[Timeline]:
    """One rollout, or several, ready to be shown together. Raises BootcourseError if they cannot be.

    futures: the base policy of the nine drives that are imagined at each decision of each rollout.
    """
    rollouts = [rollouts] if isinstance(rollouts, Rollout) else list(rollouts)
    if not rollouts:
        raise BootcourseError("There is no rollout to replay: give at least one.")
    if len(rollouts) > 8:
        raise BootcourseError(f"{len(rollouts)} drives are too many to compare: choose at most 8.")
    first = rollouts[0]
    for rollout in rollouts:
        if not isinstance(rollout, Rollout):
            raise BootcourseError(f"Cannot replay {type(rollout).__name__}: give a Rollout, or a list of them.")
        if len(rollout.states) < 2 or not np.isfinite(rollout.states).all():
            raise BootcourseError(f"The states of '{rollout.label}' are empty or not finite: record this drive again.")
        if rollout.scenario != first.scenario:
            raise BootcourseError(
                f"'{rollout.label}' drove scenario '{rollout.scenario.name}', '{first.label}' drove "
                f"'{first.scenario.name}' with other numbers: compare drives of one scenario."
            )
        if rollout.seed != first.seed:
            raise BootcourseError(
                f"'{rollout.label}' drove road {rollout.seed}, '{first.label}' road {first.seed}: "
                "compare drives of the same seed."
            )
    return [Timeline(one, nine_drives(one.cars, futures, one.scenario) if futures else None) for one in rollouts]


def offsets(count: int, lanes: int, lane_width: float, layout: str) -> list[float]:
    """World y of each drive's leftmost lane; y = 0 is the middle of all roads together."""
    middle = (lanes - 1) / 2 * lane_width
    pitch = lanes * lane_width + 2 * SHOULDER + ROAD_GAP if layout == ROADS else 0.0
    return [middle + pitch * ((count - 1) / 2 - k) for k in range(count)]


def span(road: Road, drives: int, layout: str) -> float:
    """Width of all roads together, m."""
    count = drives if layout == ROADS else 1
    return count * (road.lanes * road.lane_width + 2 * SHOULDER) + (count - 1) * ROAD_GAP


def view(timelines: list[Timeline], t: float, layout: str = ROADS, follow: int = 0) -> list[DriveView]:
    """All drives at time t. Each road moves with its own ego; with ghosts, all move with the followed ego."""
    road = timelines[0].rollout.scenario.road
    shifts = offsets(len(timelines), road.lanes, road.lane_width, layout)
    moments = [timeline.at(t) for timeline in timelines]
    views = []
    for timeline, moment, offset in zip(timelines, moments, shifts, strict=True):
        leader = moment if layout == ROADS else moments[follow]
        anchor, ended = float(leader.x[EGO]), t >= timeline.duration
        x, y = to_world(moment.x - anchor, moment.y)
        marked = moment.crashed.copy()
        marked[EGO] |= ended and timeline.rollout.accident != Accident.NONE
        view = DriveView(
            anchor=anchor,
            offset=offset,
            x=x,
            y=y,
            yaw=to_yaw(moment.heading),
            lamps=tuple("brake" if a < BRAKES else "power" if a > PUSHES else "off" for a in moment.acceleration),
            marked=marked,
            crumbs=crumbs(timeline, t),
            rule=_rule_marks(timeline, moment, t, anchor),
            labels=_labels(timeline, moment, ended),
            ended=ended,
            decision=timeline.decision(t),
        )
        views.append(view)
    return views


def crumbs(timeline: Timeline, t: float) -> np.ndarray:
    """The ego's last places, one per simulation step up to time t, newest last: (CRUMBS, 4) x, y, z, yaw."""
    states = timeline.rollout.states
    newest = min(int(t / timeline.dt + 1e-9), len(states) - 1)
    rows = np.arange(newest - CRUMBS + 1, newest + 1)
    ego = states[np.clip(rows, 0, None), EGO]
    x, y = to_world(ego[:, X], ego[:, Y])
    z = np.where(rows >= 0, CRUMB_Z, HIDDEN_Z)
    return np.column_stack([x, y, z, to_yaw(ego[:, HEADING])])


def _rule_marks(timeline: Timeline, moment: Moment, t: float, anchor: float) -> RuleMarks | None:
    rollout = timeline.rollout
    if rollout.rule_lanes is None or rollout.rule_distances is None:
        return None
    k, width = timeline.decision(t), rollout.scenario.road.lane_width
    lane_wanted, lane = int(rollout.rule_lanes[k]), int(moment.lane[EGO])
    gap_lane = lane_wanted if lane_wanted != lane else max(lane - 1, 0)
    reason = Reason(int(rollout.rule_reasons[k])) if rollout.rule_reasons is not None else Reason.FREE
    return RuleMarks(
        lane_y=to_world(0.0, lane_wanted * width)[1],
        gap_x=float(moment.x[EGO]) - anchor + rollout.scenario.car.length / 2,
        gap_y=to_world(0.0, gap_lane * width)[1],
        gap=float(rollout.rule_distances[k]),
        blocked=reason in (Reason.FALL_BACK, Reason.WAIT_FOR_FOLLOWER),
    )


def _labels(timeline: Timeline, moment: Moment, ended: bool) -> dict[int, str]:
    length = timeline.rollout.scenario.car.length
    labels = {}
    for trap, name in TRAPS.items():
        ahead = float(moment.x[trap] - moment.x[EGO])
        gap = abs(ahead) - length
        if gap <= 0:
            labels[trap] = f"{name}: beside you"
        elif abs(ahead) <= NEAR:
            labels[trap] = f"{name}: {gap:.1f} m {'ahead' if ahead > 0 else 'behind'}"
    if ended and timeline.rollout.accident:
        labels[EGO] = ACCIDENTS[Accident(timeline.rollout.accident)]
    return labels
