"""What the numbers and claims in this lesson's text are computed from, beside tools/course/known.py."""

from functools import cache

import numpy as np

from bootcourse.course.lessons.the_barrier import attempts, easier, explorable, figures
from bootcourse.course.lessons.the_barrier.exercises import luck
from bootcourse.episodes.evaluate import held_out_seeds
from bootcourse.episodes.record import record
from bootcourse.policies import PlanPolicy, random_policy
from bootcourse.research.planner import Search, follow, is_staying_optimal, plan_episodes
from bootcourse.research.results import Results
from bootcourse.road.state import EGO, SPEED
from bootcourse.road.vector_env import TrapVectorEnv as TrapVectorEnv
from tools.course.known import ROAD, shipped_experiment


def planned_speeds() -> np.ndarray:
    """How fast (m/s) the car is that follows it, after each second."""
    drive = record(follow(plan_episodes([ROAD], search=Search(beam=50))), [ROAD])[0]
    return drive.states[:: drive.scenario.clock.steps, EGO, SPEED]


@cache
def slow_seconds(searches: bool = False) -> np.ndarray:
    """What the planner's first five seconds pay, on the lesson's road; or on the roads of its searches at γ = 0.8, the
    mean.
    """
    roads, search = (range(4), Search(beam=50, gamma=0.8)) if searches else ([ROAD], Search(beam=50))
    return np.mean([plan.rewards[:5] for plan in plan_episodes(roads, search=search)], axis=0)


def on_the_way() -> str:
    """These, in words."""
    *paid, last = (f"{each:.2f}" for each in slow_seconds())
    return f"{', '.join(paid)} and {last}"


def until_fast(searches: bool = False) -> float:
    """What they are worth at γ = 0.8."""
    return float(slow_seconds(searches) @ 0.8 ** np.arange(5))


@cache
def by_chance() -> list[attempts.Outcome]:
    """The barrier's 5,000 random drives, 1,000 at a time, as its cell drives them."""
    policy, seeds = random_policy(np.random.default_rng(0)), held_out_seeds(6, 5000)
    return [attempts.drive(policy, seeds[i : i + 1000]) for i in range(0, 5000, 1000)]


def lucky(gamma: float = 1.0) -> np.ndarray:
    """What those of them are worth that get out; all of them crash."""
    assert all(each.accident.all() for each in by_chance())
    return np.concatenate([each.values(gamma)[each.ahead] for each in by_chance()])


def by_luck(good: int) -> float:
    """How many of 5,000 random drives would get out if so many actions were right at each of the 8 decisions."""
    return 5000 * luck(good, easier.LATER, 1)


hill = explorable.hill


def easy(kind: str) -> Results:
    """The twenty agents of one of `easier.KINDS`."""
    return shipped_experiment("easier")[kind]


def farther_sighted() -> Results:
    """The ten of Round 1's twenty agents that have γ = 0.95."""
    agents = easy("as it is")
    return agents.pick([k for k, agent in enumerate(agents.agents) if agent["gamma"] == 0.95])


MIDDLE, CHEAP, BOTH, FREE = easier.MIDDLE, easier.CHEAP, easier.BOTH, easier.FREE
stressed = easier.stressed


def stay(kind: str) -> int:
    """How many agents of a kind get out on hardly any road, and do not crash on most: they stay behind."""
    agents = easy(kind)
    return int(((agents.scores("success") < 0.01) & (agents.scores("accident") <= 0.5)).sum())


def crash_on_most(kind: str) -> int:
    """How many agents of a kind have an accident on most roads."""
    return int((easy(kind).scores("accident") > 0.5).sum())


def crash_when_out(kind: str) -> float:
    """Of the test drives of a kind's agents that get out, the share that has an accident."""
    agents = easy(kind)
    return float(agents.episodes("accident")[agents.episodes("success") > 0].mean())


def _fail(kind: str) -> np.ndarray:
    """Which agents of a kind get out on less than half of the test roads, (agents,)."""
    return easy(kind).scores("success") < 0.5


def failing(kind: str) -> int:
    """How many of a kind's agents do."""
    return int(_fail(kind).sum())


def out_of_failing(kind: str) -> np.ndarray:
    """How many of these agents' drives got out while they learned, in each quarter of their drives, (4,)."""
    return figures.counts_by_quarter(easy(kind))[0][_fail(kind)].sum(axis=0)


def of_failing(kind: str) -> str:
    """The same, as cells of a table."""
    return " | ".join(map(str, out_of_failing(kind)))


def at_random(kind: str) -> str:
    """How many would get out, were all actions of these agents random, as cells of a table."""
    drives = figures.counts_by_quarter(easy(kind))[1][_fail(kind)].sum(axis=0)
    return " | ".join(f"{each:.0f}" for each in drives * len(lucky()) / 5000)


def better_than_staying(price: float, gamma: float) -> int:
    """How many of the random drives that get out are worth more than staying, where an accident costs `price`."""
    staying = explorable.by_staying().values(gamma)[0]
    worths = (each.priced(price)[each.ahead] @ gamma ** np.arange(each.rewards.shape[1]) for each in by_chance())
    return sum(int((worth > staying).sum()) for worth in worths)


def by_plan_paid() -> np.ndarray:
    """What each second of the blind plan pays, the mean of its drives that still run, (seconds,)."""
    out = explorable.by_plan()
    return np.array([out.rewards[out.lasted > t, t].mean() for t in range(explorable.SECONDS)])


def ends(kind: str) -> np.ndarray:
    """How many agents of a kind end in each way, see `figures.how_they_end`."""
    return figures.how_they_end(easy(kind), easier.staying(kind))[0]


@cache
def step_to_the_left() -> attempts.Outcome:
    """What comes of steering left where the plan ends, on 100 roads."""
    return attempts.drive(PlanPolicy([3]), held_out_seeds(7, 100), easier.LaterStart)


@cache
def accelerating(seconds: int, road: type[TrapVectorEnv] = easier.MidLaneStart) -> attempts.Outcome:
    """What comes of so many accelerations, from a start in the free lane or on another kind of road, on 100 roads."""
    return attempts.drive(PlanPolicy([attempts.ACCELERATE] * seconds), held_out_seeds(7, 100), road)


@cache
def searched():
    """The lesson's best drives at γ = 0.8."""
    return is_staying_optimal(range(4), gamma=0.8, beam=50)


def driven() -> np.ndarray:
    """How many drives each of the twenty agents ended while it learned."""
    return np.isfinite(easy("as it is").curves["success"]).sum(axis=1)


def times_ahead() -> np.ndarray:
    """How many drives each of the twenty got out while it learned."""
    return figures.times_ahead(easy("as it is"))


def quarters(kind: str) -> np.ndarray:
    """In which share of its drives the median agent of a kind gets out, in each quarter of its training, (4,)."""
    return np.median(figures.by_quarter(easy(kind)), axis=0)


def once_ahead() -> int:
    """How many of the twenty did so at least once."""
    return int((times_ahead() > 0).sum())
