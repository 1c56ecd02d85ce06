"""What the numbers and claims in this lesson's text are computed from, beside tools/course/known.py."""

import dataclasses
from collections.abc import Callable
from functools import cache
from typing import NamedTuple

import numpy as np

from bootcourse.episodes.evaluate import Episodes, drive_episodes, held_out_seeds
from bootcourse.episodes.record import record
from bootcourse.policies import PolicyOutput, policy_of, rule_policy
from bootcourse.road.constants import constants
from bootcourse.road.state import EGO, LANE, SPEED, TRAP_1, TRAP_2, X
from bootcourse.rule import SETTLED as SETTLED
from bootcourse.rule import Reason, rule, track
from bootcourse.scenario import DEFAULT, RULE_P, Scenario


def set_to(sight: float, **settings) -> Scenario:
    """The scenario in which the rule has another sight (m), and other n, t_safe (s) or floor (m)."""
    numbers = dataclasses.replace(DEFAULT.rule, **settings)
    return dataclasses.replace(DEFAULT, rule=numbers, sight=dataclasses.replace(DEFAULT.sight, distance=sight))


@cache
def sighted(sight: float, politeness: float = DEFAULT.traffic.politeness, **settings) -> Episodes:
    """The rule with other numbers, see `set_to`, on the lesson's 200 roads.

    politeness: of the other drivers, which make way for a faster car behind them.
    """
    world = dataclasses.replace(DEFAULT, traffic=dataclasses.replace(DEFAULT.traffic, politeness=politeness))
    return drive_episodes(rule_policy(set_to(sight, **settings)), held_out_seeds(1, 200), world)


class Changes(NamedTuple):
    """The rule's lane changes in which the formula, not the floor, gives the safety distance, and what else it did."""

    speeds: np.ndarray  # m/s, at the first such decision of each road that has one
    faster: np.ndarray  # m/s, by how much that is faster than trap 2
    crashed: int  # how many of these roads end in an accident
    waits: int  # decisions on all roads to wait for a car behind


@cache
def by_the_formula(sight: float, t_safe: float = DEFAULT.rule.t_safe, roads: int = 200) -> Changes:
    """Where the formula decides, with another sight (m) and t_safe (s)."""
    scenario, decided = set_to(sight, t_safe=t_safe), []

    def drive(observations: np.ndarray, cars: np.ndarray) -> PolicyOutput:
        decisions, speeds = rule(cars, scenario), cars[:, EGO, SPEED].copy()
        decided.append((decisions.reasons, decisions.distances, speeds, speeds - cars[:, TRAP_2, SPEED]))
        return PolicyOutput(decisions.actions)

    episodes = drive_episodes(drive, held_out_seeds(1, roads), together=roads)
    reasons, distances, speeds, faster = map(np.array, zip(*decided, strict=True))
    found = (reasons == Reason.CHANGE) & (distances > scenario.rule.floor)
    at = found.argmax(0)[found.any(0)], np.flatnonzero(found.any(0))
    crashed = int((episodes.accident[at[1]] > 0).sum())
    return Changes(speeds[at], faster[at], crashed, int((reasons == Reason.WAIT_FOR_FOLLOWER).sum()))


def _ahead(cars: np.ndarray, lane: int) -> tuple[float, float]:
    """The distance (m) to the next car of a lane ahead of the ego, and its speed (m/s); both infinite for no car."""
    distances = np.where(cars[:, LANE] == lane, cars[:, X] - cars[EGO, X], -1.0)
    distances = np.where((distances > 0) & (distances <= DEFAULT.sight.distance), distances, np.inf)
    nearest = int(distances.argmin())
    return (distances[nearest], cars[nearest, SPEED]) if np.isfinite(distances[nearest]) else (np.inf, np.inf)


@cache
def changing_when(test: Callable[[float, float], bool]) -> Episodes:
    """The rule on the lesson's roads, but it changes lane when `test` holds.

    test: of the distance closed in during t_safe, and of that to the new car ahead, from centre to centre (m).
    """
    c = constants(DEFAULT)

    def decide(cars: np.ndarray) -> np.ndarray:
        decisions = rule(cars, DEFAULT)
        actions = decisions.actions.copy()
        for road in np.flatnonzero(np.isin(decisions.reasons, (Reason.FALL_BACK, Reason.CHANGE))):
            lane = int(cars[road, EGO, LANE])
            (_, v_current), (dx_new, v_new) = _ahead(cars[road], lane), _ahead(cars[road], lane - 1)
            closing = (cars[road, EGO, SPEED] - min(v_current, v_new)) * DEFAULT.rule.t_safe
            actions[road] = track(cars[road], decisions.speeds[road], lane - test(closing, dx_new), c)
        return actions

    return drive_episodes(policy_of(decide), held_out_seeds(1, 200))


def as_printed(closing: float, dx_new: float) -> bool:
    return closing > dx_new


def sign_turned(closing: float, dx_new: float) -> bool:
    return closing < dx_new


def apart() -> tuple[float, float]:
    """The smallest and the largest distance (m) from trap 2 to trap 1 at the start, over the lesson's roads."""
    starts = [drive.states[0] for drive in _drives(DEFAULT.rule.n)]
    distances = [cars[TRAP_1, X] - cars[TRAP_2, X] for cars in starts]
    return min(distances), max(distances)


@cache
def erring_in(part: str, roads: int = 1000) -> float:
    """The share of unhurt drives if the rule steers or accelerates in another way as often as the stochastic rule.

    Of the eight other actions six steer in another way, and six accelerate in another.
    """
    rng = np.random.default_rng(0)

    def decide(cars: np.ndarray) -> np.ndarray:
        acceleration, steering = np.divmod(rule(cars, DEFAULT).actions, 3)
        errs, by = rng.random(len(cars)) < 6 / 8 * (1 - RULE_P), rng.integers(1, 3, len(cars))
        if part == "steering":
            steering = np.where(errs, (steering + by) % 3, steering)
        else:
            acceleration = np.where(errs, (acceleration + by) % 3, acceleration)
        return 3 * acceleration + steering

    return float(np.mean(drive_episodes(policy_of(decide), held_out_seeds(2, roads)).accident == 0))


MEDIAN_ROADS = 20


@cache
def median_distance(roads: int = MEDIAN_ROADS) -> float:
    """The median distance (m) to the next car in the left lane, from 30 s on, over the rule's first roads."""
    distances = []
    for drive in record(rule_policy(DEFAULT), range(roads)):
        for cars in drive.states[30 * DEFAULT.clock.steps :: DEFAULT.clock.steps]:
            ahead = cars[(cars[:, LANE] == 0) & (cars[:, X] > cars[EGO, X]), X]
            if cars[EGO, LANE] == 0:
                distances.append(ahead.min() - cars[EGO, X] if len(ahead) else np.inf)
    return float(np.median(distances))


@cache
def _drives(n: int) -> list:
    """The drives of the rule with n speeds on the lesson's roads."""
    return record(rule_policy(set_to(DEFAULT.sight.distance, n=n)), held_out_seeds(1, 200))


@cache
def above_14(n: int) -> float:
    """In which share of its seconds the rule with n speeds drives faster than 14 m/s, on the lesson's roads."""
    speeds = [drive.states[:: DEFAULT.clock.steps, EGO, SPEED] for drive in _drives(n)]
    return float(np.mean(np.concatenate(speeds) > 14))
