"""Look-ahead by rollouts: any policy, improved at each decision by imagining where its actions lead.

For each of the nine actions: do it, follow the base policy for the rest of the horizon on the compiled road, and add
the worth of an empty road at the last speed. The best of the nine is the decision. This is one step of policy
improvement, computed where the car is (Tesauro & Galperin 1996, "On-line policy improvement using Monte-Carlo
search"; Bertsekas 2020, "Rollout, Policy Iteration, and Distributed Reinforcement Learning"). Nothing is trained.

It knows the true state and, with the exact model, how the other cars will drive: see `models.py` for models that
do not.
"""

import copy
from collections.abc import Sequence
from functools import lru_cache
from typing import NamedTuple

import numpy as np

from bootcourse.episodes.models import EXACT, Model
from bootcourse.errors import BootcourseError, whole
from bootcourse.policies import Policy, PolicyOutput, check_policy
from bootcourse.road.branching import advance, future_worth
from bootcourse.road.constants import constants
from bootcourse.road.observation import observe_all
from bootcourse.road.state import EGO, SPEED, X, Y
from bootcourse.scenario import DEFAULT, N_ACTIONS, Scenario

HORIZON = 10  # decisions of an imagined drive, the first included
NINE = np.arange(N_ACTIONS)


class Imagined(NamedTuple):
    """Imagined drives, one for each first action; `branches` of them on each road."""

    values: np.ndarray  # (roads, branches) the return of the drive and the worth of what follows: Q of the first action
    accidents: np.ndarray  # (roads, branches) int, an Accident's number
    paths: np.ndarray  # (roads, branches, horizon + 1, 2) m, the ego's x and y; after an accident the last again


def imagine(
    cars: np.ndarray,
    first: np.ndarray,
    policy: Policy,
    horizon: int = HORIZON,
    scenario: Scenario = DEFAULT,
    gamma: float = 1.0,
    with_worth: bool = True,
) -> Imagined:
    """On each road, from each of some first actions: follow the policy for the rest of the horizon.

    A drive is worth its rewards, discounted by gamma, and `worth_of_speed` at its end, unless that is left out.

    cars (roads, vehicles, 10), which stay as they are; first (roads, branches) in 0..8. A policy that draws its
    actions is followed along one drawn drive for each first action. A policy with a state of its own (with a method
    `reset`) is copied for each branch, in the state that it has after its decision on these cars.
    """
    branches = first.shape[1]
    states, actions = cars.repeat(branches, axis=0), first.ravel()
    observations = np.zeros((len(states), scenario.observation_size), dtype=np.float32)
    follow = _in_branches(policy, branches)
    values, accidents = np.zeros(len(states)), np.zeros(len(states), dtype=np.int64)
    places = [states[:, EGO, X : Y + 1].copy()]
    for decision in range(horizon):
        if decision > 0:
            observe_all(states, constants(scenario), observations)
            actions = follow(observations, states).actions
        values += gamma**decision * advance(states, actions, accidents, scenario)
        places.append(states[:, EGO, X : Y + 1].copy())
    if with_worth:
        later = np.interp(states[:, EGO, SPEED], *worth_of_speed(scenario))
        values += gamma**horizon * np.where(accidents == 0, later, 0.0)
    paths = np.stack(places, axis=1).reshape(len(cars), branches, horizon + 1, 2)
    return Imagined(values.reshape(-1, branches), accidents.reshape(-1, branches), paths)


def rollout_values(
    cars: np.ndarray, policy: Policy, horizon: int = HORIZON, scenario: Scenario = DEFAULT
) -> np.ndarray:
    """The value of each of the nine actions, (roads, 9): the return of doing it and then following the policy."""
    return nine_drives(cars, policy, scenario, horizon).values


def nine_drives(cars: np.ndarray, policy: Policy, scenario: Scenario = DEFAULT, horizon: int = HORIZON) -> Imagined:
    """The nine imagined drives on each road, (roads, 9, ...): `imagine` from each of the nine actions.

    cars (roads, vehicles, 10), such as `Rollout.cars` before each of its decisions: then a road is a decision.
    """
    return imagine(cars, np.tile(NINE, (len(cars), 1)), policy, horizon, scenario)


@lru_cache(maxsize=64)
def worth_of_speed(scenario: Scenario) -> tuple[np.ndarray, np.ndarray]:
    """(speeds, return of an episode's length on an empty road), to interpolate in: what follows an imagined drive.

    A drive without an accident is so worth more than any that ends in one, whenever that is.
    """
    return future_worth(scenario, scenario.clock.decisions, 1.0)[-1]


def _in_branches(policy: Policy, branches: int) -> Policy:
    """The policy for imagined roads, each of whose branches has its own copy of the policy's state."""
    if not hasattr(policy, "reset"):
        return policy
    copies = [copy.deepcopy(policy) for _ in range(branches)]

    def follow(observations: np.ndarray, cars: np.ndarray) -> PolicyOutput:
        each = [one(observations[i::branches], cars[i::branches].copy()).actions for i, one in enumerate(copies)]
        return PolicyOutput(np.stack(each, axis=1).ravel())

    return follow


class LookAhead:
    """Any policy with rollouts: at each decision the action whose imagined drive is worth most.

    policy: an agent's, a rule's, a plan, your own. horizon: decisions of an imagined drive, the first included.
    scenario: of the roads that it drives. models: what it imagines; of several, the worst case counts. seed: of what
    the models draw. gamma and with_worth: see `imagine`. Of equal values the first action is taken. About 0.15 ms for
    each decision on a free core.

    Its output has the base policy's π, and the nine values as Q. Of the last decision, for pictures and counts:
    `imagined`, the nine imagined drives on each road, and `overruled` (roads,) bool, whether the action is not the
    base policy's. Raises BootcourseError for what is no policy, for a horizon outside 1..1000, and without a model.
    """

    def __init__(
        self,
        policy: Policy,
        horizon: int = HORIZON,
        scenario: Scenario = DEFAULT,
        models: Sequence[Model] = (EXACT,),
        seed: int = 0,
        gamma: float = 1.0,
        with_worth: bool = True,
    ):
        self.policy, self.scenario, self.counted = check_policy(policy), scenario, (gamma, with_worth)
        self.horizon = whole(horizon, "horizon", 1000, low=1)
        self.models, self.seed = tuple(models), whole(seed, "seed")
        if not self.models:
            raise BootcourseError("models is empty: give at least one model, such as models=(EXACT,).")
        self._begin()

    def _begin(self) -> None:
        self.rng = np.random.default_rng(self.seed)
        self.earlier: np.ndarray | None = None
        self.imagined: Imagined | None = None
        self.overruled = np.zeros(0, dtype=bool)
        self.believed = [model.scenarios(self.scenario, self.rng) for model in self.models]

    def reset(self, roads: int) -> None:
        """Begin new episodes; what the models draw is drawn again from the seed."""
        self._begin()
        if hasattr(self.policy, "reset"):
            self.policy.reset(roads)

    def __call__(self, observations: np.ndarray, cars: np.ndarray) -> PolicyOutput:
        base, views = self.policy(observations, cars), self._views(cars)
        self.imagined = self._imagine(views, np.tile(NINE, (len(cars), 1)), np.arange(len(cars)))
        actions = self.imagined.values.argmax(axis=1)
        self.overruled = actions != base.actions
        return PolicyOutput(actions, base.policy, self.imagined.values)

    def _views(self, cars: np.ndarray) -> list[np.ndarray]:
        """The state from which each model imagines. Raises BootcourseError for the cars of another scenario."""
        if cars.shape[1] != self.scenario.vehicles:
            raise BootcourseError(
                f"There are {cars.shape[1]} cars on this road, and {self.scenario.vehicles} in the scenario "
                f"'{self.scenario.name}': give the look-ahead the scenario that it drives."
            )
        earlier, self.earlier = self.earlier, cars.copy()
        return [model.seen(cars, earlier, self.scenario, self.rng) for model in self.models]

    def _imagine(self, views: list[np.ndarray], first: np.ndarray, rows: np.ndarray) -> Imagined:
        """Imagined drives on some roads (rows,): of several models the worst case, and the paths of the first."""
        each = [self._in_model(*model, first, rows) for model in zip(self.believed, views, strict=True)]
        worst = np.min([one.values for one in each], axis=0), np.max([one.accidents for one in each], axis=0)
        return Imagined(*worst, each[0].paths)

    def _in_model(self, kinds: list[Scenario], cars, first, rows) -> Imagined:
        """Imagined drives in one model; where it has several kinds of drivers, road i is imagined with kind i % n."""
        if len(kinds) > 1 and hasattr(self.policy, "reset"):
            raise BootcourseError("A policy with a state of its own cannot be imagined with several kinds of drivers.")
        groups = [rows[rows % len(kinds) == kind] for kind in range(len(kinds))]
        parts = [
            imagine(cars[group], first[group], self.policy, self.horizon, scenario, *self.counted)
            for group, scenario in zip(groups, kinds, strict=True)
            if len(group)
        ]
        order = np.concatenate(groups).argsort()
        return Imagined(*(np.concatenate(columns)[order] for columns in zip(*parts, strict=True)))


class Shield(LookAhead):
    """A base policy that is overruled only where its own action is imagined to end in an accident.

    The best of the nine actions then replaces it. `imagined` holds the drive of the base's action on each road.
    """

    def __call__(self, observations: np.ndarray, cars: np.ndarray) -> PolicyOutput:
        base, views, rows = self.policy(observations, cars), self._views(cars), np.arange(len(cars))
        self.imagined = self._imagine(views, base.actions[:, None], rows)
        danger = self.imagined.accidents[:, 0] != 0
        self.overruled = np.zeros(len(cars), dtype=bool)
        if not danger.any():
            return base
        if not hasattr(self.policy, "reset"):  # a policy with a state of its own is asked about all roads at once
            rows = rows[danger]
        values = self._imagine(views, np.tile(NINE, (len(cars), 1)), rows).values
        actions = base.actions.copy()
        actions[danger] = values.argmax(axis=1)[danger[rows]]
        self.overruled = actions != base.actions
        return base._replace(actions=actions)


lookahead, lookahead_shield = LookAhead, Shield
