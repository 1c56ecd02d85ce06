"""Roads with another reward, for the lesson on the second trap: `Repaid` hands each decision's reward to a function."""

from collections.abc import Callable

import numpy as np

from bootcourse.episodes.record import Rollout
from bootcourse.road.state import EGO, SPEED, Y
from bootcourse.road.vector_env import TrapVectorEnv
from bootcourse.scenario import DEFAULT

Pay = Callable[[np.ndarray, np.ndarray, np.ndarray, np.ndarray], np.ndarray]  # see `Repaid`
TWELVE = range(10, 22)  # roads
PER_LANE = 20.0  # potential of a lane further left


class Repaid(TrapVectorEnv):
    """The compiled road with another reward: pay(rewards, before, after, terminated), each (roads, ...).

    before, after: the cars' states (roads, vehicles, 10) at both ends of the decision; `rewards` is what the road pays.
    """

    def __init__(self, num_envs: int, pay: Pay):
        super().__init__(num_envs)
        self.pay = pay

    def step(self, actions):
        before = self.cars.copy()
        observations, rewards, terminated, truncated, infos = super().step(actions)
        ended = (terminated | truncated)[:, None, None]
        after = np.where(ended, self.final_cars, self.cars)  # where a road has begun anew, the old episode's last state
        return observations, self.pay(rewards, before, after, terminated), terminated, truncated, infos


def speeds(drive: Rollout) -> np.ndarray:
    """The ego's speed (m/s) after each decision, (decisions,)."""
    steps = drive.scenario.clock.steps
    return drive.states[steps::steps, EGO, SPEED]


def left_of(cars: np.ndarray) -> np.ndarray:
    """A potential Φ: `PER_LANE` for each lane that the ego has come to the left. (roads, ...) -> (roads,)."""
    road = DEFAULT.road
    return PER_LANE * ((road.lanes - 1) - cars[:, EGO, Y] / road.lane_width)


def shaping_reward(phi: np.ndarray, next_phi: np.ndarray, terminated: np.ndarray, gamma: float) -> np.ndarray:
    """F = γ Φ(s') - Φ(s), with Φ = 0 after an accident: (roads,). Ng, Harada and Russell (1999)."""
    return gamma * next_phi * (1 - terminated) - phi


def shaped_pay(potential: Callable[[np.ndarray], np.ndarray], gamma: float) -> Pay:
    """The road's reward and the shaping reward of a potential, Φ(cars) -> (roads,)."""

    def pay(rewards, before, after, terminated):
        return rewards + shaping_reward(potential(before), potential(after), terminated, gamma)

    return pay
