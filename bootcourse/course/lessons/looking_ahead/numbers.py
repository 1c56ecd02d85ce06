"""What the numbers and claims in this lesson's text are computed from, beside tools/course/known.py."""

from functools import cache

import numpy as np

from bootcourse.course import shipped as course
from bootcourse.course.lessons.looking_ahead import explorable
from bootcourse.course.lessons.looking_ahead.figures import BASE, MEANINGS
from bootcourse.episodes.evaluate import drive_episodes, held_out_seeds
from bootcourse.episodes.models import MODELS  # noqa: F401 (for the claims)
from bootcourse.episodes.record import record
from bootcourse.research.computed import experiment
from bootcourse.research.experiments import learned_model
from bootcourse.research.experiments.lookahead import Cell, Score, score
from bootcourse.research.results import Results
from bootcourse.road.state import Accident

LATE = "everything a second late"
WRONG = list(MEANINGS)  # of the study's models


@cache
def shipped() -> dict:
    """The experiment's cells."""
    return experiment("look-ahead")


def ahead(base: str, form: str = "rollouts", model: str = "exact") -> Score:
    """What the agents of a base policy reached in one form."""
    return score(shipped(), Cell(base, form, model=model))


def per_thousand(base: str, form: str = "rollouts", model: str = "exact") -> float:
    """Accidents in 1,000 drives."""
    return 1000 * ahead(base, form, model).accident_rate.value


def each(base: str, form: str, measure: str) -> np.ndarray:
    """The accidents, or another measure, of each agent of a base policy, (agents,)."""
    return shipped()[Cell(base, form).name].measured[measure]


def less_safe(base: str) -> np.ndarray:
    """Which agents of a base policy have more accidents with the look-ahead than alone, (agents,)."""
    return each(base, "rollouts", "accidents") > each(base, "alone", "accidents")


def of_the_nine() -> np.ndarray:
    """How often plain SAC's agents get out with the look-ahead, those that stay behind alone: shares, (9,)."""
    return outs("sac")[outs("sac", "alone") < 0.01]


@cache
def learning() -> Results:
    """The ten agents that learned a model of the road."""
    return learned_model.together(experiment(learned_model.NAME))


def learned(form: str, measure: str = "accidents") -> np.ndarray:
    """Accidents in 1,000 drives, or the return, the agents' mean after each round, (rounds,)."""
    if measure == "returns":
        return learning().notes[f"{form}, returns"].mean(0)
    return learned_model.per_thousand(learning(), form).mean(0)


def further() -> int:
    """The drives that each model gets after its first ones."""
    return (learned_model.ROUNDS - 1) * learned_model.DRIVES


def still_worse() -> int:
    """How many of the ten crash more often than alone, with the look-ahead in the model of the last round."""
    return int((learned_model.per_thousand(learning(), "mean of five")[:, -1] > each(BASE, "alone", "accidents")).sum())


def learned_without(form: str, measure: str = "accidents") -> float:
    """The same of the control, whose model learned from drives without a look-ahead."""
    if measure == "returns":
        return float(learning().measured[f"{form}, returns"].mean())
    return float(learned_model.per_thousand(learning(), form, control=True).mean())


@cache
def how_five_end() -> list[np.ndarray]:
    """How the drives of each bootstrapped agent that ships end on the lesson's 40 roads."""
    roads = held_out_seeds(15, 40)
    return [drive_episodes(agent.as_policy(), roads).accident for agent in course.shipped_agents("bootstrapped")]


def five_accidents() -> list[int]:
    """The accidents of each of them."""
    return [int((ends > 0).sum()) for ends in how_five_end()]


def outs(base: str, form: str = "rollouts") -> np.ndarray:
    """The share of drives that end ahead of trap 1, of each agent of a base policy."""
    return each(base, form, "success")


def earned(base: str, form: str = "rollouts") -> np.ndarray:
    """The mean return of each agent of a base policy."""
    return each(base, form, "returns")


@cache
def ways_out() -> list[int]:
    """In the first agent's first collision, for each decision: how many of its nine futures have no accident."""
    agent, roads = course.shipped_agents("bootstrapped")[0].as_policy(), held_out_seeds(15, 40)
    drive = record(agent, [roads[int((how_five_end()[0] == Accident.COLLISION).argmax())]])[0]
    return explorable.ways_out(drive, agent).tolist()


def worse_than_alone(base: str, form: str) -> int:
    """With how many of the lesson's wrong models a base policy crashes more often than alone."""
    return sum(per_thousand(base, form, model) > per_thousand(base, "alone") for model in WRONG)


def fewer_rows() -> int:
    """How many of the ten learned their last model from fewer decisions than that of the control."""
    return int((learning().notes["rows"][:, -1] < learning().measured["rows"]).sum())
