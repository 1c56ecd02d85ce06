"""Imagining the road: what the planner and the look-ahead compute with the compiled road as their model."""

import numpy as np

from bootcourse.errors import BootcourseError
from bootcourse.road import twin
from bootcourse.road.constants import constants
from bootcourse.road.formulas import speed_reward
from bootcourse.road.state import COLUMNS
from bootcourse.scenario import N_ACTIONS, Scenario


def advance(cars: np.ndarray, actions: np.ndarray, accidents: np.ndarray, scenario: Scenario) -> np.ndarray:
    """One decision on each imagined road, in place: the rewards, (roads,).

    cars (roads, vehicles, 10); actions (roads,) in 0..8; accidents (roads,) int, an Accident's number. A road that
    already had an accident stands still, with reward 0. Raises BootcourseError for cars of another shape, and for what
    are not whole actions in 0..8, one for each road: whoever decides may be a reader's own code.
    """
    actions, roads = np.asarray(actions), (len(cars),)
    if cars.shape[1:] != (scenario.vehicles, COLUMNS):
        raise BootcourseError(f"cars have shape {cars.shape}: give (roads, {scenario.vehicles}, {COLUMNS}).")
    if actions.shape != roads or actions.dtype.kind not in "iu" or ((actions < 0) | (actions >= N_ACTIONS)).any():
        raise BootcourseError(
            f"actions have shape {actions.shape} and type {actions.dtype}: give whole numbers in 0..8, shape {roads}."
        )
    rewards, terms, asleep = np.zeros(len(cars)), np.zeros((len(cars), 3)), accidents != 0
    actions = np.ascontiguousarray(actions, dtype=np.int64)
    twin.decide(cars, actions, asleep, constants(scenario), rewards, terms, accidents, twin.NO_TRACE)
    return rewards


def expand(cars: np.ndarray, scenario: Scenario) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """All nine actions from each of some roads: cars (n, vehicles, 10) -> (n x 9, vehicles, 10), (n, 9), (n, 9).

    The children, their rewards, their accidents (an Accident's number).
    """
    children = cars.repeat(N_ACTIONS, axis=0)
    accidents = np.zeros(len(children), dtype=np.int64)
    rewards = advance(children, np.tile(np.arange(N_ACTIONS), len(cars)), accidents, scenario)
    return children, rewards.reshape(-1, N_ACTIONS), accidents.reshape(-1, N_ACTIONS)


def future_worth(scenario: Scenario, decisions: int, gamma: float) -> list[tuple[np.ndarray, np.ndarray]]:
    """The return on an empty road: for 0, 1, ... decisions left, (speeds, Σ γ^t r_t) to interpolate in.

    The ego goes to the best speed as fast as it can and keeps its lane: an upper bound for every drive.
    """
    a, weights = scenario.ego.acceleration / scenario.clock.decision_rate, scenario.reward
    speeds = np.linspace(0.0, scenario.ego.max_speed, 401)
    reward = weights.w_v * np.array([speed_reward(v) for v in speeds]) + weights.w_y
    reward /= weights.w_v + weights.w_y + weights.w_theta
    best = speeds[reward.argmax()]
    following = speeds + np.clip(best - speeds, -a, a)
    worth = [np.zeros_like(speeds)]
    for _ in range(decisions):
        worth.append(np.interp(following, speeds, reward + gamma * worth[-1]))
    return [(speeds, values) for values in worth]
