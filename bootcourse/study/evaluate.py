"""Held-out episodes: how well a driver drives, with 95 % intervals."""

from collections.abc import Sequence
from dataclasses import asdict, dataclass
from typing import NamedTuple

import numpy as np
from gymnasium.vector import AutoresetMode
from scipy import stats

from bootcourse.drivers import Driver
from bootcourse.errors import BootcourseError
from bootcourse.road.state import Accident
from bootcourse.road.vector_env import TrapVectorEnv
from bootcourse.scenario import DEFAULT, Scenario

BLOCK = 1_000_000  # held-out roads of evaluation seed s are s x BLOCK, s x BLOCK + 1, ...
MAX_SEED = 2**32 // BLOCK - 1  # training roads lie above 2**32: nothing is ever tested where it was trained


class Estimate(NamedTuple):
    """A number with its 95 % interval."""

    value: float
    low: float
    high: float


@dataclass(frozen=True)
class Episodes:
    """What happened in each episode; every array is (episodes,)."""

    success: np.ndarray  # bool: ahead of trap 1 at the end
    returns: np.ndarray  # sum of rewards
    speed: np.ndarray  # m/s, distance over time
    distance: np.ndarray  # m
    accident: np.ndarray  # int, an Accident's number


@dataclass(frozen=True)
class Report:
    """The columns of the paper's tables, with its "collision rate" taken apart."""

    episodes: int
    success: Estimate
    returns: Estimate
    speed: Estimate  # m/s
    distance: Estimate  # m
    collision: Estimate
    road_departure: Estimate
    stoppage: Estimate

    def to_dict(self) -> dict:
        return {
            name: value._asdict() if isinstance(value, Estimate) else value
            for name, value in ((name, getattr(self, name)) for name in asdict(self))
        }


def held_out_seeds(seed: int, episodes: int) -> range:
    """The roads of an evaluation. Raises BootcourseError for a seed or number that would leave its block."""
    if not 0 <= seed <= MAX_SEED:
        raise BootcourseError(f"seed = {seed}: give a whole number from 0 to {MAX_SEED}.")
    if not 1 <= episodes <= BLOCK:
        raise BootcourseError(f"episodes = {episodes}: give a whole number from 1 to {BLOCK}.")
    return range(seed * BLOCK, seed * BLOCK + episodes)


def drive_episodes(
    driver: Driver, seeds: Sequence[int], scenario: Scenario = DEFAULT, together: int = 1000
) -> Episodes:
    """One episode on the road of each seed, on the compiled road, `together` at a time."""
    parts = [_drive(driver, list(seeds[i : i + together]), scenario) for i in range(0, len(seeds), together)]
    return Episodes(*(np.concatenate(columns) for columns in zip(*parts, strict=True)))


def _drive(driver: Driver, seeds: list[int], scenario: Scenario) -> tuple[np.ndarray, ...]:
    env = TrapVectorEnv(len(seeds), scenario, AutoresetMode.DISABLED)
    observations, infos = env.reset(seed=seeds)
    returns, accident = np.zeros(len(seeds)), np.zeros(len(seeds), dtype=np.int64)
    while not env.asleep.all():
        observations, rewards, _, _, infos = env.step(driver(observations, env.cars).actions)
        returns += rewards
        accident = np.maximum(accident, infos["accident"])
    seconds = env.decisions / scenario.clock.decision_rate
    return infos["is_success"], returns, infos["distance"] / seconds, infos["distance"], accident


def rate(hits: np.ndarray) -> Estimate:
    """A rate with its exact (Clopper-Pearson) interval: hits (n,) bool."""
    test = stats.binomtest(int(np.sum(hits)), len(hits))
    low, high = test.proportion_ci(confidence_level=0.95, method="exact")
    return Estimate(test.statistic, float(low), float(high))


def mean(values: np.ndarray) -> Estimate:
    """A mean with Student's t interval: values (n,). One value has no interval: NaN."""
    value = float(np.mean(values))
    if len(values) < 2:
        return Estimate(value, float("nan"), float("nan"))
    half = stats.t.ppf(0.975, len(values) - 1) * stats.sem(values)
    return Estimate(value, value - float(half), value + float(half))


def report(episodes: Episodes) -> Report:
    """The summary of some episodes."""
    return Report(
        episodes=len(episodes.success),
        success=rate(episodes.success),
        returns=mean(episodes.returns),
        speed=mean(episodes.speed),
        distance=mean(episodes.distance),
        collision=rate(episodes.accident == Accident.COLLISION),
        road_departure=rate(episodes.accident == Accident.ROAD_DEPARTURE),
        stoppage=rate(episodes.accident == Accident.STOPPAGE),
    )


def over_seeds(reports: Sequence[Report]) -> dict[str, Estimate]:
    """Mean over training seeds of each column, with the percentile bootstrap interval over the seeds' own values."""
    names = [name for name in asdict(reports[0]) if name != "episodes"]
    values = np.array([[getattr(report, name).value for name in names] for report in reports])
    spread = stats.bootstrap((values,), np.mean, axis=0, method="percentile", rng=np.random.default_rng(0))
    low, high = spread.confidence_interval
    return {name: Estimate(*map(float, column)) for name, *column in zip(names, values.mean(0), low, high, strict=True)}
