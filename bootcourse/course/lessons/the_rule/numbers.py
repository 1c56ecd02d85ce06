"""What the numbers and claims in this lesson's text are computed from, beside tools/course/known.py."""

from dataclasses import replace
from functools import cache
from typing import NamedTuple

import numpy as np

from bootcourse.course.lessons.the_rule.explorable import braking_distance as braking_distance
from bootcourse.course.lessons.the_rule.rules import ROADS, makes_way_at
from bootcourse.course.lessons.the_rule.rules import as_printed as as_printed
from bootcourse.course.lessons.the_rule.rules import crash as crash
from bootcourse.course.lessons.the_rule.rules import decided as decided
from bootcourse.course.lessons.the_rule.rules import driven as driven
from bootcourse.course.lessons.the_rule.rules import fast_changes as fast_changes
from bootcourse.course.lessons.the_rule.rules import paid as paid
from bootcourse.course.lessons.the_rule.rules import recorded as recorded
from bootcourse.course.lessons.the_rule.rules import sign_turned as sign_turned
from bootcourse.course.lessons.the_rule.rules import split as split
from bootcourse.episodes.evaluate import drive_episodes
from bootcourse.episodes.record import record
from bootcourse.episodes.rollout import Rollout
from bootcourse.policies import idle_policy, rule_policy
from bootcourse.research.claimed import UNGIVING
from bootcourse.road.state import EGO, LANE, SPEED, TRAP_1, TRAP_2, X
from bootcourse.rule import SETTLED as SETTLED
from bootcourse.rule import Reason
from bootcourse.scenario import DEFAULT


def called_off() -> np.ndarray:
    """Which drives (roads,) with a sight of 20 m call off the first lane change that they begin.

    Four seconds later the car is still in its lane, and one second after the change began the rule sees nobody ahead.
    """
    reasons, _, cars, _ = decided(20.0)
    changes, roads = reasons == Reason.CHANGE, np.arange(len(ROADS))
    began, lanes = changes.argmax(0), cars[:, :, EGO, LANE]
    completed = lanes[began + 4, roads] < lanes[began, roads]
    return changes.any(0) & ~completed & (reasons[began + 1, roads] == Reason.FREE)


def worths(sight: float, gamma: float) -> np.ndarray:
    """What each drive of the rule with this sight (m) is worth at its start, on 40 roads."""
    return paid(sight) @ gamma ** np.arange(paid(sight).shape[1])


def worth(sight: float, gamma: float = 0.8) -> float:
    """Their mean."""
    return float(worths(sight, gamma).mean())


def later_worth(sight: float) -> float:
    """What the rest of the rule's drives is worth ten seconds after their start, at γ = 0.8, the mean."""
    rest = paid(sight)[:, 10:]
    return float((rest @ 0.8 ** np.arange(rest.shape[1])).mean())


def had_they_stayed(sight: float) -> float:
    """What the rule's drives were worth at γ = 0.8 if their first ten seconds paid what staying pays, the mean."""
    weights = 0.8 ** np.arange(paid(sight).shape[1])
    staying = record(idle_policy, [10])[0].rewards[:10]
    return float((paid(sight)[:, 10:] @ weights[10:]).mean() + staying @ weights[:10])


def kept(target: float) -> set[float]:
    """The speeds (m/s) that the rule keeps for a target speed on the lesson's road, three decisions after it began."""
    drive = recorded(10)
    speeds, targets = drive.states[:: drive.scenario.clock.steps, EGO, SPEED], np.asarray(drive.rule_speeds)
    kept_for = [k for k in range(3, len(targets) - 1) if (targets[k - 3 : k + 1] == target).all()]
    return {round(float(speeds[k + 1]), 6) for k in kept_for}


def fastest_change() -> float:
    """By how much (m/s) the rule is faster than the slower trap in its fastest decision to change lane, on 200 roads:
    negative if it is slower in all of them.
    """
    reasons, _, cars, _ = decided(DEFAULT.sight.distance)
    speeds = cars[..., SPEED]
    faster = speeds[..., EGO] - np.minimum(speeds[..., TRAP_1], speeds[..., TRAP_2])
    return float(faster[reasons == Reason.CHANGE].max())


def first_apart() -> int:
    """After how many seconds the drives with a sight of 200 and of 30 m begin to differ on the lesson's road."""
    far, near = recorded(10), recorded(10, 30.0)
    steps = far.scenario.clock.steps
    differ = far.states[::steps, EGO, SPEED] != near.states[::steps, EGO, SPEED]
    return int(differ.argmax()) - 1


@cache
def among_impolite(sight: float) -> float:
    """The rule's mean return with this sight (m) on the 200 roads, among drivers that do not make way."""
    scenario = replace(UNGIVING, sight=replace(UNGIVING.sight, distance=sight))
    return float(drive_episodes(rule_policy(scenario), ROADS, scenario=scenario).returns.mean())


def impolite() -> Rollout:
    """The drive of the rule with a sight of 30 m on the lesson's road, among drivers that do not make way."""
    scenario = replace(UNGIVING, sight=replace(UNGIVING.sight, distance=30.0))
    return record(rule_policy(scenario), [10], scenario, label="rule")[0]


def gap(drive: Rollout, second: int) -> float:
    """The room (m) between the ego and trap 2, from bumper to bumper."""
    ego, trap = drive.states[second * drive.scenario.clock.steps, [EGO, TRAP_2], X]
    return trap - ego - drive.scenario.car.length


def faster(drive: Rollout, second: int) -> float:
    """By how much (m/s) the ego is faster than trap 2."""
    ego, trap = drive.states[second * drive.scenario.clock.steps, [EGO, TRAP_2], SPEED]
    return ego - trap


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
