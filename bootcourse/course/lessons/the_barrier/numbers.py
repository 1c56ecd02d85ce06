"""What the numbers and claims in this lesson's text are computed from, beside tools/course/known.py."""

from collections import Counter
from functools import cache
from typing import NamedTuple

import numpy as np

from bootcourse.course.lessons.the_barrier import attempts, easier, explorable, figures
from bootcourse.episodes.evaluate import drive_episodes, held_out_seeds
from bootcourse.policies import PlanPolicy, Policy, PolicyOutput, idle_policy, random_policy
from bootcourse.research.cells import HELD_OUT
from bootcourse.research.planner import Search, plan_episodes
from bootcourse.research.results import Results
from bootcourse.road.state import EGO, LANE
from bootcourse.scenario import DEFAULT, N_ACTIONS
from bootcourse.statistics import ESCAPES
from tools.course.known import ROAD, idle, of, shipped_experiment


@cache
def planned(beam: int, gamma: float, keep_lane: bool = False) -> float:
    """What the planner's best drive on the lesson's road is worth."""
    return plan_episodes([ROAD], search=Search(beam, gamma, keep_lane))[0].value


def stayed() -> int:
    """How many of the study's plain agents return what doing nothing does, to within 3."""
    return int((np.abs(of("sac").scores("returns") - idle().rewards.sum()) < 3).sum())


@cache
def by_chance():
    """The barrier's 5,000 random drives."""
    return drive_episodes(random_policy(np.random.default_rng(0)), held_out_seeds(6, 5000))


FOUR = "4 random actions, then accelerates"
UNSKILLED = ("random for 150 s", FOUR, "random lanes and speeds")
THE_PLAN = "one plan, then accelerates"
KINDS_OF_ATTEMPTS = (*UNSKILLED, THE_PLAN, "the rule's way")
ROADS = held_out_seeds(7, 500)  # of the lesson's attempts


@cache
def all_tested() -> dict[str, attempts.Outcome]:
    """The lesson's kinds of attempts on its 500 roads, driven in the same order."""
    return {kind: attempts.drive(policy, ROADS) for kind, policy in attempts.kinds(len(ROADS)).items()}


def tested(kind: str) -> attempts.Outcome:
    """One kind of them."""
    return all_tested()[kind]


def unhurt_plan() -> np.ndarray:
    """What the plan's drives without an accident are worth at γ = 0.8."""
    return tested(THE_PLAN).values(0.8)[~tested(THE_PLAN).accident]


def easy(kind: str) -> Results:
    """The twenty agents of one of `easier.KINDS`."""
    return shipped_experiment("easier")[kind]


def safe(kind: str) -> int:
    """How many of them hardly ever end ahead, or in an accident."""
    return int(((easy(kind).scores("success") < 0.05) & (easy(kind).scores("accident") < 0.05)).sum())


def stay_well() -> int:
    """How many of those on the road as it is earn more than 20: doing nothing returns 23.4."""
    agents = easy("as it is")
    safe = (agents.scores("success") < 0.05) & (agents.scores("accident") < 0.05)
    return int((safe & (agents.scores("returns") > 20)).sum())


def the_escaper(measure: str) -> float:
    """A measure of the one agent that escapes on the road as it is."""
    agents = easy("as it is")
    return float(agents.scores(measure)[agents.scores("success") >= ESCAPES].item())


ONCE = "accelerates once, then nothing"
MIDDLE, CHEAP = easier.MIDDLE, easier.CHEAP
RAM, STRAIGHT_ON = "accelerates into trap 1", "accelerates straight on"
STRAIGHT = (attempts.ACCELERATE,) * DEFAULT.clock.decisions


def staying_return(kind: str) -> float:
    """The return of a car that stays behind trap 1 on the lesson's 100 roads of a kind."""
    return float(idle().rewards.sum() if kind == "as it is" else worth_of(kind, "stays", 1.0))


def paying(kind: str) -> int:
    """How many of the twenty agents of a kind escape and earn more than staying."""
    return int(figures.paying(easy(kind), staying_return(kind)).sum())


def below_staying(kind: str) -> int:
    """How many of those that do not escape return at least 3 less than staying."""
    agents = easy(kind)
    less = staying_return(kind) - agents.scores("returns") >= 3
    return int((less & (agents.scores("success") < ESCAPES)).sum())


def often_ahead(kind: str) -> int:
    """How many of the twenty end ahead on 10 % of their held-out roads or more."""
    return int((easy(kind).scores("success") >= 0.1).sum())


def hurt_ahead(kind: str) -> float:
    """Of the twenty agents' drives that end ahead, the share with an accident."""
    ahead = easy(kind).episodes("success") > 0
    return float(easy(kind).episodes("accident")[ahead].mean())


# The drives of the two slower agents from mid-lane with γ = 0.95 on the first of their held-out roads, by their seeds.
SLOWER = {
    1: "11144444444444444444444444444444444444444444444444444444444444444447777"
    "77774444444444444444444444444444444777777777777777777177447777111111111",
    3: "26626226626226626262626262626266226266226266226626226626262266262626262"
    "62626266262262626266262622626626262622662626262626262662622626626226622",
}


class Slower(NamedTuple):
    """One of them."""

    returns: float  # the mean of its 200 held-out roads
    worth: float  # at γ = 0.95, on the first
    is_its_drive: bool  # returns on this road what the agent did


@cache
def slower(seed: int) -> Slower:
    """The agent with this seed."""
    agents, first = easy(MIDDLE), held_out_seeds(HELD_OUT, 1)
    mine = [(agent["gamma"], agent["seed"]) for agent in agents.agents].index((0.95, seed))
    driven = attempts.drive(PlanPolicy([int(action) for action in SLOWER[seed]]), first, easier.MidLaneStart)
    same = np.isclose(driven.values(1.0)[0], agents.episodes("returns")[mine, 0], atol=1e-3)
    return Slower(float(agents.scores("returns")[mine]), float(driven.values(0.95)[0]), bool(same))


MANY = held_out_seeds(7, 2000)  # of the lesson's random actions


@cache
def _random_later(share: float) -> tuple[attempts.Outcome, attempts.Outcome]:
    return attempts.stays_and_accelerates(share, MANY, easier.MidLaneStart)


def added(share: float, gamma: float) -> tuple[float, float]:
    """Mid-lane: what one acceleration adds to staying if later actions are random so often, and its standard error."""
    stays, once = _random_later(share)
    more = once.values(gamma) - stays.values(gamma)
    return float(more.mean()), float(more.std() / np.sqrt(len(more)))


def sooner(share: float) -> float:
    """By how many seconds the accident comes sooner after one acceleration, if every drive has one."""
    assert all(each.accident.all() for each in _random_later(share))
    stays, once = ((each.rewards != 0).cumsum(axis=1).argmax(axis=1).mean() for each in _random_later(share))
    return float(stays - once)


@cache
def _kept(share: float) -> list[attempts.Outcome]:
    """Mid-lane, 500 roads: a lane keeper at 10 m/s, and one that goes to 15 m/s, with the same random actions."""
    rng, shape = np.random.default_rng(0), (DEFAULT.clock.decisions, len(ROADS))
    errs, actions = rng.random(shape) < share, rng.integers(N_ACTIONS, size=shape)

    def keeper(speed: float) -> Policy:
        decisions = iter(range(len(errs)))

        def decide(observations: np.ndarray, cars: np.ndarray) -> PolicyOutput:
            t, wanted = next(decisions), np.full(len(cars), speed)
            return PolicyOutput(np.where(errs[t], actions[t], attempts.keep_lane(cars, wanted, cars[:, EGO, LANE])))

        return decide

    return [attempts.drive(keeper(speed), ROADS, easier.MidLaneStart) for speed in (10.0, attempts.FAST)]


def kept(share: float, gamma: float) -> tuple[float, float]:
    """What going to 15 m/s adds if a lane keeper steers and a share of its actions is random; its standard error."""
    stays, goes = _kept(share)
    more = goes.values(gamma) - stays.values(gamma)
    return float(more.mean()), float(more.std() / np.sqrt(len(more)))


def _straight() -> np.ndarray:
    """Which agents from mid-lane drive faster than 20 m/s, on average."""
    return easy(MIDDLE).scores("speed") > 20


def straight_on() -> int:
    """How many they are."""
    return int(_straight().sum())


def straight_speed() -> float:
    """How fast they drive, on average, m/s."""
    return float(easy(MIDDLE).scores("speed")[_straight()].mean())


def straight_return() -> float:
    """The most that one of them earns."""
    return float(easy(MIDDLE).scores("returns")[_straight()].max())


def decided() -> int:
    """How many of the study's plain agents have an entropy of 0.01 nat or less in their last 100 training episodes."""
    return int((of("sac").curves["entropy"][:, -100:].mean(axis=1) <= 0.01).sum())


@cache
def going_straight(gamma: float) -> list[float]:
    """What the drives of these agents with this γ are worth at it, who accelerate on each of their held-out roads.

    That an agent drives so is seen by its returns: on each road that of these actions.
    """
    agents = easy(MIDDLE)
    here, seeds = np.array([agent["gamma"] == gamma for agent in agents.agents]), held_out_seeds(HELD_OUT, easier.TESTS)
    driven = attempts.drive(PlanPolicy(STRAIGHT), seeds, easier.MidLaneStart)
    same = np.isclose(agents.episodes("returns"), driven.values(1.0), atol=1e-3).all(axis=1)
    return [float(driven.values(gamma).mean())] * int((same & here).sum())


@cache
def easier_outcomes(road: str) -> dict[str, attempts.Outcome]:
    """What came of the lesson's drives on its 100 roads, made easier."""
    roads, make_env = held_out_seeds(7, 100), easier.KINDS[road][0]
    drivers = {**easier.drivers(road), STRAIGHT_ON: PlanPolicy(STRAIGHT)}
    return {name: attempts.drive(each, roads, make_env) for name, each in drivers.items()}


def easier_outcome(road: str, name: str) -> attempts.Outcome:
    """One of them."""
    return easier_outcomes(road)[name]


def worth_of(road: str, name: str, gamma: float) -> float:
    """What a drive on an easier road is worth, on average."""
    return float(easier_outcome(road, name).values(gamma).mean())


@cache
def first_sixes() -> list[tuple[int, ...]]:
    """The first six actions of the planner's best drive at γ = 0.8 on each of the roads 0 to 11."""
    return [tuple(plan.actions[:6].tolist()) for plan in plan_episodes(range(12), search=Search(50, 0.8))]


@cache
def _blind(actions: tuple[int, ...]) -> attempts.Outcome:
    return attempts.drive(attempts.ThenAccelerate(actions), ROADS)


def six_actions(road: int) -> attempts.Outcome:
    """Those of one road, blind, then the lane keeper; on the roads of the other kinds."""
    return _blind(first_sixes()[road])


def commonest_six() -> tuple[int, attempts.Outcome]:
    """On how many of the twelve roads the commonest six actions are the first, and what comes of them."""
    actions, roads = Counter(first_sixes()).most_common(1)[0]
    return roads, _blind(actions)


@cache
def sixes_that_pay() -> list[attempts.Outcome]:
    """What comes of them for each of the twelve roads, where that is worth more than staying at γ = 0.8."""
    stays = tested("stays").values(0.8).mean()
    return [outcome for outcome in map(_blind, first_sixes()) if outcome.values(0.8).mean() > stays]


def may_crash(gamma: float) -> int:
    """How many of a hundred attempts of the panel may end in an accident before the others no longer pay for them."""
    roads = explorable.ROADS
    plan, stays = attempts.drive(attempts.ThenAccelerate(attempts.PLAN), roads), attempts.drive(idle_policy, roads)
    values = plan.values(gamma)
    out, crashed = values[~plan.accident].mean(), values[plan.accident].mean()
    return int(100 * (out - stays.values(gamma).mean()) / (out - crashed))


def farther() -> np.ndarray:
    """Which agents of plain SAC with a larger γ than the paper's escape on the road as it is."""
    here = easy("as it is")
    ours = here.scores("success")[[agent["gamma"] > 0.8 for agent in here.agents]]
    varied = [
        each.of("sac").scores("success") for what, each in shipped_experiment("sensitivity").items() if "γ" in what
    ]
    return np.concatenate([ours, *varied]) >= ESCAPES


@cache
def changed_agents(method: str) -> np.ndarray:
    """Which agents of a method escape with another γ, another target entropy or both, (agents,)."""
    varied = shipped_experiment("sensitivity").items()
    scores = [each.of(method).scores("success") for what, each in varied if "γ" in what or "entropy" in what]
    return np.concatenate(scores) >= ESCAPES


def larger_entropy() -> np.ndarray:
    """What those of them return that have another target entropy than the paper's, (agents,)."""
    varied = shipped_experiment("sensitivity").items()
    return np.concatenate([each.of("sac").scores("returns") for what, each in varied if "entropy" in what])


def crashing(kind: str) -> int:
    """How many agents of a kind have an accident in more than nine of ten drives."""
    return int((easy(kind).scores("accident") > 0.9).sum())
