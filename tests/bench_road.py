"""How many decisions a second? The compiled road against `TrapEnv`, on one thread, in one run.

First one car: what `gym.make` gives for either, wrappers included. Then many roads, in whole episodes, resets included:
the compiled road through `VectorEnv.step` with autoreset, `TrapEnv` through its own `step` without gymnasium's wrappers
and with its own observation, not highway-env's slow one. Time is this thread's own processor time, and of several
repetitions of the same episodes the fastest counts, so that other programs do not.
"""

import time
from dataclasses import dataclass

import gymnasium as gym
import numpy as np

import bootcourse  # noqa: F401  registers the road
from bootcourse.road.trap_env import TrapEnv
from bootcourse.rule import rule
from bootcourse.scenario import DEFAULT, IDLE

ROADS, EPISODES, REPETITIONS = 256, 2, 7


@dataclass
class Row:
    """One line of the table: a speed and, where there is one, its ratio to another line and the limit of that ratio."""

    name: str
    value: float
    unit: str
    ratio: float | None = None
    least: float | None = None  # that the ratio should be
    most: float | None = None

    @property
    def missed(self) -> bool:
        return (self.least is not None and self.ratio < self.least) or (
            self.most is not None and self.ratio > self.most
        )

    def __str__(self) -> str:
        line = f"{self.name:<44} {self.value:>12,.{0 if self.value >= 100 else 3}f} {self.unit:<20}"
        line += "" if self.ratio is None else f" {self.ratio:>8,.1f}x"
        wanted = {"at least": self.least, "at most": self.most}
        line += "".join(f"   {words} {limit:,g}x" for words, limit in wanted.items() if limit is not None)
        return (line + "  MISSED" * self.missed).rstrip()


def by_the_rule(cars: np.ndarray) -> np.ndarray:
    return rule(cars, DEFAULT).actions


def seconds_of_env(env: gym.Env, driver, seed: int) -> tuple[float, int]:
    """Processor time and decisions of one episode; without a driver the ego is idle."""
    began, decisions, over = time.thread_time(), 0, False
    env.reset(seed=seed)
    while not over:
        _, _, terminated, truncated, _ = env.step(driver(env.unwrapped.cars()[None])[0] if driver else IDLE)
        decisions, over = decisions + 1, terminated or truncated
    return time.thread_time() - began, decisions


def seconds_of_twin(env, driver) -> tuple[float, int]:
    """Processor time and decisions of `EPISODES` episodes on every road."""
    idle = np.full(env.num_envs, IDLE)
    began, steps = time.thread_time(), EPISODES * DEFAULT.clock.decisions
    env.reset(seed=0)
    for _ in range(steps):
        env.step(driver(env.cars) if driver else idle)
    return time.thread_time() - began, steps * env.num_envs


def rates(driver) -> tuple[float, float]:
    """Decisions per second of the compiled road and of `TrapEnv`, taking turns."""
    reference, twin = TrapEnv(), gym.make_vec("bootcourse:Trap-v0", num_envs=ROADS).unwrapped
    seconds_of_twin(twin, driver)  # compiles
    ours, theirs = [], {seed: [] for seed in range(EPISODES)}
    for _ in range(REPETITIONS):
        ours.append(seconds_of_twin(twin, driver))
        for seed, times in theirs.items():
            times.append(seconds_of_env(reference, driver, seed))
    seconds, decisions = zip(*(min(times) for times in theirs.values()), strict=True)
    best, count = min(ours)
    return count / best, sum(decisions) / sum(seconds)


def rates_of_one_car() -> dict[str, float]:
    """Decisions per second of an idle ego, taking turns, by the environment's id."""
    envs = {name: gym.make(f"bootcourse:{name}") for name in ("Trap-v0", "FastTrap-v0")}
    best = dict.fromkeys(envs, 0.0)
    for seed in range(REPETITIONS + 1):  # the first turn only compiles
        for name, env in envs.items():
            seconds, decisions = seconds_of_env(env, None, seed)
            best[name] = max(best[name], decisions / seconds * (seed > 0))
    return best


def table() -> list[Row]:
    """The ratios, each with its halves."""
    slow, fast = rates_of_one_car().values()
    rows = [
        Row("Trap-v0, one car", slow, "decisions/s"),
        Row("FastTrap-v0, one car", fast, "decisions/s", fast / slow, least=50.0),
    ]
    for name, driver, least in (("idle ego", None, 1500.0), ("rule-driven ego", by_the_rule, 750.0)):
        ours, theirs = rates(driver)
        rows += [
            Row(f"TrapEnv, {name}", theirs, "decisions/s"),
            Row(f"compiled road, {ROADS} roads, {name}", ours, "decisions/s", ours / theirs, least=least),
        ]
    return rows
