"""What the numbers and claims in this lesson's text are computed from, beside tools/course/known.py."""

from functools import cache
from typing import NamedTuple

import numpy as np

from bootcourse.course.lessons.the_rule.rules import ROADS, with_numbers
from bootcourse.course.lessons.the_rule.rules import driven as driven
from bootcourse.episodes.evaluate import drive_episodes
from bootcourse.episodes.record import record
from bootcourse.policies import PolicyOutput, rule_policy
from bootcourse.road.state import EGO, SPEED, TRAP_1, TRAP_2, X
from bootcourse.rule import SETTLED as SETTLED
from bootcourse.rule import Reason, rule
from bootcourse.scenario import DEFAULT


class Changes(NamedTuple):
    """The rule's lane changes in which the formula, not the floor, gives the safety distance."""

    speeds: np.ndarray  # m/s, at the first such decision of each road that has one
    faster: np.ndarray  # m/s, by how much that is faster than trap 2
    crashed: int  # how many of these roads end in an accident


@cache
def by_the_formula(sight: float) -> Changes:
    """Where the formula decides, with another sight (m), on the lesson's roads."""
    scenario, decided = with_numbers(sight), []

    def drive(observations: np.ndarray, cars: np.ndarray) -> PolicyOutput:
        decisions, speeds = rule(cars, scenario), cars[:, EGO, SPEED].copy()
        decided.append((decisions.reasons, decisions.distances, speeds, speeds - cars[:, TRAP_2, SPEED]))
        return PolicyOutput(decisions.actions)

    episodes = drive_episodes(drive, ROADS, together=len(ROADS))
    reasons, distances, speeds, faster = map(np.array, zip(*decided, strict=True))
    found = (reasons == Reason.CHANGE) & (distances > scenario.rule.floor)
    at = found.argmax(0)[found.any(0)], np.flatnonzero(found.any(0))
    return Changes(speeds[at], faster[at], int((episodes.accident[at[1]] > 0).sum()))


@cache
def begun_in_sight(floor: float, sight: float = 20.0) -> int:
    """On how many of the lesson's roads trap 1 is in sight when the rule first begins to change lane."""
    scenario, decided = with_numbers(sight, floor=floor), []

    def drive(observations: np.ndarray, cars: np.ndarray) -> PolicyOutput:
        decisions = rule(cars, scenario)
        sees = cars[:, TRAP_1, X] - cars[:, EGO, X] <= sight
        decided.append((decisions.reasons == Reason.CHANGE, sees))
        return PolicyOutput(decisions.actions)

    drive_episodes(drive, ROADS, together=len(ROADS))
    changes, sees = map(np.array, zip(*decided, strict=True))
    return int((sees[changes.argmax(0), np.arange(len(ROADS))] & changes.any(0)).sum())


@cache
def apart() -> tuple[float, float]:
    """The smallest and the largest distance (m) from trap 2 to trap 1 at the start, over the lesson's roads."""
    starts = [drive.states[0] for drive in record(rule_policy(DEFAULT), ROADS)]
    distances = [cars[TRAP_1, X] - cars[TRAP_2, X] for cars in starts]
    return min(distances), max(distances)
