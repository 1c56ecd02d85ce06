"""What the lesson's cells do with drives: try plans on a road, and pay each second of a drive."""

import itertools
from collections.abc import Callable, Sequence

import numpy as np
from gymnasium.vector import AutoresetMode

from bootcourse.course.shipped import shipped_agents
from bootcourse.episodes.driving import steps
from bootcourse.episodes.evaluate import Episodes, drive_episodes, held_out_seeds
from bootcourse.episodes.record import record
from bootcourse.episodes.rollout import Rollout
from bootcourse.policies import PlanPolicy, idle_policy, plan_policy, rule_policy
from bootcourse.road.state import EGO, HEADING, LANE, SPEED, STEERING, TRAP_2, X, Y
from bootcourse.road.vector_env import TrapVectorEnv
from bootcourse.scenario import DEFAULT

ACCELERATE = 7  # "accelerate straight"


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


def worths(
    reward: Callable, plan: Sequence[str | tuple[str, int]], gamma: float = 0.8
) -> dict[str, tuple[float, float]]:
    """What some drivers' ways are worth, and how often these crash: means of the first 100 held-out roads.

    reward: as in `paid`; plan: what the blind plan does, in words. The agents are all that ship with the rule's help.
    """
    ways = {
        "staying": idle_policy,
        "the rule's way": rule_policy(DEFAULT),
        "the blind plan": plan_policy(plan),
    }
    for k, agent in enumerate(shipped_agents("bootstrapped"), 1):
        ways[f"agent {k} with help"] = agent.as_policy()
    found = {}
    for name, policy in ways.items():
        recorded = record(policy, held_out_seeds(1, 100))
        each = [gamma ** np.arange(len(drive.actions)) @ paid(reward, drive) for drive in recorded]
        found[name] = float(np.mean(each)), float(np.mean([drive.accident > 0 for drive in recorded]))
    return found
