"""The rule with other numbers, on the lesson's roads: a sight (m), n speeds, t_safe (s), a floor (m)."""

import dataclasses
from collections.abc import Mapping
from functools import cache

import numpy as np

from bootcourse.course import table
from bootcourse.episodes.evaluate import Episodes, drive_episodes, held_out_seeds
from bootcourse.episodes.record import record
from bootcourse.episodes.rollout import Rollout
from bootcourse.policies import PolicyOutput, rule_policy
from bootcourse.road.state import EGO, TRAP_1, X
from bootcourse.rule import rule
from bootcourse.scenario import DEFAULT, Scenario

ROADS = held_out_seeds(1, 200)
# the other drivers do not weigh what the car behind them gains: none makes way
ALOOF = dataclasses.replace(DEFAULT, traffic=dataclasses.replace(DEFAULT.traffic, politeness=0.0))


def with_numbers(sight: float = DEFAULT.sight.distance, **numbers) -> Scenario:
    """The scenario in which the rule has another sight, and other numbers of `bootcourse.scenario.Rule`."""
    rule = dataclasses.replace(DEFAULT.rule, **numbers)
    return dataclasses.replace(DEFAULT, rule=rule, sight=dataclasses.replace(DEFAULT.sight, distance=sight))


@cache
def driven(sight: float = DEFAULT.sight.distance, among: Scenario = DEFAULT, **numbers) -> Episodes:
    """How the rule with these numbers drives among a scenario's drivers; the roads stay the same."""
    return drive_episodes(rule_policy(with_numbers(sight, **numbers)), ROADS, among)


@cache
def recorded(road: int, sight: float = DEFAULT.sight.distance, among: Scenario = DEFAULT) -> Rollout:
    """One drive of the rule with another sight (m) among a scenario's drivers."""
    return record(rule_policy(with_numbers(sight)), [road], among, label="rule")[0]


@cache
def crash(sight: float = 20.0) -> Rollout:
    """The first drive on the lesson's roads in which the rule with this sight (m) crashes, with its own reasons."""
    scenario = with_numbers(sight)  # among DEFAULT's drivers the drive is the same, but notes the reasons at 200 m
    road = ROADS[int(np.argmax(driven(sight).accident > 0))]
    return record(rule_policy(scenario), [road], scenario, label=f"rule, sight {sight:g} m")[0]


def timed(scenario: Scenario) -> tuple[Episodes, np.ndarray]:
    """How the rule drives, and the decision (that is, the second) from which each drive that gets out is ahead."""
    behind = []

    def drive(observations: np.ndarray, cars: np.ndarray) -> PolicyOutput:
        behind.append(cars[:, EGO, X] <= cars[:, TRAP_1, X])
        return PolicyOutput(rule(cars, scenario).actions)

    drives = drive_episodes(drive, ROADS, together=len(ROADS))
    last = len(behind) - np.argmax(behind[::-1], axis=0)
    return drives, last[drives.success]


def ranked(rules: Mapping[str, Mapping[str, float]]):
    """A table of the rules with these numbers, the highest return first, with the time until they are ahead."""
    rows = []
    for name, numbers in rules.items():
        drives, times = timed(with_numbers(**numbers))
        after = f"{np.median(times):.0f} s" if len(times) else "–"
        counts = f"{drives.success.sum()}", f"{(drives.accident > 0).sum()}"
        rows.append((drives.returns.mean(), [name, f"{drives.returns.mean():.1f}", after, *counts]))
    ordered = [row for _, row in sorted(rows, key=lambda row: -row[0])]
    columns = ["", "return", "ahead of trap 1 after", "get out, of 200", "crash"]
    return table(columns, ordered, below="The time is the median of the drives that get out.")
