"""Attempts to leave the trap, and what they are worth."""

from collections.abc import Callable, Sequence
from dataclasses import dataclass

import numpy as np
from gymnasium.vector import AutoresetMode, VectorEnv

from bootcourse.episodes.driving import steps
from bootcourse.policies import Policy
from bootcourse.road.constants import constants
from bootcourse.road.vector_env import TrapVectorEnv
from bootcourse.rule import track
from bootcourse.scenario import DEFAULT

ACCELERATE = 7  # straight on
PLAN = [5, *[3] * 4, *[5] * 3, *[7] * 5]  # right 1 s, left 4 s, right 3 s, accelerate 5 s


@dataclass(frozen=True)
class Outcome:
    """What came of one drive on each road; every array is (roads,)."""

    rewards: np.ndarray  # (roads, decisions); 0 after an accident
    ahead: np.ndarray  # bool: ahead of trap 1 at the end
    accident: np.ndarray  # bool: ended in an accident of any kind
    lasted: np.ndarray  # decisions until its end

    def values(self, gamma: float) -> np.ndarray:
        """Σ γ^t r_t from the start of each drive."""
        return self.rewards @ gamma ** np.arange(self.rewards.shape[1])

    def priced(self, price: float) -> np.ndarray:
        """The rewards where an accident costs `price`, (roads, decisions)."""
        rewards = self.rewards.copy()
        rewards[self.accident, self.lasted[self.accident] - 1] = -price
        return rewards


def keep_lane(cars: np.ndarray, speeds: np.ndarray, lanes: np.ndarray) -> np.ndarray:
    """The actions (roads,) that bring each ego to a speed (m/s) and the middle of a lane, by the rule's tracker."""
    of_the_road = constants(DEFAULT)
    wishes = zip(cars, speeds.tolist(), lanes.astype(int).tolist(), strict=True)
    return np.array([track(*wish, of_the_road) for wish in wishes])


def drive(policy: Policy, seeds: Sequence[int], make_env: Callable[..., VectorEnv] = TrapVectorEnv) -> Outcome:
    """One drive on the road of each seed. make_env: the roads, such as those of easier.py."""
    env = make_env(len(seeds), DEFAULT, AutoresetMode.DISABLED)  # after an episode's end its reward is 0
    rewards, accident, lasted = [], np.zeros(len(seeds), dtype=bool), np.zeros(len(seeds), dtype=int)
    for step in steps(policy, env, list(seeds)):
        rewards.append(step.rewards)
        accident |= step.infos["accident"] > 0
        lasted += step.running
    return Outcome(np.stack(rewards, axis=1), step.infos["is_success"], accident, lasted)
