"""What the lesson's cells do with drives: try plans on a road, and pay each second of a drive."""

import itertools
from collections.abc import Callable, Sequence
from typing import NamedTuple

import numpy as np
from gymnasium.vector import AutoresetMode

from bootcourse.course.shipped import shipped_agents
from bootcourse.episodes.driving import steps
from bootcourse.episodes.evaluate import Episodes, drive_episodes, held_out_seeds
from bootcourse.episodes.record import record
from bootcourse.episodes.rollout import Rollout
from bootcourse.policies import PlanPolicy, Policy, idle_policy, plan_policy, rule_policy
from bootcourse.road.state import EGO, HEADING, LANE, SPEED, STEERING, TRAP_2, X, Y
from bootcourse.road.vector_env import TrapVectorEnv
from bootcourse.scenario import DEFAULT

ACCELERATE = 7  # "accelerate straight"
ALONE, HELPED = "the plain agent that escapes", "an agent with help"


def all_plans() -> np.ndarray:
    """The plans that steer left (3), straight (4) or right (5) in each of eight seconds: (6561, 8)."""
    return np.array(list(itertools.product((3, 4, 5), repeat=8)))


def drives(plans: np.ndarray, road: int) -> Episodes:
    """What comes of plans (n, 8), and then five seconds of acceleration, on one road."""
    actions = np.vstack([np.asarray(plans).T, np.full((5, len(plans)), ACCELERATE)])
    return drive_episodes(PlanPolicy(actions), [road] * len(plans), together=10_000)


def on_road(road: int) -> Callable[[np.ndarray], np.ndarray]:
    """gets_out(plans) for one road: which plans (n, 8), and then five seconds of acceleration, get out unhurt."""

    def gets_out(plans):
        ended = drives(plans, road)
        return ended.success & (ended.accident == 0)

    return gets_out


def trap_2_starts(roads: int = 1000) -> np.ndarray:
    """How far ahead of the ego (m) trap 2 starts on each of the first held-out roads, (roads,)."""
    env = TrapVectorEnv(roads, DEFAULT, AutoresetMode.DISABLED)
    cars = next(steps(idle_policy, env, held_out_seeds(1, roads))).cars
    return cars[:, TRAP_2, X] - cars[:, EGO, X]


def paid(reward: Callable, drive: Rollout) -> np.ndarray:
    """What a reward function (v_lon, offset, theta, accident) pays for each second of a drive, (seconds,)."""
    seconds, steps, width = len(drive.actions), drive.scenario.clock.steps, drive.scenario.road.lane_width
    after = drive.states[np.minimum(steps * np.arange(1, seconds + 1), len(drive.states) - 1), EGO]
    speeds, offsets = after[:, SPEED] * np.cos(after[:, HEADING]), after[:, Y] - after[:, LANE] * width
    accidents = [0] * (seconds - 1) + [drive.accident]
    each = zip(speeds.tolist(), offsets.tolist(), after[:, STEERING].tolist(), accidents, strict=True)
    return np.array([float(reward(*second)) for second in each])


class Worth(NamedTuple):
    """What a driver's way is worth, the mean of some roads, and what its crashes have to do with that."""

    worth: float
    crashes: float  # the share of drives that crash
    unpaid: float  # what the way would be worth if its crashes paid 0
    seconds: np.ndarray  # in which each of its crashes comes


def worths(reward: Callable, plan: Sequence[str | tuple[str, int]], gamma: float = 0.8) -> dict[str, Worth]:
    """What some drivers' ways are worth on the first 100 held-out roads.

    reward: as in `paid`; plan: what the blind plan does, in words. Of the agents that ship, the fourth of plain
    SAC escapes, and so does the third with the rule's help, which the γ panel shows. Staying is doing nothing.
    """
    alone, helped = shipped_agents("sac"), shipped_agents("bootstrapped")
    ways = {
        "staying": idle_policy,
        "the rule's way": rule_policy(DEFAULT),
        "the blind plan": plan_policy(plan),
        ALONE: alone[3].as_policy(),
        HELPED: helped[2].as_policy(),
    }
    return {name: worth(policy, reward, gamma) for name, policy in ways.items()}


def worth(policy: Policy, reward: Callable, gamma: float = 0.8) -> Worth:
    """What a driver's way is worth on the first 100 held-out roads."""
    recorded = record(policy, held_out_seeds(1, 100))
    weights = gamma ** np.arange(DEFAULT.clock.decisions)
    each = [weights[: len(drive.actions)] * paid(reward, drive) for drive in recorded]
    crashed = np.array([drive.accident > 0 for drive in recorded])
    total, last = (np.array([of(rewards) for rewards in each]) for of in (np.sum, lambda rewards: rewards[-1]))
    seconds = np.array([len(drive.actions) for drive in recorded])[crashed]
    return Worth(float(total.mean()), float(crashed.mean()), float((total - crashed * last).mean()), seconds)
