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
import sys
from collections.abc import Callable
from dataclasses import dataclass, replace
from typing import Any

import numpy as np

from bootcourse.episodes.place import Place
from bootcourse.errors import BootcourseError, RuleFailed, described
from bootcourse.policies import Policy, policy_of
from bootcourse.road.constants import constants
from bootcourse.road.state import EGO, LANE, SPEED, X
from bootcourse.rule import rule, track
from bootcourse.scenario import DEFAULT, N_ACTIONS, Scenario

Rule = Callable[..., Any]  # one road's cars (vehicles, 10) and the scenario -> an action, 0..8
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


@dataclass(frozen=True)
class MarkedRule:
    """A rule, and what those who ask it must know. It is called as the rule itself."""

    rule: Rule
    answers_all_roads: bool = False  # in one call: (roads, vehicles, 10) -> (roads,)
    is_slow: bool = False  # takes milliseconds: a training asks only if its method uses the answers (`asks_teacher`)
    name: str = ""  # in the files of a run; "" for the function's

    def __post_init__(self):
        object.__setattr__(self, "__wrapped__", self.rule)  # `inspect` reads its source and its arguments there
        object.__setattr__(self, "__name__", getattr(self.rule, "__name__", type(self.rule).__name__))
        object.__setattr__(self, "__module__", getattr(self.rule, "__module__", type(self).__module__))

    def __call__(self, *state):
        return self.rule(*state)

    def __reduce__(self):
        """A rule that a module holds under its own name is copied and pickled as that name, as functions are."""
        if getattr(sys.modules.get(self.__module__), self.__name__, None) is self:
            return self.__name__
        return MarkedRule, (self.rule, self.answers_all_roads, self.is_slow, self.name)


def marked(rule: Rule) -> MarkedRule:
    """The rule with its marks: it answers for one road and at once, if nobody said otherwise."""
    return rule if isinstance(rule, MarkedRule) else MarkedRule(rule)


def all_roads(rule: Rule) -> MarkedRule:
    """Mark a rule that computes the actions of all roads in one call, (roads, vehicles, 10) -> (roads,)."""
    return replace(marked(rule), answers_all_roads=True)


def slow(rule: Rule) -> MarkedRule:
    """Mark a rule that takes milliseconds: a training asks it only if its method uses the answers (`asks_teacher`)."""
    return replace(marked(rule), is_slow=True)


def with_name(rule: Rule, name: str) -> MarkedRule:
    """The rule under another name in the files of a run, where one function makes several rules."""
    return replace(marked(rule), name=name)


@all_roads
def course_rule(cars: np.ndarray, scenario: Scenario) -> np.ndarray:
    """The course's rule controller μ (Algorithm 1) as a teacher: the default."""
    return rule(cars, scenario).actions


def default_teacher(place: Place) -> Rule | None:
    """Who teaches where no teacher is given: the course's rule on the trap, elsewhere nobody."""
    return course_rule if place.is_trap else None


def teacher_of(my_rule: Rule, scenario: Scenario | None = DEFAULT, n_actions: int = N_ACTIONS) -> Teacher:
    """The rule as a function of many roads; with scenario = None, of many observations.

    It raises RuleFailed, a BootcourseError, if your rule raises an exception or returns no action.
    """
    if not callable(my_rule):
        raise BootcourseError(f"teacher = {my_rule!r:.80}: give a function that returns an action.")
    questions = _Questions(marked(my_rule), Place(scenario), n_actions)
    return questions.for_all if questions.rule.answers_all_roads else questions.for_each


@dataclass(frozen=True)
class _Questions:
    """Questions to a rule, and checks of its answers."""

    rule: MarkedRule
    place: Place
    n_actions: int

    def for_all(self, cars: np.ndarray) -> np.ndarray:
        """The actions on all roads, (roads, vehicles, 10) -> (roads,), in one call."""
        actions = np.asarray(self._ask(cars, ALL))
        if actions.shape != (len(cars),) or actions.dtype.kind not in "iu":
            answered = f"actions of shape {actions.shape} and type {actions.dtype}"
            raise self._failed(f"returned {answered}, but {len(cars)} roads need a whole number each", cars, ALL)
        for road in np.flatnonzero((actions < 0) | (actions >= self.n_actions))[:1]:
            raise self._failed(f"returned {actions[road]}, but {self._an_action_is}", cars[road])
        return actions

    def for_each(self, cars: np.ndarray) -> np.ndarray:
        """The same, in a call for each road."""
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
            return self.rule(state, *self.place.told)
        except (Exception, SystemExit) as error:  # your rule may raise anything
            if str(getattr(self.rule.rule, "__module__", "")).startswith("bootcourse."):
                raise  # an error in ours is a bug: it passes
            raise self._failed(f"raised {described(error)}", state, where) from error

    def _failed(self, how: str, state: np.ndarray, where: str = "") -> RuleFailed:
        name: str = self.rule.__name__  # type: ignore[attr-defined]
        return RuleFailed(name, how, where or self.place.in_words(state), state)

    @property
    def _an_action_is(self) -> str:
        return f"an action is a whole number from 0 to {self.n_actions - 1}"


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
    one = marked(my_rule)
    name = one.name or getattr(one.rule, "__qualname__", type(one.rule).__name__)
    try:
        source = inspect.getsource(one.rule).encode()
    except (OSError, TypeError):  # without a source file, or not a function
        source = getattr(getattr(one.rule, "__code__", None), "co_code", b"")
    return f"{name} {hashlib.sha256(source).hexdigest()[:12]}"
