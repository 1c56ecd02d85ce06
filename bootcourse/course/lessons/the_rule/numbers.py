"""What the numbers and claims in this lesson's text are computed from, beside tools/course/known.py."""

from dataclasses import replace
from functools import cache
from typing import NamedTuple

import numpy as np

from bootcourse.course.lessons.the_rule.explorable import braking_distance as braking_distance
from bootcourse.course.lessons.the_rule.figures import tells_apart
from bootcourse.course.lessons.the_rule.rules import ROADS, makes_way_at, with_numbers
from bootcourse.course.lessons.the_rule.rules import as_printed as as_printed
from bootcourse.course.lessons.the_rule.rules import crash as crash
from bootcourse.course.lessons.the_rule.rules import decided as decided
from bootcourse.course.lessons.the_rule.rules import driven as driven
from bootcourse.course.lessons.the_rule.rules import fast_changes as fast_changes
from bootcourse.course.lessons.the_rule.rules import recorded as recorded
from bootcourse.course.lessons.the_rule.rules import split as split
from bootcourse.episodes.evaluate import drive_episodes
from bootcourse.episodes.rollout import Rollout
from bootcourse.policies import rule_policy
from bootcourse.road.state import EGO, LANE, SPEED, TRAP_1, TRAP_2, X
from bootcourse.rule import SETTLED as SETTLED
from bootcourse.rule import Reason
from bootcourse.scenario import DEFAULT


def lost_in_change(floor: float) -> np.ndarray:
    """On which of the lesson's roads the rule with a sight of 20 m loses trap 1 in the first second of its first lane
    change.
    """
    reasons, _, cars, _ = decided(20.0, floor=floor)
    changes, sees = reasons == Reason.CHANGE, cars[:, :, TRAP_1, X] - cars[:, :, EGO, X] <= 20.0
    return ~sees[changes.argmax(0) + 1, np.arange(len(ROADS))] & changes.any(0)


def called_off() -> np.ndarray:
    """Which drives (roads,) with a sight of 20 m call off the first lane change that they begin.

    Four seconds later the car is still in its lane, and one second after the change began the rule sees nobody ahead.
    """
    reasons, _, cars, _ = decided(20.0)
    changes, roads = reasons == Reason.CHANGE, np.arange(len(ROADS))
    began, lanes = changes.argmax(0), cars[:, :, EGO, LANE]
    completed = lanes[began + 4, roads] < lanes[began, roads]
    return changes.any(0) & ~completed & (reasons[began + 1, roads] == Reason.FREE)


def lost_and_done(second: int) -> float:
    """Of the drives with a sight of 20 m that lose trap 1 in this second of their first lane change, and not before,
    the share that completes it.
    """
    reasons, _, cars, _ = decided(20.0)
    began, roads = (reasons == Reason.CHANGE).argmax(0), np.arange(len(ROADS))
    lanes, unseen = cars[:, :, EGO, LANE], cars[:, :, TRAP_1, X] - cars[:, :, EGO, X] > 20.0
    changes = (reasons == Reason.CHANGE).any(0)
    loses = changes & unseen[began + second, roads] & ~unseen[began + second - 1, roads]
    return float((lanes[began + 4, roads] < lanes[began, roads])[loses].mean())


def begun() -> np.ndarray:
    """How many lane changes each drive (roads,) with a sight of 20 m begins."""
    changes = decided(20.0)[0] == Reason.CHANGE
    return changes[0] + (changes[1:] & ~changes[:-1]).sum(0)


def waiting() -> np.ndarray:
    """Which drives (roads,) with a sight of 20 m stay behind, without an accident."""
    return ~driven(20.0).success & (driven(20.0).accident == 0)


def lost_before_room() -> np.ndarray:
    """The roads on which a drive with a sight of 20 m falls back for want of room until trap 1 is out of sight, and
    then stays behind, without a lane change.
    """
    reasons, _, cars, _ = decided(20.0)
    roads = np.flatnonzero(~(reasons == Reason.CHANGE).any(0) & waiting())
    ends = (reasons[:, roads] != Reason.FALL_BACK).argmax(0)
    far = cars[ends, roads, TRAP_1, X] - cars[ends, roads, EGO, X] > 20.0
    return roads[(ends > 0) & far & (reasons[ends, roads] == Reason.FREE)]


def shrinks() -> np.ndarray:
    """By how much (m) the gap to trap 2 shrinks in three seconds of braking, of the `fast_changes` that get out."""
    reasons, _, cars, episodes = decided(20.0)
    ego, trap = cars[:, :, EGO], cars[:, :, TRAP_2]
    gap, faster = trap[..., X] - ego[..., X] - DEFAULT.car.length, ego[..., SPEED] - trap[..., SPEED]
    fast = (reasons == Reason.CHANGE) & (trap[..., LANE] == ego[..., LANE] - 1) & (gap > 0) & (faster > 2.5)
    roads = np.flatnonzero(fast.any(0) & (episodes.accident == 0))
    first = fast.argmax(0)[roads]
    return gap[first, roads] - gap[first + 3, roads]


@cache
def ignored(sight: float) -> float:
    """What the rule with this sight (m) earns on the lesson's roads if no driver heeds those behind."""
    traffic = replace(DEFAULT.traffic, politeness=0.0)
    return float(
        drive_episodes(rule_policy(with_numbers(sight)), ROADS, replace(DEFAULT, traffic=traffic)).returns.mean()
    )


def tells() -> float:
    """The gap (m) that tells the fast changes that crash from those that get out."""
    return tells_apart(fast_changes())


def gap(drive: Rollout, second: int) -> float:
    """The room (m) between the ego and trap 2, from bumper to bumper."""
    ego, trap = drive.states[second * drive.scenario.clock.steps, [EGO, TRAP_2], X]
    return trap - ego - drive.scenario.car.length


def faster(drive: Rollout, second: int) -> float:
    """By how much (m/s) the ego is faster than trap 2."""
    ego, trap = drive.states[second * drive.scenario.clock.steps, [EGO, TRAP_2], SPEED]
    return ego - trap


@cache
def change() -> tuple[float, float, int]:
    """With a sight of 30 m: how far ahead trap 1 is (m) when the first lane change begins, at least and at most over
    the lesson's roads, and after how many seconds the slowest change ends in the next lane.
    """
    reasons, _, cars, _ = decided(30.0)
    roads, lanes = np.arange(len(ROADS)), cars[:, :, EGO, LANE]
    began = (reasons == Reason.CHANGE).argmax(0)
    ahead = (cars[:, :, TRAP_1, X] - cars[:, :, EGO, X])[began, roads]
    takes = next(k for k in range(1, 10) if (lanes[began + k, roads] != lanes[began, roads]).all())
    return ahead.min(), ahead.max(), takes


def slower_in_change() -> float:
    """By how much the rule (sight 30 m) is slower than trap 1 (m/s) in the seconds of `change`, at the most."""
    reasons, _, cars, _ = decided(30.0)
    began, roads = (reasons == Reason.CHANGE).argmax(0), np.arange(len(ROADS))
    slower = cars[:, :, TRAP_1, SPEED] - cars[:, :, EGO, SPEED]
    return max(slower[began + k, roads].max() for k in range(change()[2] + 1))


class Followed(NamedTuple):
    """The car ahead in the rule's lane, at some decisions."""

    car: np.ndarray  # its number
    distance: np.ndarray  # m
    speed: np.ndarray  # m/s


def followed(drive: Rollout, first: int, last: int | None = None) -> Followed:
    """From a second on: the car that the rule follows, at each decision to follow one in the leftmost lane."""
    steps = drive.scenario.clock.steps
    at = first + np.flatnonzero(drive.rule_reasons[first:last] == Reason.LEFTMOST)
    cars = drive.states[at * steps]
    ahead = cars[..., X] - cars[:, [EGO], X]
    distances = np.where((cars[..., LANE] == cars[:, [EGO], LANE]) & (ahead > 0), ahead, np.inf)
    car = distances.argmin(axis=1)
    return Followed(car, distances.min(axis=1), cars[np.arange(len(at)), car, SPEED])


def makes_way(drive: Rollout, car: int) -> float:
    """How far ahead (m) a car is when it leaves the leftmost lane with the rule in it; infinite if it does not."""
    at = makes_way_at(drive, car)
    return float("inf") if at is None else float(drive.states[at, car, X] - drive.states[at, EGO, X])


def closes_in() -> float:
    """How fast (m/s) the rule with a sight of 30 m drives when car 4 makes way on the lesson's road."""
    drive = recorded(10, 30.0)
    return float(drive.states[makes_way_at(drive, 4), EGO, SPEED])
