"""The teacher, whose actions the KL and the demonstrations use: the course's rule controller or your own rule.

    def my_rule(cars, scenario):  # cars (vehicles, 10): one road, columns in bootcourse.road.state
        gap, speed = ahead(cars, 2, scenario)
        return toward(cars, speed - 1, 2, scenario)

    record(teacher_policy(my_rule), [7])  # drive with it
    Training(settings, teacher=my_rule).run()  # train with it

A rule is a deterministic function of a road's true state that returns one of the nine actions. Off the trap
it is a function of one observation, `my_rule(observation)`, that returns one of that environment's actions.
"""

import hashlib
import inspect
import math
import operator
from collections.abc import Callable
from dataclasses import dataclass

import numpy as np

from bootcourse.errors import BootcourseError, RuleFailed, described
from bootcourse.policies import Policy, policy_of
from bootcourse.road.constants import constants
from bootcourse.road.state import EGO, LANE, SPEED, X, Y
from bootcourse.rule import rule, track
from bootcourse.scenario import DEFAULT, N_ACTIONS, Scenario

Rule = Callable[..., int]  # one road's cars (vehicles, 10) and the scenario -> an action, 0..8
Teacher = Callable[[np.ndarray], np.ndarray]  # cars (roads, vehicles, 10) -> actions (roads,)
ALL = "in a call for all roads"  # where such a rule failed


def ahead(cars: np.ndarray, lane: int, scenario: Scenario = DEFAULT) -> tuple[float, float]:
    """(gap in m, bumper to bumper; speed in m/s) of the next car ahead in a lane; (inf, inf) for no car."""
    others = cars[(cars[:, LANE] == lane) & (cars[:, X] > cars[EGO, X])]
    if len(others) == 0:
        return math.inf, math.inf
    first = others[others[:, X].argmin()]
    return float(first[X] - cars[EGO, X] - scenario.car.length), float(first[SPEED])


def toward(cars: np.ndarray, speed: float, lane: int, scenario: Scenario = DEFAULT) -> int:
    """The action (0..8) that brings the ego nearest to a speed (m/s) and a lane's centre, by the rule's tracker.

    Raises BootcourseError for a lane outside the road, or a speed that is NaN.
    """
    if not 0 <= lane < scenario.road.lanes or math.isnan(speed):
        raise BootcourseError(f"speed {speed} m/s in lane {lane}: this road has lanes 0..{scenario.road.lanes - 1}.")
    return int(track(cars, float(speed), int(lane), constants(scenario)))


def all_roads(many: Callable[[np.ndarray, Scenario], np.ndarray]):
    """Mark a rule that computes the actions of all roads in one call, (roads, vehicles, 10) -> (roads,)."""
    many.answers_for_all_roads = True
    return many


def slow(my_rule: Rule) -> Rule:
    """Mark a rule that takes milliseconds: a training asks it only if its method uses the answers (`asks_teacher`)."""
    my_rule.is_slow = True
    return my_rule


@all_roads
def course_rule(cars: np.ndarray, scenario: Scenario) -> np.ndarray:
    """The course's rule controller μ (Algorithm 1) as a teacher: the default."""
    return rule(cars, scenario).actions


def teacher_of(my_rule: Rule, scenario: Scenario | None = DEFAULT, n_actions: int = N_ACTIONS) -> Teacher:
    """The rule as a function of many roads; with scenario = None, of many observations.

    It raises RuleFailed, a BootcourseError, if your rule raises an exception or returns no action.
    """
    if not callable(my_rule):
        raise BootcourseError(f"teacher = {my_rule!r:.80}: give a function that returns an action.")
    asked = _Asked(my_rule, scenario, n_actions)
    return asked.about_all if getattr(my_rule, "answers_for_all_roads", False) else asked.about_each


@dataclass(frozen=True)
class _Asked:
    """A rule, and where it is asked."""

    rule: Rule
    scenario: Scenario | None
    n_actions: int

    def about_all(self, cars: np.ndarray) -> np.ndarray:
        actions = np.asarray(self._ask(cars, ALL))
        if actions.shape != (len(cars),) or actions.dtype.kind not in "iu":
            answered = f"actions of shape {actions.shape} and type {actions.dtype}"
            raise self._failed(f"returned {answered}, but {len(cars)} roads need a whole number each", cars, ALL)
        for road in np.flatnonzero((actions < 0) | (actions >= self.n_actions))[:1]:
            raise self._failed(f"returned {actions[road]}, but {self._an_action_is}", cars[road])
        return actions

    def about_each(self, cars: np.ndarray) -> np.ndarray:
        actions = np.empty(len(cars), dtype=np.int64)
        for road, state in enumerate(cars):
            action = self._ask(state.copy())  # your rule may write into it
            if not is_action(action, self.n_actions):
                remedy = ": give int(...) of it" if isinstance(action, (bool, np.bool_, np.ndarray)) else ""
                raise self._failed(f"returned {action!r:.80}, but {self._an_action_is}{remedy}", state)
            actions[road] = action
        return actions

    def _ask(self, state: np.ndarray, where: str = ""):
        try:
            return self.rule(state) if self.scenario is None else self.rule(state, self.scenario)
        except (Exception, SystemExit) as error:  # your rule may raise anything
            if str(getattr(self.rule, "__module__", "")).startswith("bootcourse."):  # ours: it is a bug, and passes
                raise
            raise self._failed(f"raised {described(error)}", state, where) from error

    def _failed(self, how: str, state: np.ndarray, where: str = "") -> RuleFailed:
        name = getattr(self.rule, "__name__", type(self.rule).__name__)
        return RuleFailed(name, how, where or _place(state, self.scenario), state)

    @property
    def _an_action_is(self) -> str:
        return f"an action is a whole number from 0 to {self.n_actions - 1}"


def _place(state: np.ndarray, scenario: Scenario | None) -> str:
    """The state of one road in which a rule failed, in words."""
    if scenario is None:
        return f"for the observation {np.array2string(state, precision=3)}"
    return f"with the ego at x = {state[EGO, X]:.1f} m, y = {state[EGO, Y]:.1f} m, {state[EGO, SPEED]:.1f} m/s"


def is_action(action, n_actions: int = N_ACTIONS) -> bool:
    """Whether it is one whole number in 0..n_actions - 1: Python's, or a 0-dimensional array of NumPy's or torch's."""
    if isinstance(action, (bool, np.bool_)) or not hasattr(action, "__index__") or np.ndim(action) > 0:
        return False
    try:
        return 0 <= operator.index(action) < n_actions
    except TypeError:  # an array of other numbers
        return False


def teacher_policy(my_rule: Rule, scenario: Scenario | None = DEFAULT, n_actions: int = N_ACTIONS) -> Policy:
    """The rule as a policy; scenario: None off the trap. The policy raises RuleFailed as `teacher_of` says."""
    return policy_of(teacher_of(my_rule, scenario, n_actions))


def teacher_name(my_rule: Rule) -> str:
    """The teacher's name in a run's files: the function's name and a hash of its source.

    "rule" for the course's, "none" for None.
    """
    if my_rule is None:
        return "none"
    if my_rule is course_rule:
        return "rule"
    name = getattr(my_rule, "__qualname__", type(my_rule).__name__)
    try:
        source = inspect.getsource(my_rule).encode()
    except (OSError, TypeError):  # without a source file, or not a function
        source = getattr(getattr(my_rule, "__code__", None), "co_code", b"")
    return f"{name} {hashlib.sha256(source).hexdigest()[:12]}"
