"""The lesson's road in shorter steps, and with traffic that corrects its heading faster."""

from collections.abc import Sequence
from dataclasses import replace

import numpy as np

from bootcourse.course import table
from bootcourse.episodes.evaluate import drive_episodes, held_out_seeds
from bootcourse.policies import plan_policy
from bootcourse.scenario import DEFAULT, Scenario

OURS, HIGHWAY_ENVS = DEFAULT.traffic.tau_heading, 0.2  # s, time constants of the heading


def road(tau: float, step: float) -> Scenario:
    """The road whose traffic has this time constant of the heading (s), in steps of so many seconds."""
    clock = replace(DEFAULT.clock, simulation_rate=round(1 / step))
    return replace(DEFAULT, traffic=replace(DEFAULT.traffic, tau_heading=tau), clock=clock)


def unhurt(plan: Sequence[str | tuple[str, int]], tau: float, step: float) -> float:
    """On which share of the study's 1,000 held-out roads, so changed, a plan in words gets out unhurt."""
    drives = drive_episodes(plan_policy(plan), held_out_seeds(1, 1000), road(tau, step))
    return float(np.mean((drives.success > 0) & (drives.accident == 0)))


def compared(plan: Sequence[str | tuple[str, int]]):
    """A table: on how many of these roads the plan gets out unhurt, by the traffic's time constant and the step."""
    rows = [
        [f"{tau} s, {whose}", *(f"{unhurt(plan, tau, step):.0%}" for step in (0.5, 0.25))]
        for tau, whose in ((OURS, "ours"), (HIGHWAY_ENVS, "highway-env's"))
    ]
    below = "of 1,000 roads, on which the plan gets out unhurt"
    return table(["traffic's time constant", "in steps of 0.5 s", "in steps of 0.25 s"], rows, below=below)
