"""Evaluation of a policy on held-out roads, with 95 % intervals."""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from gymnasium.vector import AutoresetMode

from bootcourse.episodes.driving import steps
from bootcourse.errors import whole
from bootcourse.policies import Policy
from bootcourse.road.state import Accident
from bootcourse.road.vector_env import TrapVectorEnv
from bootcourse.scenario import DEFAULT, Scenario
from bootcourse.statistics import Estimate, interval, mean, rate

BLOCK = 1_000_000  # held-out roads of evaluation seed s are s x BLOCK, s x BLOCK + 1, ...
MAX_SEED = 2**32 // BLOCK - 1  # training roads have seeds above 2**32, so held-out roads differ from them


@dataclass(frozen=True)
class Episodes:
    """The results of some episodes; every array is (episodes,)."""

    success: np.ndarray  # bool: ahead of trap 1 at the end
    returns: np.ndarray  # sum of rewards
    speed: np.ndarray  # m/s, distance over time
    distance: np.ndarray  # m
    accident: np.ndarray  # int, the number of an `Accident`


@dataclass(frozen=True)
class Evaluation:
    """The columns of the paper's tables, with its "collision rate" split into three. Rates are from 0 to 1."""

    episodes: int
    success: Estimate  # rate
    returns: Estimate
    speed: Estimate  # m/s
    distance: Estimate  # m
    collision: Estimate  # rate
    road_departure: Estimate  # rate
    stoppage: Estimate  # rate


def held_out_seeds(seed: int, episodes: int) -> range:
    """The seeds of the held-out roads of block `seed`. Raises BootcourseError for a seed or number out of range."""
    first = whole(seed, "seed", MAX_SEED) * BLOCK
    return range(first, first + whole(episodes, "episodes", BLOCK, low=1))


def drive_episodes(
    policy: Policy, seeds: Sequence[int], scenario: Scenario = DEFAULT, together: int = 1000
) -> Episodes:
    """Drive one episode on the compiled road of each seed, `together` at a time: `Episodes` in the order of seeds."""
    parts = [_drive(policy, list(seeds[i : i + together]), scenario) for i in range(0, len(seeds), together)]
    return Episodes(*(np.concatenate(columns) for columns in zip(*parts, strict=True)))


def _drive(policy: Policy, seeds: list[int], scenario: Scenario) -> tuple[np.ndarray, ...]:
    env = TrapVectorEnv(len(seeds), scenario, AutoresetMode.DISABLED)  # after an episode's end its reward is 0
    returns, accident = np.zeros(len(seeds)), np.zeros(len(seeds), dtype=np.int64)
    for step in steps(policy, env, seeds):
        returns += step.rewards
        accident = np.maximum(accident, step.infos["accident"])
    seconds, infos = env.decisions / scenario.clock.decision_rate, step.infos
    return infos["is_success"], returns, infos["distance"] / seconds, infos["distance"], accident


def evaluate(policy: Policy, episodes: int = 1000, scenario: Scenario = DEFAULT, seed: int = 1) -> Evaluation:
    """Drive a policy on the first `episodes` held-out roads of block `seed`: an `Evaluation` with 95 % intervals.

    Raises BootcourseError for a seed, or a number of episodes, that is out of range.
    """
    return summarise(drive_episodes(policy, held_out_seeds(seed, episodes), scenario))


def summarise(episodes: Episodes) -> Evaluation:
    """The `Evaluation` of episodes: rates with Clopper-Pearson intervals, means with Student's t intervals."""
    return Evaluation(
        episodes=len(episodes.success),
        success=rate(episodes.success),
        returns=mean(episodes.returns),
        speed=mean(episodes.speed),
        distance=mean(episodes.distance),
        collision=rate(episodes.accident == Accident.COLLISION),
        road_departure=rate(episodes.accident == Accident.ROAD_DEPARTURE),
        stoppage=rate(episodes.accident == Accident.STOPPAGE),
    )


def over_seeds(reports: Sequence[Evaluation]) -> dict[str, Estimate]:
    """The mean over training seeds of each column, with a percentile bootstrap interval over seeds."""
    names = [name for name in vars(reports[0]) if name != "episodes"]
    return {name: interval([getattr(report, name).value for report in reports], np.mean) for name in names}
