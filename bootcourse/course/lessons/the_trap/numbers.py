"""What the numbers and claims in this lesson's text are computed from, beside tools/course/known.py."""

from functools import cache

import numpy as np

from bootcourse.course.lessons.the_barrier.explorable import by_plan
from bootcourse.course.lessons.the_trap import driving, time_step  # noqa: F401 (time_step: for the expressions)
from bootcourse.course.lessons.the_trap.driving import ALONE as ALONE
from bootcourse.course.lessons.the_trap.driving import HELPED as HELPED
from bootcourse.course.lessons.the_trap.driving import all_plans
from bootcourse.course.lessons.the_trap.exercises import bearable_risk, reward
from bootcourse.course.lessons.the_trap.figures import RIGHT_FIRST
from bootcourse.course.lessons.the_trap.time_step import unhurt
from bootcourse.course.shipped import shipped_agents
from bootcourse.episodes.evaluate import Episodes, drive_episodes, held_out_seeds
from bootcourse.episodes.record import record
from bootcourse.episodes.rollout import Rollout
from bootcourse.episodes.words import overtaken as overtaken
from bootcourse.policies import PlanPolicy, plan_policy
from bootcourse.research.paper import PRINTED
from bootcourse.road.state import EGO, SPEED
from bootcourse.scenario import DEFAULT
from bootcourse.statistics import ESCAPES
from tools.course.known import by_rule, discounted, idle, shipped_results

PLAN = [*RIGHT_FIRST, ("accelerate straight", 5)]  # it looks at nothing
BLIND = plan_policy(PLAN)


@cache
def straight() -> np.ndarray:
    """Which of all plans steer left as often as right, (6561,) bool."""
    return (all_plans() == 3).sum(axis=1) == (all_plans() == 5).sum(axis=1)


@cache
def all_drives(road: int) -> Episodes:
    """What comes of all plans on a road."""
    return driving.drives(all_plans(), road)


def unhurt_plans(road: int) -> np.ndarray:
    """Which of all plans get out unhurt on a road, (6561,) bool."""
    return (all_drives(road).success > 0) & (all_drives(road).accident == 0)


@cache
def best_on_others() -> list[int]:
    """Of the plans that get out unhurt on road 10, the one that does so on most of 200 roads that are not held out."""
    plans, roads = all_plans()[unhurt_plans(10)], range(20, 220)
    actions = np.vstack([plans.T, np.full((5, len(plans)), driving.ACCELERATE)])
    ended = drive_episodes(PlanPolicy(np.repeat(actions, 200, axis=1)), [*roads] * len(plans), together=10_000)
    unhurt = ((ended.success > 0) & (ended.accident == 0)).reshape(-1, 200)
    return plans[unhurt.sum(axis=1).argmax()].tolist()


@cache
def blind_plan():
    """The plan that looks at nothing on the study's 1,000 held-out roads: its episodes."""
    return drive_episodes(BLIND, held_out_seeds(1, 1000))


@cache
def on_ten() -> Rollout:
    """That plan on road 10."""
    return record(BLIND, [10])[0]


def helped_on_ten() -> float:
    """What the γ panel's agent with the rule's help is worth on road 10, at γ = 0.8."""
    return discounted(helped_drive(), 0.8)


@cache
def pays_from() -> float:
    """The smallest γ, in steps of 0.01, from which on the rule's way out is worth more than staying."""
    gammas = np.arange(50, 101) / 100
    pays = np.array([discounted(by_rule(), gamma) > discounted(idle(), gamma) for gamma in gammas])
    return float(gammas[np.flatnonzero(~pays)[-1] + 1])


@cache
def at_random() -> Episodes:
    """500 drives whose actions are drawn at random, as an agent's first ones are."""
    actions = np.random.default_rng(0).integers(0, 9, (30, 500))
    return drive_episodes(PlanPolicy(actions), held_out_seeds(1, 500), together=1000)


@cache
def alone_on_ten() -> Rollout:
    """The agent of plain SAC that escapes, on road 10."""
    return record(shipped_agents("sac")[3].as_policy(), [10])[0]


@cache
def helped_drive() -> Rollout:
    """The γ panel's agent with the rule's help, on road 10."""
    return record(shipped_agents("bootstrapped")[2].as_policy(), [10])[0]


def speeds(drive: Rollout) -> str:
    """How fast it is (m/s) in the first ten seconds, and when it passes trap 1, as cells of a table."""
    return " | ".join(
        [*(f"{drive.states[2 * at, EGO, SPEED]:.0f} m/s" for at in range(0, 11, 2)), f"{overtaken(drive):.0f} s"]
    )


@cache
def worths() -> dict[str, driving.Worth]:
    """What the drivers of the last figure are worth, and how often they crash."""
    return driving.worths(reward.solution, PLAN)


def alone_out() -> np.ndarray:
    """How often plain SAC's agents that escape crash, (escapers,)."""
    agents = shipped_results().of("sac")
    return agents.scores("accident")[agents.scores("success") >= ESCAPES]


def crashed_early() -> np.ndarray:
    """On which of those roads the plan crashes in its first ten seconds: (1000,) bool."""
    return by_plan().accident & (by_plan().lasted <= 10)


def borne(gamma: float, way: Rollout, accident: float = DEFAULT.reward.accident, stay: float | None = None) -> float:
    """The risk of an early crash that a way out on road 10 bears, if the crash comes when the lesson's does.

    stay: what staying is worth; if None, doing nothing.
    """
    stay = discounted(idle(), gamma) if stay is None else stay
    crash = gamma ** np.arange(5) @ [*on_ten().rewards[:4], accident]
    return bearable_risk.solution(stay, discounted(way, gamma), crash)


@cache
def in_steps(tau: float, step: float) -> float:
    """On which share of those roads the plan gets out unhurt, by the traffic's time constant and the time step (s)."""
    return unhurt(PLAN, tau, step)


def printed(method: str) -> str:
    """The paper's success, %, and return of a method, as two cells of a table."""
    return f"{PRINTED[method]['success'].mean} | {PRINTED[method]['returns'].mean:.2f}"


def staying() -> np.ndarray:
    """Which of plain SAC's agents never get out, and crash in less than a tenth of their drives: (agents,) bool."""
    agents = shipped_results().of("sac")
    return (agents.scores("success") == 0) & (agents.scores("accident") < 0.1)


def crash_on_most() -> np.ndarray:
    """Which of the agents with the rule's help do not escape, and crash on most roads: (agents,) bool."""
    agents = shipped_results().of("bootstrapped")
    return (agents.scores("success") < ESCAPES) & (agents.scores("accident") > 0.5)
