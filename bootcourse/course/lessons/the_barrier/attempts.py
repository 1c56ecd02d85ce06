"""Attempts to leave the trap, from chance to a plan, and what each kind of attempt is worth."""

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass

import numpy as np
from gymnasium.vector import AutoresetMode, VectorEnv

from bootcourse.episodes.driving import steps
from bootcourse.learn.teachers import toward
from bootcourse.policies import PlanPolicy, Policy, PolicyOutput, idle_policy, random_policy, rule_policy
from bootcourse.road.state import EGO, LANE, SPEED
from bootcourse.road.vector_env import TrapVectorEnv
from bootcourse.scenario import DEFAULT, N_ACTIONS

FAST = 15.0  # m/s; the speed that pays most
ACCELERATE = 7  # straight on
PLAN = [5, *[3] * 4, *[5] * 3, *[7] * 5]  # right 1 s, left 4 s, right 3 s, accelerate 5 s


@dataclass(frozen=True)
class Outcome:
    """What came of one drive on each road; every array is (roads,)."""

    rewards: np.ndarray  # (roads, decisions); 0 after an accident
    ahead: np.ndarray  # bool: ahead of trap 1 at the end
    accident: np.ndarray  # bool: ended in an accident of any kind

    def values(self, gamma: float) -> np.ndarray:
        """Σ γ^t r_t from the start of each drive."""
        return self.rewards @ gamma ** np.arange(self.rewards.shape[1])


class ThenAccelerate:
    """A policy that takes the given actions, and then accelerates to 15 m/s in the middle of the lane where it is.

    actions: int, 0..8, (decisions,) for all roads alike or (decisions, roads).
    """

    def __init__(self, actions: Sequence[int] | np.ndarray):
        self.plan = PlanPolicy(actions)

    def reset(self, roads: int) -> None:
        """Restart the plan."""
        self.plan.reset(roads)

    def __call__(self, observations: np.ndarray, cars: np.ndarray) -> PolicyOutput:
        if self.plan.decision < len(self.plan.actions):
            return self.plan(observations, cars)
        return PolicyOutput(keep_lane(cars, np.full(len(cars), FAST), cars[:, EGO, LANE]))


def keep_lane(cars: np.ndarray, speeds: np.ndarray, lanes: np.ndarray) -> np.ndarray:
    """The actions (roads,) that bring each ego to a speed (m/s) and the middle of a lane, by the rule's tracker."""
    return np.array([toward(*wish) for wish in zip(cars, speeds, lanes, strict=True)])


def random_wishes(rng: np.random.Generator) -> Policy:
    """Each second a lane at most one away and brake, keep or accelerate, drawn at random; a lane keeper steers."""

    def decide(observations: np.ndarray, cars: np.ndarray) -> PolicyOutput:
        lanes = cars[:, EGO, LANE] + rng.integers(-1, 2, len(cars))
        speeds = cars[:, EGO, SPEED] + rng.integers(-1, 2, len(cars))
        return PolicyOutput(keep_lane(cars, speeds, np.clip(lanes, 0, DEFAULT.road.lanes - 1)))

    return decide


def drive(policy: Policy, seeds: Sequence[int], make_env: Callable[..., VectorEnv] = TrapVectorEnv) -> Outcome:
    """One drive on the road of each seed. make_env: the roads, such as those of easier.py."""
    env = make_env(len(seeds), DEFAULT, AutoresetMode.DISABLED)  # after an episode's end its reward is 0
    rewards, accident = [], np.zeros(len(seeds), dtype=bool)
    for step in steps(policy, env, list(seeds)):
        rewards.append(step.rewards)
        accident |= step.infos["accident"] > 0
    return Outcome(np.stack(rewards, axis=1), step.infos["is_success"], accident)


def kinds(roads: int, seed: int = 0) -> Mapping[str, Policy]:
    """The lesson's kinds of attempts, and what they are compared with."""
    rng = np.random.default_rng(seed)
    return {
        "stays": idle_policy,
        "random for 150 s": random_policy(rng),
        "4 random actions, then accelerates": ThenAccelerate(rng.integers(N_ACTIONS, size=(4, roads))),
        "random lanes and speeds": random_wishes(rng),
        "one plan, then accelerates": ThenAccelerate(PLAN),
        "the rule's way": rule_policy(DEFAULT),
    }
