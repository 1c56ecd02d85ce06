"""Named teachers from bad to perfect: what a teacher may be in a study (`Job.teacher`, `Variation.teacher`).

Most are the course's rule made worse. One is the rule with rollouts, which is better. All but the planner, the best,
answer for all roads in one call. A teacher is a function of the road's true state, so each gives the same answer
whenever it is asked about the same road: a study that is stopped goes on with the same labels. The order of `TEACHERS`
is that of the return that each earns when it drives itself.
"""

from functools import lru_cache
from typing import NamedTuple

import numpy as np

from bootcourse.episodes.lookahead import HORIZON, rollout_values
from bootcourse.errors import check_known
from bootcourse.learn.teachers import Rule, all_roads, course_rule, slow, with_name
from bootcourse.policies import rule_policy
from bootcourse.research.planner import planner_rule
from bootcourse.road.state import ACCELERATION, COLUMNS, HEADING, LANE, SPEED, TARGET_LANE, TRAFFIC, X, Y
from bootcourse.scenario import IDLE, N_ACTIONS, Scenario

LATE = 0.75  # s
REMEMBERED = 1000  # answers of the planner


def chance(cars: np.ndarray, stream: int) -> np.ndarray:
    """Numbers in [0, 1) that look random and depend on the state alone: cars (roads, vehicles, 10) -> (roads,).

    They depend on the places and speeds of the ego and the traps, to a millimetre (see `hashed`).
    """
    return hashed(cars[:, :TRAFFIC, [X, Y, SPEED]].reshape(len(cars), -1), stream)


def hashed(states: np.ndarray, stream: int) -> np.ndarray:
    """Numbers in [0, 1) that look random and depend on the states alone: (n, ...) -> (n,).

    SplitMix64 (Steele, Lea & Flood 2014) over the states to three decimals, so that another processor's rounding
    changes no draw.
    """
    seen = np.round(1000 * states.astype(np.float64)).astype(np.int64).view(np.uint64)
    mixed = np.full(len(states), stream, dtype=np.uint64)
    for column in seen.T:
        mixed = (mixed ^ column) + np.uint64(0x9E3779B97F4A7C15)
        mixed = (mixed ^ (mixed >> np.uint64(30))) * np.uint64(0xBF58476D1CE4E5B9)
        mixed = (mixed ^ (mixed >> np.uint64(27))) * np.uint64(0x94D049BB133111EB)
        mixed ^= mixed >> np.uint64(31)
    return (mixed >> np.uint64(11)) / 2.0**53


def at_random(share: float) -> Rule:
    """The rule with a share of its decisions replaced by one of the nine actions, each equally probable."""

    @all_roads
    def partly_random(cars: np.ndarray, scenario: Scenario) -> np.ndarray:
        drawn = (N_ACTIONS * chance(cars, 2)).astype(np.int64)
        return np.where(chance(cars, 1) < share, drawn, course_rule(cars, scenario))

    return with_name(partly_random, f"rule, {100 * share:g} % at random")


@all_roads
def mirrored(cars: np.ndarray, scenario: Scenario) -> np.ndarray:
    """The rule of a road whose left and right are exchanged: it keeps to the right lane, where trap 1 is."""
    last, seen = scenario.road.lanes - 1, cars.copy()
    seen[..., Y] = last * scenario.road.lane_width - cars[..., Y]
    seen[..., HEADING] *= -1
    seen[..., [LANE, TARGET_LANE]] = last - cars[..., [LANE, TARGET_LANE]]
    actions = course_rule(seen, scenario)
    return actions + 2 - 2 * (actions % 3)  # left for right


@all_roads
def timid(cars: np.ndarray, scenario: Scenario) -> np.ndarray:
    """Follows trap 1 to the end: keeps straight."""
    return np.full(len(cars), IDLE)


def as_it_was(cars: np.ndarray, seconds: float, scenario: Scenario) -> np.ndarray:
    """The road some seconds ago, if every car kept its heading and its acceleration since: the same shape as cars."""
    seen = cars.copy()
    seen[..., SPEED] = np.maximum(cars[..., SPEED] - seconds * cars[..., ACCELERATION], 0.0)
    driven = seconds * (seen[..., SPEED] + cars[..., SPEED]) / 2
    seen[..., X] -= driven * np.cos(cars[..., HEADING])
    seen[..., Y] -= driven * np.sin(cars[..., HEADING])
    seen[..., LANE] = np.clip(np.round(seen[..., Y] / scenario.road.lane_width), 0, scenario.road.lanes - 1)
    return seen


@all_roads
def late(cars: np.ndarray, scenario: Scenario) -> np.ndarray:
    """The rule with slow reactions: it does what was right `LATE` seconds ago, for its own place and speed too."""
    return course_rule(as_it_was(cars, LATE, scenario), scenario)


def remembering_planner() -> Rule:
    """The planner, which does not plan again for a road that it was asked about a moment ago."""
    plan = planner_rule()

    @lru_cache(REMEMBERED)
    def planned(state: bytes, scenario: Scenario) -> int:
        return plan(np.frombuffer(state).reshape(-1, COLUMNS), scenario)

    def planner(cars: np.ndarray, scenario: Scenario) -> int:
        return planned(cars.tobytes(), scenario)

    return slow(with_name(planner, plan.name))


@slow
@all_roads
def looking_ahead(cars: np.ndarray, scenario: Scenario) -> np.ndarray:
    """The rule with rollouts: the best of nine actions, each followed by the rule for the rest of the horizon."""
    return rollout_values(cars, rule_policy(scenario), HORIZON, scenario).argmax(axis=1)


class NamedTeacher(NamedTuple):
    """A teacher of a study."""

    words: str  # in figures
    rule: Rule


RULE, PLANNER = "rule", "planner"  # the default; the one that takes milliseconds for a decision
TEACHERS = {
    "random-50": NamedTeacher("rule, half at random", at_random(0.5)),
    "random-25": NamedTeacher("rule, a quarter at random", at_random(0.25)),
    "mirrored": NamedTeacher("rule, left for right", mirrored),
    "timid": NamedTeacher("stays behind trap 1", timid),
    "late": NamedTeacher(f"rule, {LATE:g} s late", late),
    RULE: NamedTeacher("rule", course_rule),
    "rule-rollouts": NamedTeacher("rule with rollouts", looking_ahead),
    PLANNER: NamedTeacher("planner", remembering_planner()),
}


def teacher_named(name: str) -> Rule:
    """The teacher of that name. Raises BootcourseError for an unknown one."""
    check_known("Teacher", name, TEACHERS)
    return TEACHERS[name].rule
