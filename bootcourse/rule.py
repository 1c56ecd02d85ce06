"""The rule controller (Section III-D, Algorithm 1) and its stochastic form π̃.

It drives slower than both traps until trap 2 is far enough ahead, changes to the lane behind it, changes left again,
and overtakes. The paper computes a target speed and a target lane, and cites a controller that reaches them; the
tracker below is our own. Corrections to the printed algorithm are marked (erratum).
"""

import math
from dataclasses import dataclass
from enum import IntEnum

import numpy as np

from bootcourse.errors import BootcourseError
from bootcourse.road.compiled import compiled, compiled_loop
from bootcourse.road.constants import constants
from bootcourse.road.formulas import bicycle_step
from bootcourse.road.state import COLUMNS, EGO, HEADING, LANE, SPEED, X, Y
from bootcourse.road.traffic import FRONT, NOBODY, REAR, look_around, new_around, sort_by_x
from bootcourse.scenario import N_ACTIONS, Scenario, check_p


class Reason(IntEnum):
    """The reason for a decision of the rule."""

    FREE = 0  # no car ahead in this lane: stay
    CHANGE = 1  # there is room in the lane to the left: change
    FALL_BACK = 2  # the gap to the new car ahead is shorter than the safety distance
    WAIT_FOR_FOLLOWER = 3  # a car behind in the target lane is too close
    LEFTMOST = 4  # no lane is left to change to: follow
    SETTLE = 5  # still on the way into this lane: one lane at a time


SENTENCES = {
    Reason.FREE: "nobody ahead: stay in lane",
    Reason.CHANGE: "room on the left: change lane",
    Reason.FALL_BACK: "not enough room on the left: fall back",
    Reason.WAIT_FOR_FOLLOWER: "a car comes up on the left: wait",
    Reason.LEFTMOST: "leftmost lane: follow",
    Reason.SETTLE: "finish this lane change first",
}


@compiled
def target_speed(v_current, v_target, v_min, v_max, n):
    """v_target (Equation 14): the fastest of n grid speeds that is slower than both preceding cars (m/s).

    v_current, v_target: speeds of the preceding cars in the current and the target lane, infinity for no car.
    v_min if no grid speed is slow enough (erratum: the paper does not define this case).
    """
    chosen = v_min
    for i in range(1, n):
        v = v_min + i / (n - 1) * (v_max - v_min)
        if v < min(v_current, v_target):
            chosen = v
    return chosen


@compiled
def safety_distance(v_ego, v_current, v_target, t_safe, floor):
    """d_s (Equation 13): the bumper-to-bumper gap (m) to the new preceding car that a lane change needs.

    (v_e - min(v_current, v_target)) t_safe, at least `floor`. (Erratum: the printed d_s adds Δx_current - Δx_target;
    the printed condition d_s - Δx_current > 0 then means "change when the gap is *shorter* than this", which is
    false whenever the ego is slower than the traps.)
    """
    return max(floor, (v_ego - min(v_current, v_target)) * t_safe)


@compiled
def decide_rule(cars, around, c):
    """Algorithm 1 on one road, cars (vehicles, 10): (target speed, target lane, safety distance, reason)."""
    lane, x, v = int(cars[EGO, LANE]), cars[EGO, X], cars[EGO, SPEED]
    front = around[lane, EGO, FRONT]
    if front != NOBODY and cars[front, X] - x > c.sight:
        front = NOBODY
    v_current = cars[front, SPEED] if front != NOBODY else math.inf
    if front == NOBODY or lane == 0:
        reason = Reason.FREE if front == NOBODY else Reason.LEFTMOST
        return target_speed(v_current, v_current, c.rule_v_min, c.rule_v_max, c.rule_n), lane, c.floor, reason.value

    new_front, new_rear = around[lane - 1, EGO, FRONT], around[lane - 1, EGO, REAR]
    if new_front != NOBODY and cars[new_front, X] - x > c.sight:
        new_front = NOBODY
    v_new = cars[new_front, SPEED] if new_front != NOBODY else math.inf
    speed = target_speed(v_current, v_new, c.rule_v_min, c.rule_v_max, c.rule_n)
    distance = safety_distance(v, v_current, v_new, c.t_safe, c.floor)
    if cars[EGO, Y] - lane * c.lane_width > SETTLED:
        return speed, lane, distance, Reason.SETTLE.value
    if new_front != NOBODY and cars[new_front, X] - x - c.length <= distance:
        return speed, lane, distance, Reason.FALL_BACK.value
    if new_rear != NOBODY:
        v_rear = cars[new_rear, SPEED]
        if x - cars[new_rear, X] - c.length <= max(c.floor, (v_rear - v) * c.t_safe):
            return speed, lane, distance, Reason.WAIT_FOR_FOLLOWER.value
    return speed, lane - 1, distance, Reason.CHANGE.value


SETTLED = 0.5  # m; a further lane change begins only within this distance of the lane's centre
HEADING_COST = 20.0  # m² per rad²: weight of the squared heading against the squared distance from the lane's centre
STRAIGHT_FIRST = (1, 0, 2)  # order of the search: of two sequences with the same cost, straight wins
EDGE_COST = 1e6  # m²; added to a sequence that leaves the road


@compiled
def track(cars, speed, lane, c):
    """Our tracker: the action (0..8) that brings the ego nearest to a speed (m/s) and a lane.

    It accelerates or brakes if that reduces the speed error. It steers by searching three decisions ahead: all 27
    sequences of left, straight and right through the bicycle model, then the first step of the cheapest. (Rounding a
    continuous controller's steering works in a narrow range of its time constant only: below it the car leaves the
    road, above it the car stays behind the traps or collides.)
    """
    error = speed - cars[EGO, SPEED]
    sign = 0 if abs(error) <= c.ego_acceleration / 2 else (1 if error > 0 else -1)
    acceleration = sign * c.ego_acceleration
    goal, best, best_cost = lane * c.lane_width, 1, math.inf
    for first in STRAIGHT_FIRST:
        a = _ahead((cars[EGO, Y], cars[EGO, HEADING], cars[EGO, SPEED], 0.0), acceleration, first, goal, c)
        for second in STRAIGHT_FIRST:
            b = _ahead(a, acceleration, second, goal, c)
            if b[3] >= best_cost:
                continue
            for third in STRAIGHT_FIRST:
                cost = _ahead(b, 0.0, third, goal, c)[3]
                if cost < best_cost - 1e-12:
                    best, best_cost = first, cost
    return (sign + 1) * 3 + best


@compiled
def _ahead(state, acceleration, steer, goal, c):
    """(y, heading, speed, cost) after one more decision of the bicycle model."""
    y, heading, v, cost = state
    for _ in range(c.steps):
        _, y, heading, v = bicycle_step(0.0, y, heading, v, acceleration, (steer - 1) * c.ego_steering, c.length, c.dt)
    cost += (y - goal) ** 2 + HEADING_COST * heading**2
    if not -c.lane_width / 2 <= y <= (c.lanes - 0.5) * c.lane_width:
        cost += EDGE_COST
    return y, heading, v, cost


@compiled_loop
def drive_rule(cars, c, actions, speeds, lanes, distances, reasons):
    """The rule on every road: reads cars (roads, vehicles, 10), fills the five arrays (roads,)."""
    order, around = np.arange(cars.shape[1]), new_around(cars.shape[1], c)
    for road in range(cars.shape[0]):
        sort_by_x(cars[road], order)
        look_around(cars[road], order, around, c)
        speeds[road], lanes[road], distances[road], reasons[road] = decide_rule(cars[road], around, c)
        actions[road] = track(cars[road], speeds[road], lanes[road], c)


@dataclass(frozen=True)
class RuleDecisions:
    """The rule's decision on each road and its reason; every array is (roads,)."""

    actions: np.ndarray  # int, 0..8
    speeds: np.ndarray  # target speed, m/s
    lanes: np.ndarray  # target lane, 0 is the leftmost
    distances: np.ndarray  # safety distance, m, bumper to bumper
    reasons: np.ndarray  # a Reason's number


def rule(cars: np.ndarray, scenario: Scenario) -> RuleDecisions:
    """The rule controller μ: cars (roads, vehicles, 10) -> `RuleDecisions`.

    It reads the true state, not the observation. For TrapEnv: `rule(env.unwrapped.cars()[None], scenario)`.
    Raises BootcourseError for another shape, or an ego outside the scenario's lanes.
    """
    if cars.ndim != 3 or cars.shape[2] != COLUMNS:
        raise BootcourseError(f"cars have shape {cars.shape}: give (roads, vehicles, {COLUMNS}), as in `cars[None]`.")
    lanes = cars[:, EGO, LANE]
    if len(cars) and not (lanes.min() >= 0 and lanes.max() < scenario.road.lanes):
        raise BootcourseError(
            f"The ego is in lane {lanes.max()}: this scenario has lanes 0..{scenario.road.lanes - 1}."
        )
    c = constants(scenario)
    n = len(cars)
    decisions = RuleDecisions(
        np.empty(n, np.int64), np.empty(n), np.empty(n, np.int64), np.empty(n), np.empty(n, np.int64)
    )
    drive_rule(
        cars, c, decisions.actions, decisions.speeds, decisions.lanes, decisions.distances, decisions.reasons
    )  # fmt: skip
    return decisions


def stochastic_rule(rule_actions: np.ndarray, p: float, n_actions: int = N_ACTIONS) -> np.ndarray:
    """π̃(a|s) (Equation 16): p for the rule's action, (1 - p) / 8 for each other. (…,) int -> (…, 9).

    Raises BootcourseError if p is outside [1/9, 1).
    """
    check_p(p)
    rule_actions = np.asarray(rule_actions)
    return np.where(np.arange(n_actions) == rule_actions[..., None], p, (1 - p) / (n_actions - 1))


def sample_stochastic_rule(
    rule_actions: np.ndarray, p: float, rng: np.random.Generator, n_actions: int = N_ACTIONS
) -> np.ndarray:
    """Draw an action from π̃ (Equation 16) for each of the rule's actions. (n,) int -> (n,) int.

    Raises BootcourseError if p is outside [1/9, 1).
    """
    check_p(p)
    others = (rule_actions + rng.integers(1, n_actions, size=np.shape(rule_actions))) % n_actions
    return np.where(rng.random(np.shape(rule_actions)) < p, rule_actions, others)
