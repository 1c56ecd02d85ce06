"""The rule with other numbers, on the lesson's roads: a sight (m), n speeds, t_safe (s), a floor (m)."""

import dataclasses
from collections.abc import Mapping, Sequence
from functools import cache

import numpy as np

from bootcourse.course import table
from bootcourse.episodes.evaluate import Episodes, drive_episodes, held_out_seeds
from bootcourse.episodes.record import record
from bootcourse.episodes.words import overtaken
from bootcourse.policies import rule_policy
from bootcourse.scenario import DEFAULT, Scenario

ROADS = held_out_seeds(1, 200)


def with_numbers(sight: float = DEFAULT.sight.distance, **numbers) -> Scenario:
    """The scenario in which the rule has another sight, and other numbers of `bootcourse.scenario.Rule`."""
    rule = dataclasses.replace(DEFAULT.rule, **numbers)
    return dataclasses.replace(DEFAULT, rule=rule, sight=dataclasses.replace(DEFAULT.sight, distance=sight))


@cache
def driven(sight: float = DEFAULT.sight.distance, **numbers) -> Episodes:
    """How the rule with these numbers drives; the roads and the other drivers stay the same."""
    return drive_episodes(rule_policy(with_numbers(sight, **numbers)), ROADS)


def ends(tried: Sequence[tuple[float, float, float]]):
    """A table of how the drives end, for each sight, t_safe and floor."""
    rows = []
    for sight, t_safe, floor in tried:
        drives = driven(sight, t_safe=t_safe, floor=floor)
        out, crashed = drives.success.sum(), (drives.accident > 0).sum()
        counts = f"{out}", f"{len(ROADS) - out - crashed}", f"{crashed}"
        rows.append([f"{sight:g} m", f"{t_safe:g} s", f"{floor:g} m", *counts, f"{drives.returns.mean():.0f}"])
    return table(["sight", "t_safe", "floor", "get out", "stay behind", "crash", "return"], rows)


def ranked(rules: Mapping[str, Mapping[str, float]]):
    """A table of the rules with these numbers, the highest return first, with the time until they are ahead."""
    rows = []
    for name, numbers in rules.items():
        drives = record(rule_policy(with_numbers(**numbers)), ROADS)
        times = [time for time in map(overtaken, drives) if time is not None]
        crashed = sum(drive.accident > 0 for drive in drives)
        returned = np.mean([drive.rewards.sum() for drive in drives])
        after = f"{np.median(times):.0f} s" if times else "–"
        rows.append((returned, [name, f"{returned:.1f}", after, f"{len(times)}", f"{crashed}"]))
    ordered = [row for _, row in sorted(rows, key=lambda row: -row[0])]
    columns = ["", "return", "ahead of trap 1 after", "get out, of 200", "crash"]
    return table(columns, ordered, below="The time is the median of the drives that get out.")
