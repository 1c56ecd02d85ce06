"""Is a road the same in shorter steps? What happens on it, by how many steps of the simulation a second has."""

from dataclasses import replace
from functools import cache
from typing import NamedTuple

import numpy as np

from bootcourse.episodes.evaluate import drive_episodes
from bootcourse.episodes.record import record
from bootcourse.policies import idle_policy, rule_policy
from bootcourse.road.state import TRAFFIC, Y
from bootcourse.scenario import DEFAULT

OURS = (DEFAULT.traffic.tau_heading, DEFAULT.traffic.tau_lateral)  # s
HIGHWAY_ENVS = (0.2, 0.6)


class Seen(NamedTuple):
    """On some roads."""

    leaves: float  # share on which a traffic car leaves the road, while the ego does nothing
    gets_out: float  # share on which the rule gets out
    earned: float  # mean return of the rule


@cache
def seen(taus: tuple[float, float], rate: int, roads: int = 100) -> Seen:
    """With traffic of these time constants (s), of the heading and of the lane, at `rate` steps a second."""
    traffic = replace(DEFAULT.traffic, tau_heading=taus[0], tau_lateral=taus[1])
    scenario = replace(DEFAULT, traffic=traffic, clock=replace(DEFAULT.clock, simulation_rate=rate))
    road = scenario.road
    middle, half = road.lane_width * (road.lanes - 1) / 2, road.lane_width * road.lanes / 2
    idle = record(idle_policy, range(roads), scenario)
    leaves = [np.any(abs(drive.states[:, TRAFFIC:, Y] - middle) > half) for drive in idle]
    by_rule = drive_episodes(rule_policy(scenario), range(roads), scenario)
    return Seen(float(np.mean(leaves)), float(by_rule.success.mean()), float(by_rule.returns.mean()))
