"""What the numbers and claims in this lesson's text are computed from, beside tools/course/known.py."""

from functools import cache

import numpy as np

from bootcourse.course.lessons.the_barrier import attempts, easier, explorable, figures
from bootcourse.course.lessons.the_trap import numbers as the_trap
from bootcourse.course.lessons.the_trap.exercises import bearable_risk
from bootcourse.course.shipped import shipped_agents
from bootcourse.episodes.evaluate import drive_episodes, held_out_seeds
from bootcourse.policies import PlanPolicy, random_policy
from bootcourse.research.planner import Search, is_staying_optimal, plan_episodes
from bootcourse.research.results import Results
from bootcourse.scenario import DEFAULT
from bootcourse.statistics import ESCAPES
from tools.course.known import ROAD, by_rule, discounted, idle, shipped_experiment


@cache
def planned() -> float:
    """What the planner's drive on the lesson's road earns."""
    return plan_episodes([ROAD], search=Search(beam=50))[0].value


@cache
def by_chance():
    """The barrier's 5,000 random drives."""
    return drive_episodes(random_policy(np.random.default_rng(0)), held_out_seeds(6, 5000))


def bearable(gamma: float, price: float = -DEFAULT.reward.accident) -> float:
    """The share of crashes that lesson 1 bears: on its road, like its plan, or a crash after 3 s that costs `price`."""
    crash = gamma ** np.arange(4) @ [*by_rule().rewards[:3], -price]
    stay, leave = discounted(idle(), gamma), discounted(the_trap.on_ten(), gamma)
    return float(bearable_risk.solution(stay, leave, crash))


def the_plan_crashes() -> float:
    """On which share of lesson 1's roads its plan ends in an accident."""
    share = float(np.mean(the_trap.blind_plan().accident > 0))
    assert share == explorable.the_plan_crashes()  # which the panel draws
    return share


def easy(kind: str) -> Results:
    """The twenty agents of one of `easier.KINDS`."""
    return shipped_experiment("easier")[kind]


MIDDLE, CHEAP, KEPT, BOTH = easier.MIDDLE, easier.CHEAP, easier.KEPT, easier.BOTH
stressed = easier.stressed


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


def crash_on_most(kind: str) -> int:
    """How many agents of a kind have an accident on most roads."""
    return int((easy(kind).scores("accident") > 0.5).sum())


def escape_and_crash(kind: str) -> int:
    """How many agents of a kind escape, and have an accident on most roads."""
    agents = easy(kind)
    return int(((agents.scores("accident") > 0.5) & (agents.scores("success") >= ESCAPES)).sum())


def earn_more(kind: str, longer: bool = False) -> int:
    """How many agents of a kind earn more than by staying; longer: of the others, with twice the updates."""
    agents = easy(stressed(kind)) if longer else easy(kind)
    return int((agents.scores("returns") > easier.staying(kind)).sum())


def earn_and(crash: bool) -> int:
    """How many of the agents that escape and earn with both changes have an accident on most roads, or have not."""
    return figures.ends(easy(BOTH), easier.staying(BOTH)).count((figures.FAR, crash))


@cache
def wished() -> attempts.Outcome:
    """What comes of the text's wishes with a lane keeper, slower 1, left 5, faster 5, on 100 roads."""
    return attempts.drive(PlanPolicy([3, *[1] * 5, *[5] * 5]), held_out_seeds(7, 100), easier.LaneKeeper)


@cache
def one_acceleration() -> attempts.Outcome:
    """What comes of one acceleration mid-lane, on 100 roads."""
    return attempts.drive(PlanPolicy([attempts.ACCELERATE]), held_out_seeds(7, 100), easier.MidLaneStart)


@cache
def helped() -> np.ndarray:
    """What the drives of each shipped agent that the rule helped are worth at γ = 0.8, on 100 roads."""
    agents = [agent for method in ("soft", "bootstrapped") for agent in shipped_agents(method)]
    return np.array([attempts.drive(agent.as_policy(), held_out_seeds(7, 100)).values(0.8).mean() for agent in agents])


def helped_better() -> np.ndarray:
    """Those of them that are worth more than staying."""
    return helped()[helped() > discounted(idle(), 0.8)]


def farther() -> np.ndarray:
    """Which agents of plain SAC with a larger γ than the paper's escape on the road as it is."""
    found = [easy("as it is")]
    for name in ("sensitivity", "beyond", "beyond-search", "others"):
        found += [each.of("sac") for each in shipped_experiment(name).values() if "sac" in each.methods]
    escaping = [agents.scores("success") >= ESCAPES for agents in found]
    return np.concatenate([e[[one["gamma"] > 0.8 for one in a.agents]] for a, e in zip(found, escaping, strict=True)])


@cache
def searched():
    """The lesson's best drives at γ = 0.8."""
    return is_staying_optimal(range(4), gamma=0.8, beam=50)


def driven() -> np.ndarray:
    """How many drives each of the twenty agents ended while it learned."""
    return np.isfinite(easy("as it is").curves["success"]).sum(axis=1)


def times_ahead() -> np.ndarray:
    """How many drives each of the twenty ended ahead while it learned."""
    return figures.times_ahead(easy("as it is"))
