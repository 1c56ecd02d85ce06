"""What the numbers and claims in this lesson's text are computed from, beside tools/course/known.py."""

from functools import cache

import numpy as np

from bootcourse.course.lessons.the_barrier import attempts, easier, explorable, figures
from bootcourse.course.shipped import shipped_agents
from bootcourse.episodes.evaluate import drive_episodes, held_out_seeds
from bootcourse.policies import PlanPolicy, idle_policy, random_policy, rule_policy
from bootcourse.research.planner import Search, is_staying_optimal, plan_episodes
from bootcourse.research.results import Results
from bootcourse.scenario import DEFAULT
from bootcourse.statistics import ESCAPES
from tools.course.known import ROAD, of, shipped_experiment


@cache
def planned(beam: int, gamma: float, keep_lane: bool = False) -> float:
    """What the planner's best drive on the lesson's road is worth."""
    return plan_episodes([ROAD], search=Search(beam, gamma, keep_lane))[0].value


@cache
def by_chance():
    """The barrier's 5,000 random drives."""
    return drive_episodes(random_policy(np.random.default_rng(0)), held_out_seeds(6, 5000))


UNSKILLED = ("random for 150 s", "4 random actions, then accelerates", "random lanes and speeds")
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


ONCE = "accelerates once, then nothing"
MIDDLE, CHEAP, BOTH = easier.MIDDLE, easier.CHEAP, easier.BOTH
stressed = easier.stressed
RAM = "accelerates into trap 1"


def slope(share: float, price: float, gamma: float) -> tuple[float, float]:
    """Mid-lane, with this share of random actions: what 11 m/s is worth more than 10; its standard error."""
    values = explorable.at_price(explorable.rewards_from(share), price)
    worth = values @ gamma ** np.arange(values.shape[-1])
    more = worth[explorable.NOW + 1] - worth[explorable.NOW]
    return float(more.mean()), float(more.std() / np.sqrt(len(more)))


def costs(share: float, price: float, gamma: float) -> bool:
    """Whether that is below 0 by more than two standard errors."""
    return slope(share, price, gamma)[0] < -2 * slope(share, price, gamma)[1]


def worths(share: float) -> np.ndarray:
    """What each of the picture's speeds is worth at γ = 0.8, (speeds,)."""
    rewards = explorable.rewards_from(share)
    return (rewards @ 0.8 ** np.arange(rewards.shape[-1])).mean(axis=1)


def ends_after(share: float) -> np.ndarray:
    """After how many seconds a drive from each of the picture's speeds has its accident, on average."""
    rewards = explorable.rewards_from(share)
    crashed = rewards == DEFAULT.reward.accident
    assert crashed.any(axis=-1).all()
    return 1 + crashed.argmax(axis=-1).mean(axis=1)


def slow(kind: str) -> int:
    """How many of the twenty drive slower than 8 m/s, on average."""
    return int((easy(kind).scores("speed") < 8).sum())


def _straight() -> np.ndarray:
    """Which agents from mid-lane drive faster than 20 m/s, on average."""
    return easy(MIDDLE).scores("speed") > 20


def as_fast_as_the_traps() -> int:
    """How many of the twenty from mid-lane neither escape nor are slow; they stay behind, as fast as the traps."""
    agents = easy(MIDDLE)
    rest = (agents.scores("success") < ESCAPES) & (agents.scores("speed") >= 8)
    assert (abs(agents.scores("speed")[rest] - DEFAULT.traps.speed) < 0.6).all()
    assert (agents.scores("success")[rest] == 0).all() and (agents.scores("accident")[rest] < 0.1).all()
    return int(rest.sum())


def straight_on() -> int:
    """How many they are."""
    return int(_straight().sum())


def straight_speed() -> float:
    """How fast they drive, on average, m/s."""
    return float(easy(MIDDLE).scores("speed")[_straight()].mean())


def straight_return() -> float:
    """The most that one of them earns."""
    return float(easy(MIDDLE).scores("returns")[_straight()].max())


def _freed() -> tuple[np.ndarray, np.ndarray]:
    """Of the agents that escape with both changes: what each earns, and whether it is faster than 20 m/s."""
    out = easy(BOTH).scores("success") >= ESCAPES
    return easy(BOTH).scores("returns")[out], easy(BOTH).scores("speed")[out] > 20


def too_fast() -> int:
    """How many of them are faster than 20 m/s; each of these earns less than a car that stays."""
    returns, fast = _freed()
    assert (returns[fast] < easier.staying(BOTH)).all()
    return int(fast.sum())


def freed_and_slower() -> np.ndarray:
    """What the others of them earn."""
    returns, fast = _freed()
    return returns[~fast]


def last_entropy() -> float:
    """The largest entropy of one of the study's plain agents in its last 100 training episodes, nats."""
    return float(of("sac").curves["entropy"][:, -100:].mean(axis=1).max())


def decided() -> int:
    """How many of the study's plain agents have an entropy of 0.01 nat or less in their last 100 training episodes."""
    return int((of("sac").curves["entropy"][:, -100:].mean(axis=1) <= 0.01).sum())


@cache
def easier_outcomes(road: str) -> dict[str, attempts.Outcome]:
    """What came of the lesson's drives on its 100 roads, made easier."""
    roads, make_env = held_out_seeds(7, 100), easier.KINDS[road][0]
    return {name: attempts.drive(each, roads, make_env) for name, each in easier.drivers(road).items()}


def easier_outcome(road: str, name: str) -> attempts.Outcome:
    """One of them."""
    return easier_outcomes(road)[name]


def worth_of(road: str, name: str, gamma: float) -> float:
    """What a drive on an easier road is worth, on average."""
    return float(easier_outcome(road, name).values(gamma).mean())


def may_crash(gamma: float) -> int:
    """How many of a hundred attempts of the panel may end in an accident before the others no longer pay for them."""
    roads = explorable.ROADS
    plan, stays = attempts.drive(attempts.ThenAccelerate(attempts.PLAN), roads), attempts.drive(idle_policy, roads)
    values = plan.values(gamma)
    out, crashed = values[~plan.accident].mean(), values[plan.accident].mean()
    return int(100 * (out - stays.values(gamma).mean()) / (out - crashed))


def may_crash_there(gamma: float) -> float:
    """The same in lesson the_trap: one road, and a crash after 3 s of the rule's way."""
    plan, rule, stays = (
        attempts.drive(each, [ROAD]) for each in (PlanPolicy(attempts.PLAN), rule_policy(DEFAULT), idle_policy)
    )
    out, crashed = plan.values(gamma)[0], np.append(rule.rewards[0, :3], -10) @ gamma ** np.arange(4)
    return 100 * (out - stays.values(gamma)[0]) / (out - crashed)


@cache
def helped() -> np.ndarray:
    """What the drives of each shipped agent that the rule helped are worth at γ = 0.8, on the roads of the attempts."""
    agents = [agent for method in ("soft", "bootstrapped") for agent in shipped_agents(method)]
    return np.array([attempts.drive(agent.as_policy(), ROADS).values(0.8).mean() for agent in agents])


def helped_better() -> np.ndarray:
    """Those of them that are worth more than staying."""
    return helped()[helped() > tested("stays").values(0.8).mean()]


def farther() -> np.ndarray:
    """Which agents of plain SAC with a larger γ than the paper's escape on the road as it is."""
    found = [easy("as it is")]
    for name in ("sensitivity", "beyond", "beyond-search", "others"):
        found += [each.of("sac") for each in shipped_experiment(name).values() if "sac" in each.methods]
    escaping = [agents.scores("success") >= ESCAPES for agents in found]
    return np.concatenate([e[[one["gamma"] > 0.8 for one in a.agents]] for a, e in zip(found, escaping, strict=True)])


@cache
def times_the_lane(gamma: float) -> float:
    """How many times the best drive in the lane the best drive is worth, as the lesson finds them."""
    searched = is_staying_optimal(range(4), gamma=gamma, beam=50)
    return searched.best.value / searched.keep_lane.value


def driven() -> np.ndarray:
    """How many drives each of the twenty agents ended while it learned."""
    return np.isfinite(easy("as it is").curves["success"]).sum(axis=1)


def once_ahead(kind: str) -> int:
    """How many of the twenty ended a drive ahead while they learned."""
    return int(figures.once_ahead(easy(kind)).sum())


def once_unhurt() -> int:
    """How many of the study's plain agents ended a drive ahead and without an accident while they learned."""
    return int(figures.once_unhurt(of("sac")).sum())
