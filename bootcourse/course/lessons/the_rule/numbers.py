"""What the numbers and claims in this lesson's text are computed from, beside tools/course/known.py."""

import dataclasses
from functools import cache

import numpy as np

from bootcourse.episodes.evaluate import Episodes, drive_episodes, held_out_seeds
from bootcourse.episodes.record import record
from bootcourse.policies import rule_policy
from bootcourse.road.state import EGO, LANE, SPEED, X
from bootcourse.rule import SETTLED as SETTLED
from bootcourse.scenario import DEFAULT


@cache
def sighted(
    sight: float,
    n: int = DEFAULT.rule.n,
    t_safe: float = DEFAULT.rule.t_safe,
    politeness: float = DEFAULT.traffic.politeness,
) -> Episodes:
    """The rule with another sight (m), n speeds and another t_safe (s), on the lesson's 200 roads.

    politeness: of the other drivers, which make way for a faster car behind them.
    """
    rule = dataclasses.replace(DEFAULT.rule, n=n, t_safe=t_safe)
    seen = dataclasses.replace(DEFAULT.sight, distance=sight)
    driver = rule_policy(dataclasses.replace(DEFAULT, rule=rule, sight=seen))
    traffic = dataclasses.replace(DEFAULT.traffic, politeness=politeness)
    return drive_episodes(driver, held_out_seeds(1, 200), dataclasses.replace(DEFAULT, traffic=traffic))


@cache
def median_distance(roads: int = 20) -> float:
    """The median distance (m) to the next car in the left lane, from 30 s on, over the rule's first roads."""
    distances = []
    for drive in record(rule_policy(DEFAULT), range(roads)):
        for cars in drive.states[30 * DEFAULT.clock.steps :: DEFAULT.clock.steps]:
            ahead = cars[(cars[:, LANE] == 0) & (cars[:, X] > cars[EGO, X]), X]
            if cars[EGO, LANE] == 0:
                distances.append(ahead.min() - cars[EGO, X] if len(ahead) else np.inf)
    return float(np.median(distances))


@cache
def above_14(n: int) -> float:
    """In which share of its seconds the rule with n speeds drives faster than 14 m/s, on the lesson's roads."""
    driver = rule_policy(dataclasses.replace(DEFAULT, rule=dataclasses.replace(DEFAULT.rule, n=n)))
    speeds = [drive.states[:: DEFAULT.clock.steps, EGO, SPEED] for drive in record(driver, held_out_seeds(1, 200))]
    return float(np.mean(np.concatenate(speeds) > 14))
