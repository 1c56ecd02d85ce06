"""A teacher of your own: a rule written as a plain function takes the place of the course's rule controller.

    def my_rule(cars, scenario):  # cars (vehicles, 10): one road, columns in bootcourse.road.state
        gap, speed = ahead(cars, 2, scenario)
        return toward(cars, speed - 1, 2, scenario)

    teacher_policy(my_rule)  # it drives
    demonstrations_of(my_rule)  # it demonstrates
    TaughtTraining(with_seeds(settings_for("bootstrapped"), 2), my_rule, episodes=300).run()  # it teaches

It reads the true state of a road and gives one of the nine actions, the same one for the same road.
"""

import math
from collections.abc import Callable, Sequence

import numpy as np
import torch
from gymnasium.vector import AutoresetMode
from torch import Tensor

from bootcourse.errors import BootcourseError
from bootcourse.learn.demonstrations import FIRST_SEED
from bootcourse.learn.replay_buffer import ReplayBuffer, encode_transitions
from bootcourse.learn.settings import Settings
from bootcourse.learn.training import Training
from bootcourse.policies import Policy, PolicyOutput
from bootcourse.road.constants import constants
from bootcourse.road.state import EGO, LANE, SPEED, X
from bootcourse.road.vector_env import TrapVectorEnv
from bootcourse.rule import _track, rule
from bootcourse.scenario import DEFAULT, N_ACTIONS, Scenario

Rule = Callable[[np.ndarray, Scenario], int]  # one road's cars (vehicles, 10) -> an action, 0..8
Teacher = Callable[[np.ndarray], np.ndarray]  # cars (roads, vehicles, 10) -> actions (roads,)


# What a rule is written with -------------------------------------------------------------------------


def ahead(cars: np.ndarray, lane: int, scenario: Scenario = DEFAULT) -> tuple[float, float]:
    """(gap in m, bumper to bumper; speed in m/s) of the next car ahead in a lane; (inf, inf) for none."""
    others = cars[(cars[:, LANE] == lane) & (cars[:, X] > cars[EGO, X])]
    if len(others) == 0:
        return math.inf, math.inf
    first = others[others[:, X].argmin()]
    return float(first[X] - cars[EGO, X] - scenario.car.length), float(first[SPEED])


def toward(cars: np.ndarray, speed: float, lane: int, scenario: Scenario = DEFAULT) -> int:
    """The action that brings the ego nearest to a speed (m/s) and the middle of a lane: the rule's own tracker."""
    if not 0 <= lane < scenario.road.lanes or math.isnan(speed):
        raise BootcourseError(f"speed {speed} m/s in lane {lane}: this road has lanes 0..{scenario.road.lanes - 1}.")
    return int(_track(cars, float(speed), int(lane), constants(scenario)))


# What is made of it ----------------------------------------------------------------------------------


def all_roads(many: Callable[[np.ndarray, Scenario], np.ndarray]):
    """Marks a rule that answers for all roads in one call, (roads, vehicles, 10) -> (roads,): it is faster."""
    many.answers_for_all_roads = True
    return many


@all_roads
def course_rule(cars: np.ndarray, scenario: Scenario) -> np.ndarray:
    """The course's own rule controller, as a teacher like any other."""
    return rule(cars, scenario).actions


def teacher_of(my_rule: Rule, scenario: Scenario = DEFAULT) -> Teacher:
    """The rule on many roads at once. Raises BootcourseError where it gives anything but an action."""

    def teach(cars: np.ndarray) -> np.ndarray:
        if getattr(my_rule, "answers_for_all_roads", False):
            return np.asarray(my_rule(cars, scenario))
        return np.array([whole(my_rule(road.copy(), scenario)) for road in cars], dtype=np.int64)

    return teach


def whole(action) -> int:
    """The action as a Python int. Raises BootcourseError if it is none."""
    is_whole = isinstance(action, (int, np.integer)) and not isinstance(action, (bool, np.bool_))
    if not is_whole or not 0 <= action < N_ACTIONS:
        raise BootcourseError(f"The rule answers {action!r}: an action is a whole number from 0 to {N_ACTIONS - 1}.")
    return int(action)


def teacher_policy(my_rule: Rule, scenario: Scenario = DEFAULT) -> Policy:
    """Drives as the rule says."""
    teacher = teacher_of(my_rule, scenario)
    return lambda observations, cars: PolicyOutput(teacher(cars))


def demonstrations_of(my_rule: Rule, episodes: int = 200, scenario: Scenario = DEFAULT) -> Tensor:
    """Rows for a `ReplayBuffer`, as `bootcourse.learn.demonstrations.collect` makes them of the course's rule."""
    teacher = teacher_of(my_rule, scenario)
    env = TrapVectorEnv(episodes, scenario, AutoresetMode.DISABLED)
    states, _ = env.reset(seed=FIRST_SEED)
    actions, awake, rows = teacher(env.cars), np.ones(episodes, dtype=bool), []
    while awake.any():
        next_states, rewards, terminated, truncated, _ = env.step(actions)
        next_actions = teacher(env.cars)
        rows.append(encode_transitions(states, next_states, actions, rewards, terminated, actions, next_actions)[awake])
        awake &= ~(terminated | truncated)
        states, actions = next_states, next_actions
    return torch.cat(rows)


class TaughtTraining(Training):
    """A `Training` whose demonstrations and whose KL come from your rule instead of the course's.

    Raises BootcourseError for demonstrations that the stochastic rule drives, which only the course's has.
    """

    def __init__(self, settings: Sequence[Settings], my_rule: Rule, episodes: int = 1000, scenario: Scenario = DEFAULT):
        if any(s.stochastic_demonstrations for s in settings):
            raise BootcourseError("stochastic_demonstrations = True: a rule of your own demonstrates its own actions.")
        self.teacher = teacher_of(my_rule, scenario)
        super().__init__(settings, episodes, scenario)
        shared, rows = self.settings[0], None
        if self.replay.demonstrations:
            rows = demonstrations_of(my_rule, shared.demonstration_episodes, scenario)
        self.replay = _Relabelled(self, shared.buffer_size, rows)

    def look(self) -> None:
        super().look()
        self.taught = self.teacher(self.env.cars)

    def relabel(self, rows: Tensor) -> None:
        """Write the teacher's μ(s) and μ(s') over the rule's, in rows (agents, roads, row) of this decision."""
        now = self.teacher(self.env.cars)
        reached, ended = now.copy(), self.env.decisions == 0  # a road that ended has started anew already
        if ended.any():
            reached[ended] = self.teacher(self.env.final_cars[ended])
        rows[..., -2:] = torch.from_numpy(np.stack([self.taught, reached], axis=-1)).view(*rows.shape[:2], 2).float()
        self.taught = now


class _Relabelled(ReplayBuffer):
    """The memory of a `TaughtTraining`: every row is relabelled before it is kept."""

    def __init__(self, training: TaughtTraining, buffer_size: int, rows: Tensor | None):
        super().__init__(training.n_agents, buffer_size, training.scenario.observation_size, rows)
        self.training = training

    def add(self, rows: Tensor) -> None:
        self.training.relabel(rows)
        super().add(rows)
