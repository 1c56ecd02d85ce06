"""What the numbers and claims in this lesson's text are computed from, beside tools/course/known.py."""

from functools import cache

import numpy as np
from bootcourse.course import shipped as course
from bootcourse.episodes.evaluate import drive_episodes, held_out_seeds
from bootcourse.episodes.lookahead import HORIZON, lookahead
from bootcourse.episodes.models import MODELS
from bootcourse.policies import idle_policy, random_policy
from bootcourse.research import distil
from bootcourse.research.beyond import lengths
from bootcourse.research.lookahead import MANY, ROADS, Cell, Score, score
from bootcourse.research.results import Results, experiment
from bootcourse.statistics import Estimate, interval
from tools.course.known import shipped_teachers

NOISE, LATE = "places off by 1 m, speeds by 0.5 m/s", "everything a second late"
OTHERS_LATE = "the others a second late"
KEEPING, GAPS = "others keep speed and lane", "twice the time gap"


@cache
def shipped() -> dict:
    """The experiment's cells."""
    return experiment("look-ahead")


def ahead(base: str, form: str = "rollouts", horizon: int = HORIZON, model: str = "exact", roads: int = ROADS) -> Score:
    """What the agents of a base policy reached in one form. roads: MANY for the cell on so many."""
    assert roads in (ROADS, MANY)
    return score(shipped(), Cell(base, form, roads=roads, horizon=horizon, model=model))


def per_thousand(base: str, form: str = "rollouts", **more) -> float:
    """Accidents in 1,000 drives."""
    return 1000 * ahead(base, form, **more).accident_rate.value


def gain(base: str) -> float:
    """What the rollouts add to the mean return."""
    return ahead(base).returns.value - ahead(base, "alone").returns.value


def better(base: str, form: str) -> int:
    """With how many of the wrong models it has fewer accidents for each drive than the base policy alone."""
    alone = per_thousand(base, "alone")
    return sum(per_thousand(base, form, model=model) < alone for model in MODELS if model != "exact")


def worse_than_shield(base: str) -> int:
    """With how many of the wrong models the rollouts have more accidents for each drive than the shield."""
    wrong = [model for model in MODELS if model != "exact"]
    return sum(per_thousand(base, model=one) > per_thousand(base, "shield", model=one) for one in wrong)


@cache
def learned() -> dict[str, Results]:
    """The students of the look-ahead, by what they learned."""
    return experiment("distil")


def before():
    """Accidents of the agents that these students were, (agents,)."""
    return shipped()[Cell(distil.BASE, "alone").name].measured["accidents"][: distil.AGENTS]


def taught_by(teacher: str, method: str) -> Estimate:
    """The return of a teacher's ten agents."""
    return interval(shipped_teachers()[teacher, method].scores("returns"))


def decided(teacher: str, method: str) -> float:
    """The thousand decisions of each of these agents' training, the mean."""
    return float(np.nansum(lengths(shipped_teachers()[teacher, method].curves), axis=1, dtype=float).mean()) / 1000


def escaping(teacher: str, method: str) -> int:
    """How many of these escape."""
    return shipped_teachers()[teacher, method].escapers(method)


@cache
def five_accidents() -> list[int]:
    """The accidents of each bootstrapped agent that ships on the lesson's 40 roads."""
    roads = held_out_seeds(15, 40)
    agents = course.shipped_agents("bootstrapped")
    return [int((drive_episodes(agent.as_policy(), roads).accident > 0).sum()) for agent in agents]


@cache
def ahead_of_twenty(base: str) -> int:
    """How many of 20 drives with rollouts of "idle" or "random" end ahead of trap 1."""
    policy = idle_policy if base == "idle" else random_policy(np.random.default_rng(0))
    return int(drive_episodes(lookahead(policy), held_out_seeds(15, 40)[:20]).success.sum())
