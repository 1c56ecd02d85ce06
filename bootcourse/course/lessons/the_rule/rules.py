"""The rule with other numbers, on the lesson's roads: a sight (m), n speeds, t_safe (s), a floor (m).

`split` gives its two jobs, speed and lane, two sights; `by_hand` drives with a student's three functions.
"""

import dataclasses
import math
from collections.abc import Callable, Mapping
from functools import cache
from typing import NamedTuple

import numpy as np
from gymnasium.vector import AutoresetMode

from bootcourse.course import table
from bootcourse.episodes.driving import steps
from bootcourse.episodes.evaluate import Episodes, drive_episodes, held_out_seeds
from bootcourse.episodes.record import record
from bootcourse.episodes.rollout import Rollout
from bootcourse.learn.teachers import toward
from bootcourse.policies import PolicyOutput, policy_of, rule_policy
from bootcourse.road.constants import constants
from bootcourse.road.state import EGO, LANE, SPEED, TRAP_1, TRAP_2, X, Y
from bootcourse.road.traffic import FRONT, NOBODY, REAR, look_around, new_around, sort_by_x
from bootcourse.road.vector_env import TrapVectorEnv
from bootcourse.rule import SETTLED, Reason, rule
from bootcourse.scenario import DEFAULT, Scenario

ROADS = held_out_seeds(1, 200)


def with_numbers(sight: float = DEFAULT.sight.distance, **numbers) -> Scenario:
    """The scenario in which the rule has another sight, and other numbers of `bootcourse.scenario.Rule`."""
    rule = dataclasses.replace(DEFAULT.rule, **numbers)
    return dataclasses.replace(DEFAULT, rule=rule, sight=dataclasses.replace(DEFAULT.sight, distance=sight))


@cache
def decided(sight: float, **numbers) -> tuple[np.ndarray, np.ndarray, np.ndarray, Episodes]:
    """Each decision on the lesson's roads with these numbers: reasons and safety distances (decisions, roads), the cars
    (decisions, roads, vehicles, 10) that the rule saw, and how the drives end.
    """
    scenario, seen = with_numbers(sight, **numbers), []

    def drive(observations: np.ndarray, cars: np.ndarray) -> PolicyOutput:
        decisions = rule(cars, scenario)
        seen.append((decisions.reasons, decisions.distances, cars.copy()))
        return PolicyOutput(decisions.actions)

    episodes = drive_episodes(drive, ROADS, together=len(ROADS))
    return *map(np.array, zip(*seen, strict=True)), episodes


class FastChanges(NamedTuple):
    """Lane changes behind trap 2 that begin much faster than it drives, one of each drive."""

    gap: np.ndarray  # m, from bumper to bumper
    faster: np.ndarray  # m/s
    crashed: np.ndarray  # bool: the drive ends in an accident


def fast_changes(sight: float = 20.0, least: float = 2.5) -> FastChanges:
    """The first such change, by at least so many m/s, of each of the lesson's drives that has one."""
    reasons, _, cars, episodes = decided(sight)
    ego, trap = cars[:, :, EGO], cars[:, :, TRAP_2]
    faster, gap = ego[..., SPEED] - trap[..., SPEED], trap[..., X] - ego[..., X] - DEFAULT.car.length
    fast = (reasons == Reason.CHANGE) & (trap[..., LANE] == ego[..., LANE] - 1) & (gap > 0) & (faster > least)
    roads = np.flatnonzero(fast.any(0))
    first = fast.argmax(0)[roads], roads
    return FastChanges(gap[first], faster[first], episodes.accident[roads] > 0)


@cache
def driven(sight: float = DEFAULT.sight.distance, **numbers) -> Episodes:
    """How the rule with these numbers drives; the roads and the other drivers stay the same."""
    return drive_episodes(rule_policy(with_numbers(sight, **numbers)), ROADS)


@cache
def paid(sight: float, roads: int = 40) -> np.ndarray:
    """What each second of the rule with this sight (m) pays on the first of the lesson's roads, (roads, seconds)."""
    env = TrapVectorEnv(roads, DEFAULT, AutoresetMode.DISABLED)
    return np.stack([step.rewards for step in steps(rule_policy(with_numbers(sight)), env, ROADS[:roads])], axis=1)


@cache
def recorded(road: int, sight: float = DEFAULT.sight.distance) -> Rollout:
    """One drive of the rule with another sight (m)."""
    return record(rule_policy(with_numbers(sight)), [road], label="rule")[0]


@cache
def crash(sight: float = 20.0) -> Rollout:
    """The first drive on the lesson's roads in which the rule with this sight (m) crashes, with its own reasons."""
    scenario = with_numbers(sight)  # among DEFAULT's drivers the drive is the same, but notes the reasons at 200 m
    road = ROADS[int(np.argmax(driven(sight).accident > 0))]
    return record(rule_policy(scenario), [road], scenario, label=f"rule, sight {sight:g} m")[0]


def makes_way_at(drive: Rollout, car: int) -> int | None:
    """The state at which a car has left the leftmost lane with the rule in it; None if it does not."""
    cars = drive.states
    left = np.flatnonzero((cars[1:, car, LANE] > 0) & (cars[:-1, car, LANE] == 0) & (cars[1:, EGO, LANE] == 0))
    return int(1 + left[0]) if len(left) else None


def with_two_sights(speed_sight: float, lane_sight: float, **numbers) -> Callable[[np.ndarray], np.ndarray]:
    """The rule with a sight for the target speed (m) and another for the lane (m): cars -> actions."""
    for_speed, for_lane = with_numbers(speed_sight, **numbers), with_numbers(lane_sight, **numbers)

    def decide(cars: np.ndarray) -> np.ndarray:
        other = rule(cars, for_lane)
        if speed_sight == lane_sight:
            return other.actions
        one = rule(cars, for_speed)
        actions = np.where(one.lanes == other.lanes, one.actions, other.actions)
        for road in np.flatnonzero((one.lanes != other.lanes) & (one.speeds != other.speeds)):
            actions[road] = toward(cars[road], one.speeds[road], other.lanes[road])
        return actions

    return decide


@cache
def split(speed_sight: float, lane_sight: float) -> Episodes:
    """How it drives."""
    if speed_sight == lane_sight:
        return driven(lane_sight)
    return drive_episodes(policy_of(with_two_sights(speed_sight, lane_sight)), ROADS, together=len(ROADS))


def by_hand(speed_of: Callable, distance_of: Callable, has_room: Callable, roads: int = 20) -> Episodes:
    """The rule's five cases, with these three functions in place of the library's (`bootcourse.rule.decide_rule`)."""
    c = constants(DEFAULT)

    def decide(cars: np.ndarray) -> int:
        order, around, ego = np.arange(len(cars)), new_around(len(cars), c), cars[EGO]
        sort_by_x(cars, order)
        look_around(cars, order, around, c)

        def nearest(lane: int, side: int) -> tuple[float, float]:
            """The distance (m, positive) and the speed (m/s) of the next car in a lane, infinite for nobody."""
            i = around[lane, EGO, side]
            distance = math.inf if i == NOBODY else abs(cars[i, X] - ego[X])
            seen = i != NOBODY and (side == REAR or distance <= c.sight)
            return (distance, cars[i, SPEED]) if seen else (math.inf, math.inf)

        lane, grid = int(ego[LANE]), (c.rule_v_min, c.rule_v_max, c.rule_n)
        (distance, v_current), left = nearest(lane, FRONT), lane - 1
        if math.isinf(distance) or lane == 0:
            return toward(cars, speed_of(v_current, v_current, *grid), lane)
        (dx_front, v_new), (dx_rear, v_rear) = nearest(left, FRONT), nearest(left, REAR)
        speed, v = speed_of(v_current, v_new, *grid), ego[SPEED]
        if ego[Y] - lane * c.lane_width > SETTLED:
            return toward(cars, speed, lane)
        d_s = distance_of(v, v_current, v_new, c.t_safe, c.floor)
        v_rear = v_rear if dx_rear < math.inf else 0.0
        change = has_room(dx_front, dx_rear, c.length, d_s, v, v_rear, c.t_safe, c.floor)
        return toward(cars, speed, left if change else lane)

    return drive_episodes(policy_of(lambda cars: np.array([decide(each) for each in cars])), ROADS[:roads])


def without_floor(v_ego, v_current, v_new, t_safe, floor):
    """The left side of the printed condition, m."""
    return (v_ego - min(v_current, v_new)) * t_safe


@cache
def as_printed(speed_of: Callable) -> Episodes:
    """The same with the printed condition: change lane if d_s, which has no floor, is longer than the distance."""
    return by_hand(speed_of, without_floor, lambda dx_front, dx_rear, length, d_s, *rest: d_s > dx_front)


@cache
def sign_turned(speed_of: Callable) -> Episodes:
    """The printed condition with its sign turned: change lane if d_s, still without a floor, is the shorter one."""
    return by_hand(speed_of, without_floor, lambda dx_front, dx_rear, length, d_s, *rest: d_s < dx_front)


def timed(decide: Callable[[np.ndarray], np.ndarray]) -> tuple[Episodes, np.ndarray]:
    """How a rule drives, and the decision (that is, the second) from which each drive that gets out is ahead."""
    behind = []

    def note(cars: np.ndarray) -> np.ndarray:
        behind.append(cars[:, EGO, X] <= cars[:, TRAP_1, X])
        return decide(cars)

    drives = drive_episodes(policy_of(note), ROADS, together=len(ROADS))
    last = len(behind) - np.argmax(behind[::-1], axis=0)
    return drives, last[drives.success]


def ranked(rules: Mapping[str, Mapping[str, float]]):
    """A table of the rules with these numbers, the highest return first, with the time until they are ahead.

    speed_sight, lane_sight: the sight for the target speed, and that for the lane if it is another.
    """
    rows = []
    for name, numbers in rules.items():
        others = dict(numbers)
        for_speed = others.pop("speed_sight", DEFAULT.sight.distance)
        drives, times = timed(with_two_sights(for_speed, others.pop("lane_sight", for_speed), **others))
        after = f"{np.median(times):.0f} s" if len(times) else "–"
        counts = f"{drives.success.sum()}", f"{(drives.accident > 0).sum()}"
        rows.append((drives.returns.mean(), [name, f"{drives.returns.mean():.1f}", after, *counts]))
    ordered = [row for _, row in sorted(rows, key=lambda row: -row[0])]
    return table(["", "return", "ahead after (median)", "get out, of 200", "crash"], ordered)
