"""What the numbers and claims in this lesson's text are computed from, beside tools/course/known.py."""

import itertools
from functools import cache

import numpy as np

from bootcourse.course import shipped as course
from bootcourse.course.lessons.looking_ahead.imagined_road import decide_by
from bootcourse.episodes.evaluate import drive_episodes, held_out_seeds
from bootcourse.episodes.lookahead import HORIZON, NINE, imagine, lookahead
from bootcourse.episodes.models import MODELS
from bootcourse.episodes.record import record
from bootcourse.episodes.words import overtaken
from bootcourse.policies import PolicyOutput
from bootcourse.research.computed import experiment
from bootcourse.research.experiments import learned_model
from bootcourse.research.experiments.lookahead import Cell, Score, score
from bootcourse.research.results import Results
from bootcourse.road.state import Accident
from bootcourse.scenario import DEFAULT

LATE = "everything a second late"
KEEPING = "others keep speed and lane"


@cache
def shipped() -> dict:
    """The experiment's cells."""
    return experiment("look-ahead")


def ahead(base: str, form: str = "rollouts", horizon: int = HORIZON, model: str = "exact") -> Score:
    """What the agents of a base policy reached in one form."""
    return score(shipped(), Cell(base, form, horizon=horizon, model=model))


def per_thousand(base: str, form: str = "rollouts", **more) -> float:
    """Accidents in 1,000 drives."""
    return 1000 * ahead(base, form, **more).accident_rate.value


def better(base: str, form: str) -> int:
    """With how many of the wrong models it has fewer accidents for each drive than the base policy alone."""
    alone = per_thousand(base, "alone")
    return sum(per_thousand(base, form, model=model) < alone for model in MODELS if model != "exact")


def overruled(form: str) -> list[float]:
    """In how many of 1,000 decisions PPO's agents take another action with each wrong model, in ascending order."""
    return sorted(1000 * ahead("ppo_cloned", form, model=model).overruled for model in MODELS if model != "exact")


def each(form: str, measure: str) -> np.ndarray:
    """The accidents or the mean return of each of the paper's agents, (agents,)."""
    return shipped()[Cell("bootstrapped", form).name].measured[measure]


def all_ten_gain() -> bool:
    """Whether each of them has fewer accidents with rollouts, and a higher return."""
    fewer = each("rollouts", "accidents") < each("alone", "accidents")
    return bool((fewer & (each("rollouts", "returns") > each("alone", "returns"))).all())


def alone_ahead() -> str:
    """In how many of 100 drives the rule, plain SAC, and agents with one aid end ahead alone."""
    shares = [f"{100 * ahead(base, 'alone').success:.0f}" for base in ("rule", "sac", "demos", "soft")]
    return f"{', '.join(shares[:-1])} and {shares[-1]}"


def safer_shield(base: str) -> int:
    """With how many of the wrong models the shield has fewer accidents than the rollouts."""
    wrong = (model for model in MODELS if model != "exact")
    return sum(per_thousand(base, "shield", model=model) < per_thousand(base, model=model) for model in wrong)


def _accidents(base: str) -> np.ndarray:
    """The accidents of each agent of a base policy, alone and with rollouts, (2, agents)."""
    return np.stack([shipped()[Cell(base, form).name].measured["accidents"] for form in ("alone", "rollouts")])


def less_safe(base: str) -> np.ndarray:
    """Which agents of a base policy have more accidents with rollouts than alone, (agents,)."""
    alone, ahead = _accidents(base)
    return ahead > alone


def of_the_nine() -> np.ndarray:
    """How often plain SAC's agents get out with rollouts, those that stay behind alone: shares, (9,)."""
    return outs("sac")[outs("sac", "alone") < 0.01]


@cache
def learning() -> Results:
    """The ten agents that learned a model of the road."""
    return learned_model.together(experiment(learned_model.NAME))


def learned(form: str) -> np.ndarray:
    """Accidents in 1,000 drives, the agents' mean after each round, (rounds,)."""
    return learned_model.per_thousand(learning(), form).mean(0)


def still_worse() -> int:
    """How many of the ten crash more often than alone, with rollouts in the model of the last round."""
    return int((learned_model.per_thousand(learning(), "mean of five")[:, -1] > each("alone", "accidents")).sum())


def learned_without(form: str) -> float:
    """The same of the control, whose model learned from drives without a look-ahead."""
    return float(learned_model.per_thousand(learning(), form, control=True).mean())


@cache
def how_five_end() -> list[np.ndarray]:
    """How the drives of each bootstrapped agent that ships end on the lesson's 40 roads."""
    roads = held_out_seeds(15, 40)
    return [drive_episodes(agent.as_policy(), roads).accident for agent in course.shipped_agents("bootstrapped")]


def five_accidents() -> list[int]:
    """The accidents of each of them."""
    return [int((ends > 0).sum()) for ends in how_five_end()]


def worst_ends() -> list[int]:
    """How the drives of the one that crashes most end."""
    return max(how_five_end(), key=np.count_nonzero).tolist()


@cache
def corrected_once(before: int = 6) -> list[bool]:
    """Of its drives with an accident, six seconds before which it takes the best of nine actions, once: has it one?"""
    worst, roads = int(np.argmax(five_accidents())), np.array(held_out_seeds(15, 40))
    agent = course.shipped_agents("bootstrapped")[worst].as_policy()
    roads, better, decision = roads[how_five_end()[worst] > 0], lookahead(agent), itertools.count()
    at = np.array([max(0, len(drive.actions) - before) for drive in record(agent, roads)])

    def policy(observations, cars):
        best, own = better(observations, cars).actions, agent(observations, cars).actions
        return PolicyOutput(np.where(at == next(decision), best, own))

    return [drive.accident > 0 for drive in record(policy, roads)]


def outs(base: str, form: str = "rollouts") -> np.ndarray:
    """The share of drives that end ahead of trap 1, of each agent of a base policy."""
    return shipped()[Cell(base, form).name].measured["success"]


@cache
def changed_before_passing() -> np.ndarray:
    """Of the drives with rollouts of the first plain SAC agent that get out, of 20: decisions that are not its own.

    Counted up to the second in which it passes trap 1.
    """
    agent, counts = course.shipped_agents("sac")[0].as_policy(), []
    for drive in record(lookahead(agent), held_out_seeds(15, 40)[:20]):
        if drive.success:
            cars = drive.states[:: DEFAULT.clock.steps][: int(np.ceil(overtaken(drive)))]
            counts.append(int((decide_by(agent)(cars) != drive.actions[: len(cars)]).sum()))
    return np.array(counts)


@cache
def nine_ends() -> list[int]:
    """How the nine imagined drives end, six seconds before this agent's first collision: 0 without an accident."""
    ends = [(each > 0).sum() for each in how_five_end()]
    agent, roads = course.shipped_agents("bootstrapped")[int(np.argmax(ends))].as_policy(), held_out_seeds(15, 40)
    first = int((how_five_end()[int(np.argmax(ends))] == Accident.COLLISION).argmax())
    drive = record(agent, [roads[first]])[0]
    cars = drive.states[(len(drive.actions) - 6) * DEFAULT.clock.steps]
    return [int(end) for end in imagine(cars[None], NINE[None], agent, horizon=10).accidents[0]]
