"""What the numbers and claims in this lesson's text are computed from, beside tools/course/known.py."""

from functools import cache

import numpy as np
import torch
from scipy import stats

from bootcourse.course.lessons.recorded_drives import choosing
from bootcourse.course.lessons.recorded_drives.exercises import conservative_loss  # noqa: F401 (the text names it)
from bootcourse.course.lessons.recorded_drives.reachable_entropy import by_entropy
from bootcourse.course.shipped import shipped_agents
from bootcourse.episodes.record import record
from bootcourse.policies import idle_policy
from bootcourse.research.results import Results
from bootcourse.statistics import ESCAPES
from tools.course.known import idle, of, shipped_experiment, shipped_results


def share(what: str) -> float:
    """In how many % of the test drives of our GAIL agents this happened: "success", "road_departure", ..."""
    return float(100 * of("gail").episodes(what).mean())


def least_share() -> float:
    """How many % of GAIL's drives that leave the road succeed at least: if each one without success left it."""
    return 100 * (1 - (100 - share("success")) / share("road_departure"))


def failing() -> np.ndarray:
    """The success of the GAIL agents that do not escape."""
    success = of("gail").scores("success")
    return success[success < ESCAPES]


def last_drives(method: str) -> np.ndarray:
    """Each agent's success in its last 500 training drives, (agents,)."""
    return of(method).curves["success"][:, -500:].mean(axis=1)


def with_entropy(place: int) -> Results:
    """The CQL agents with an actor of the experiment on η: of the lower η (0), or of the one within reach (1)."""
    return list(by_entropy(shipped_experiment("reachable-entropy")["cql_sac"]).values())[place]


def staying(results: Results) -> int:
    """How many agents stay behind trap 1 on each road: they earn what one does that never acts."""
    return int(np.isclose(results.scores("returns"), idle().rewards.sum(), atol=1).sum())


def p_of_entropy() -> float:
    """Fisher's p of the agents that stay behind trap 1: of five with the lower η, and of five with the one in reach."""
    stay = [staying(with_entropy(place)) for place in (0, 1)]
    return float(stats.fisher_exact([[each, 5 - each] for each in stay]).pvalue)


def of_paper(method: str) -> Results:
    """The agents of a method in the study whose demonstrations are the stochastic rule's."""
    return shipped_results("paper").of(method)


@cache
def worth_of(method: str, which: int = 0) -> float:
    """What an agent of a method, by default its first, is worth from the start at γ = 0.8, the mean of 100 roads."""
    return choosing.worth(shipped_agents(method)[which].as_policy(), range(100), 0.8)[0]


@cache
def overlap_of(method: str, which: int = 0) -> float:
    """In which share of the recorded seconds it would do what was done."""
    return choosing.overlap(shipped_agents(method)[which].as_policy(), choosing.recorded())


DRIVERS = (("bc", 0), ("cql", 0), ("cql_sac", 0), ("gail", 0), ("sac", 0), ("bootstrapped", 0), ("bootstrapped", 1))


@cache
def estimated() -> np.ndarray:
    """What each of the lesson's seven drivers is worth by each of three fits, (fits, drivers), as in its notebook."""
    drivers = [shipped_agents(method)[which].as_policy() for method, which in DRIVERS]
    starts = torch.from_numpy(np.stack([each.observations[0] for each in record(idle_policy, range(100))])).float()
    seeds = np.repeat(range(3), len(drivers))
    return np.reshape(choosing.estimates(drivers * 3, choosing.recorded(), starts, 0.8, seeds), (3, -1))


def misses() -> np.ndarray:
    """By how much the worst fit misses what each of the seven is worth."""
    return np.abs(estimated() - [worth_of(*each) for each in DRIVERS]).max(axis=0)


def largest() -> list[int]:
    """Which of the seven has the largest estimate in each fit."""
    return estimated().argmax(axis=1).tolist()
