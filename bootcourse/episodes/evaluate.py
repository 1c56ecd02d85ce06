"""Evaluation of a policy on held-out roads, or in the episodes of another environment, with 95 % intervals."""

from collections.abc import Callable, Sequence
from dataclasses import dataclass

import numpy as np
from gymnasium.vector import VectorEnv

from bootcourse.episodes.driving import one_episode_each, steps
from bootcourse.episodes.infos import known_success, reported
from bootcourse.episodes.place import place_of
from bootcourse.errors import whole
from bootcourse.policies import Policy
from bootcourse.road.state import Accident
from bootcourse.scenario import DEFAULT, Scenario
from bootcourse.statistics import Estimate, interval, mean, rate

BLOCK = 1_000_000  # held-out roads of evaluation seed s are s x BLOCK, s x BLOCK + 1, ...
MAX_SEED = 2**32 // BLOCK - 1  # training roads have seeds above 2**32, so held-out roads differ from them


@dataclass(frozen=True)
class Episodes:
    """The results of some episodes; every array is (episodes,), and NaN where the environment does not report it.

    `success` is unknown for all episodes or for none: see `episodes/infos.py`.
    """

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
    policy: Policy,
    seeds: Sequence[int],
    scenario: Scenario | None = DEFAULT,
    together: int = 1000,
    make_env: Callable[[int], VectorEnv] | None = None,
) -> Episodes:
    """Drive one episode on the compiled road of each seed, `together` at a time: `Episodes` in the order of seeds.

    make_env: makes a vector environment of n copies instead of the roads.
    """
    parts = []
    for i in range(0, len(seeds), together):
        part = list(seeds[i : i + together])
        env = one_episode_each(len(part), scenario, make_env)
        parts.append(_drive(policy, env, part))
    success, returns, speed, distance, accident = (np.concatenate(columns) for columns in zip(*parts, strict=True))
    success = known_success(success)
    return Episodes(
        success if np.isnan(success).any() else success.astype(bool),
        returns,
        speed,
        distance,
        accident if np.isnan(accident).any() else accident.astype(np.int64),
    )


def _drive(policy: Policy, env: VectorEnv, seeds: list[int]) -> tuple[np.ndarray, ...]:
    returns, decisions = np.zeros(len(seeds)), np.zeros(len(seeds))
    ends = {name: np.full(len(seeds), np.nan) for name in ("is_success", "distance", "accident")}
    for step in steps(policy, env, seeds):
        returns += step.rewards * step.running
        decisions += step.running
        ended = step.running & (step.terminated | step.truncated)
        for name, values in ends.items() if ended.any() else ():
            values[ended] = reported(name, step.infos, len(seeds))[ended]
    success, distance, accident = ends.values()
    return success, returns, distance / place_of(env).seconds(decisions), distance, accident


def evaluate(
    policy: Policy,
    episodes: int = 1000,
    scenario: Scenario | None = DEFAULT,
    seed: int = 1,
    make_env: Callable[[int], VectorEnv] | None = None,
) -> Evaluation:
    """Drive a policy on the first `episodes` held-out roads of block `seed`: an `Evaluation` with 95 % intervals.

    make_env: see `drive_episodes`. Raises BootcourseError for a seed, or a number of episodes, that is out of range.
    """
    return summarise(drive_episodes(policy, held_out_seeds(seed, episodes), scenario, make_env=make_env))


def summarise(episodes: Episodes) -> Evaluation:
    """The `Evaluation` of episodes: rates with Clopper-Pearson intervals, means with Student's t intervals."""
    return Evaluation(
        episodes=len(episodes.success),
        success=_rate(episodes.success, episodes.success == 1),
        returns=mean(episodes.returns),
        speed=mean(episodes.speed),
        distance=mean(episodes.distance),
        collision=_rate(episodes.accident, episodes.accident == Accident.COLLISION),
        road_departure=_rate(episodes.accident, episodes.accident == Accident.ROAD_DEPARTURE),
        stoppage=_rate(episodes.accident, episodes.accident == Accident.STOPPAGE),
    )


def _rate(reported: np.ndarray, hits: np.ndarray) -> Estimate:
    """The rate of hits (n,) bool; NaN where the environment reports nothing."""
    return Estimate(*[float("nan")] * 3) if np.isnan(reported).any() else rate(hits)


def over_seeds(reports: Sequence[Evaluation]) -> dict[str, Estimate]:
    """The mean over training seeds of each column, with a percentile bootstrap interval over seeds."""
    names = [name for name in vars(reports[0]) if name != "episodes"]
    return {name: interval([getattr(report, name).value for report in reports], np.mean) for name in names}
