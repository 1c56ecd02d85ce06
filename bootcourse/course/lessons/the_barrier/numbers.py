"""What the numbers and claims in this lesson's text are computed from, beside tools/course/known.py."""

from dataclasses import replace
from functools import cache

import numpy as np
from scipy import stats

from bootcourse.course.lessons.the_barrier import attempts, easier, explorable, figures
from bootcourse.episodes.evaluate import drive_episodes, held_out_seeds
from bootcourse.policies import PlanPolicy, idle_policy, random_policy
from bootcourse.research.cells import HELD_OUT
from bootcourse.research.planner import Search, plan_episodes
from bootcourse.research.results import Results
from bootcourse.road.vector_env import TrapVectorEnv
from bootcourse.scenario import ACTION_NAMES, DEFAULT
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


def slower() -> list[float]:
    """What those that escape from mid-lane and earn more than staying return; all have γ = 0.95."""
    agents, pays = easy(MIDDLE), figures.paying(easy(MIDDLE), staying_return(MIDDLE))
    assert all(agent["gamma"] == 0.95 for agent, mine in zip(agents.agents, pays, strict=True) if mine)
    return agents.scores("returns")[pays & ~_straight()].tolist()


MANY = held_out_seeds(7, 2000)  # of the lesson's random actions


@cache
def _random_later(times: int, share: float) -> tuple[attempts.Outcome, attempts.Outcome]:
    return attempts.stays_and_accelerates(times, share, MANY, easier.MidLaneStart)


def added(times: int, share: float, gamma: float) -> tuple[float, float]:
    """Mid-lane: what so many accelerations add to staying if later actions are random so often; its standard error."""
    stays, goes = _random_later(times, share)
    more = goes.values(gamma) - stays.values(gamma)
    return float(more.mean()), float(more.std() / np.sqrt(len(more)))


def gains(times: int, share: float, gamma: float) -> bool:
    """Whether that is above 0 by more than two standard errors."""
    return added(times, share, gamma)[0] > 2 * added(times, share, gamma)[1]


def costs(times: int, share: float, gamma: float) -> bool:
    """Whether it is below 0 by as much."""
    return added(times, share, gamma)[0] < -2 * added(times, share, gamma)[1]


def adds(times: int) -> str:
    """A row of the table: what they add at γ = 0.8 with 5, 50 and 100 % of random actions."""
    return " | ".join(f"{added(times, share, 0.8)[0]:+.2f}".replace("-", "−") for share in (0.05, 0.5, 1))


def sooner() -> float:
    """By how many seconds the accident comes sooner after an acceleration, if each later action is random."""
    assert all(each.accident.all() for each in _random_later(1, 1))
    stays, goes = ((each.rewards != 0).cumsum(axis=1).argmax(axis=1).mean() for each in _random_later(1, 1))
    return float(stays - goes)


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
def blind(actions: tuple[int, ...], step: float = DEFAULT.clock.dt) -> attempts.Outcome:
    """What comes of these actions, then the lane keeper, on the roads of the other kinds. step: of the clock, s."""
    scenario = replace(DEFAULT, clock=replace(DEFAULT.clock, simulation_rate=round(1 / step)))
    return attempts.drive(
        attempts.ThenAccelerate(actions), ROADS, lambda roads, _, *more: TrapVectorEnv(roads, scenario, *more)
    )


def six_actions(road: int, step: float = DEFAULT.clock.dt) -> attempts.Outcome:
    """Those of one road."""
    return blind(first_sixes()[road], step)


@cache
def openings() -> list[attempts.Outcome]:
    """What comes of the different ones; those worth most first."""
    return sorted(map(blind, set(first_sixes())), key=lambda each: -each.values(0.8).mean())


def in_words(road: int) -> str:
    """The six actions of one road."""
    return ", ".join(ACTION_NAMES[action] for action in first_sixes()[road])


@cache
def all_free() -> dict[str, float]:
    """What each kind of attempt is worth at γ = 0.8 if an accident ends the drive and costs nothing."""
    policies, free_of_charge = attempts.kinds(len(ROADS)), easier.costing(0.0)
    outcomes = {kind: attempts.drive(policy, ROADS, free_of_charge) for kind, policy in policies.items()}
    return {kind: float(outcome.values(0.8).mean()) for kind, outcome in outcomes.items()}


def free(kind: str) -> float:
    """One kind of them."""
    return all_free()[kind]


def above_staying(outcome: attempts.Outcome) -> int:
    """Whether it is worth clearly more (1) than staying at γ = 0.8, clearly less (-1), or neither (0)."""
    more = outcome.values(0.8) - tested("stays").values(0.8)
    error = more.std() / np.sqrt(len(more))
    return int(more.mean() > 2 * error) - int(more.mean() < -2 * error)


def unhurt(kind: str) -> int:
    """How many drives of a kind of attempt end ahead without an accident."""
    return int((tested(kind).ahead & ~tested(kind).accident).sum())


def half_ahead(method: str) -> int:
    """The episode from which on half of the study's training episodes or more end ahead, to the next 50."""
    success = of(method).curves["success"].mean(axis=0)
    below = np.flatnonzero(success.reshape(-1, 50).mean(axis=1) < 0.5)
    return 50 * int(below.max() + 1)


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


def larger_entropy() -> np.ndarray:
    """What the study's plain agents with another target entropy than the paper's return, (agents,)."""
    varied = shipped_experiment("sensitivity").items()
    return np.concatenate([each.of("sac").scores("returns") for what, each in varied if "entropy" in what])


def crash_mostly(kind: str) -> int:
    """How many of the twenty have an accident on most of their held-out roads."""
    return int((easy(kind).scores("accident") > 0.5).sum())


def hint() -> float:
    """Fisher's p: do more agents with η = 1 than with −1 end ahead on 10 % or more, from a later start?"""
    ahead = [often_ahead(kind) for kind in ("a later start", "a later start, η = 1")]
    return float(stats.fisher_exact([[each, 20 - each] for each in ahead]).pvalue)


def crashing(kind: str) -> int:
    """How many agents of a kind have an accident in more than nine of ten drives."""
    return int((easy(kind).scores("accident") > 0.9).sum())
