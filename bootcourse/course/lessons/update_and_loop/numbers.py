"""What the text of the lesson on SAC's update and loop names: the agents of the experiment `pole`, as they ship."""

from collections.abc import Callable
from functools import cache

import numpy as np

from bootcourse.course.lessons.update_and_loop import by_hand as by_hand  # the text names it, and γ
from bootcourse.course.lessons.update_and_loop import exercises, worlds
from bootcourse.course.lessons.update_and_loop.pole import BLOCK
from bootcourse.course.lessons.update_and_loop.worlds import BEFORE, GAMMA
from bootcourse.course.shipped import shipped_experiment
from bootcourse.research.problems import cartpole
from bootcourse.research.results import Results


def fallen_at() -> float:
    """How far (degrees) a pole leans when it counts as fallen."""
    return float(np.degrees(cartpole().unwrapped.theta_threshold_radians))


@cache
def agents(kind: str = "marked") -> Results:
    """Those of one kind of the experiment `pole`."""
    return shipped_experiment("pole")[kind]


def tests() -> list[np.ndarray]:
    """The tests of each agent that learns with marks: before its training and after each block."""
    return [each[np.isfinite(each)] for each in agents().notes["tests"]]


LEARNED = 50  # pushes that an agent balances the pole at least if it has learned something


def of_each(kind: str, read: Callable[[Results], np.ndarray]) -> np.ndarray:
    """What is read of the agents of a kind, and of those of it with more seeds."""
    return np.concatenate([read(agents(each)) for each in (kind, f"more-{kind}")])


def stood(kind: str) -> np.ndarray:
    """For how many pushes each of these balances the pole after its first block."""
    return of_each(kind, lambda them: them.notes["tests"][:, 1])


def learned(kind: str) -> str:
    """How many of these have learned something, in words."""
    return f"{(stood(kind) > LEARNED).sum()} of {len(stood(kind))}"


def untrained() -> np.ndarray:
    """For how many pushes each of these agents balances the pole before it learns."""
    return of_each("unmarked", lambda them: them.notes["tests"][:, 0])


@cache
def made_up(pay: int) -> float:
    """What the fallen state is worth to an agent with the bug in a world in which one push pays so much, then it falls:
    V(fallen), from Q of the start.
    """
    world, train, update = worlds.World(((pay, pay),), True, ""), exercises.train.solution, exercises.update.solution
    learned = worlds.learned_in(
        world, train, update, lambda size: worlds.Unmarked(exercises.ReplayBuffer.solution(size))
    )
    return (learned.q.mean().item() - pay) / GAMMA


def gained(kind: str) -> float:
    """By how much Q eight pushes before the fall is above that of a fallen pole, each the median of these agents."""
    before, *_, fallen = np.median(expected(kind), axis=0)
    return before - fallen


def before(kind: str) -> float:
    """Q eight pushes before the fall, the median of these agents."""
    return float(np.median(expected(kind)[:, 0]))


def spread(kind: str) -> str:
    """The least and the most pushes of those that have learned something, in words."""
    pushes = stood(kind)[stood(kind) > LEARNED]
    return f"{pushes.min():.0f} to {pushes.max():.0f}" if len(pushes) else "–"


def expected(kind: str) -> np.ndarray:
    """What each of these expects along a fall after its first block, (agents, 9): see `worlds.along_falls`."""
    return of_each(kind, lambda them: them.notes["q"][:, : BEFORE + 1])


def drop(kind: str) -> bool:
    """Whether in all these agents Q of a fallen pole is less than a quarter of Q eight pushes before."""
    return bool((expected(kind)[:, -1] < expected(kind)[:, 0] / 4).all())


def pushes() -> list[int]:
    """After how many pushes each stopped."""
    return [BLOCK * (len(each) - 1) for each in tests()]


def middle(kind: str) -> str:
    """Two cells of a table: Q eight pushes before the fall, and of a fallen pole, each the median of these agents."""
    before, *_, fallen = np.median(expected(kind), axis=0)
    return f"{before:.0f} | {fallen:.0f}".replace("-", "−")


def ceiling(kind: str) -> np.ndarray:
    """The most that Q can be for each of these agents, (agents,)."""
    return of_each(kind, lambda them: them.measured["most"])
