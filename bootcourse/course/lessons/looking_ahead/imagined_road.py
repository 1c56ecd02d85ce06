"""The look-ahead in the form in which the lesson writes it: what its exercise is given, and a driver that uses it."""

from collections.abc import Callable, Sequence

import numpy as np

from bootcourse.episodes.lookahead import HORIZON, nine_drives, worth_of_speed
from bootcourse.episodes.models import Model
from bootcourse.episodes.record import Rollout
from bootcourse.policies import Policy, PolicyOutput
from bootcourse.road.branching import advance
from bootcourse.road.constants import constants
from bootcourse.road.observation import observe_all
from bootcourse.scenario import DEFAULT

Decide = Callable[[np.ndarray], np.ndarray]  # cars (roads, vehicles, 10) -> actions (roads,)
NOISE = Model(noise=1.0)  # the others' places off by 1 m, their speeds by 0.5 m/s


def step(cars: np.ndarray, actions: np.ndarray) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """One imagined decision: cars (roads, vehicles, 10), actions (roads,) -> next cars, rewards, crashed.

    rewards (roads,); crashed (roads,) bool: this decision ended in an accident. The cars that are given stay as they
    are. It does not remember: a road that is stepped on after an accident may go on to earn rewards. Raises
    BootcourseError for what are not whole actions in 0..8, one for each road.
    """
    following, accidents = cars.copy(), np.zeros(len(cars), dtype=np.int64)
    rewards = advance(following, actions, accidents, DEFAULT)
    return following, rewards, accidents != 0


def worth(speeds: np.ndarray) -> np.ndarray:
    """The return of an episode on an empty road that begins at these speeds (m/s), any shape."""
    return np.interp(speeds, *worth_of_speed(DEFAULT))


def decide_by(policy: Policy) -> Decide:
    """A policy without a state of its own as a function of the cars alone: it sees what they show."""

    def decide(cars: np.ndarray) -> np.ndarray:
        observations = np.zeros((len(cars), DEFAULT.observation_size), dtype=np.float32)
        observe_all(np.ascontiguousarray(cars), constants(DEFAULT), observations)
        return policy(observations, cars).actions

    return decide


def driver(
    values_of: Callable, policy: Policy, horizon: int, gamma: float = 1.0, after: Callable | None = None
) -> Policy:
    """A policy that takes the best of nine values at each decision: values_of(cars, policy, horizon, gamma, worth).

    after: what comes after the horizon is worth, (speeds) -> values; `worth` if None.
    """
    decide, after = decide_by(policy), after or worth

    def drive(observations: np.ndarray, cars: np.ndarray) -> PolicyOutput:
        values = values_of(cars, decide, horizon, gamma, after)
        return PolicyOutput(values.argmax(axis=1), q_values=values)

    return drive


def shielded(shield: Callable, policy: Policy, horizon: int) -> Policy:
    """A policy under a shield: shield(actions, values, accidents) -> actions, each of the roads' nine drives."""

    def drive(observations: np.ndarray, cars: np.ndarray) -> PolicyOutput:
        imagined = nine_drives(cars, policy, DEFAULT, horizon)
        actions = policy(observations, cars).actions
        return PolicyOutput(np.asarray(shield(actions, imagined.values, imagined.accidents != 0)))

    return drive


def flattered(drives: Sequence[Rollout], policy: Policy) -> tuple[float, float]:
    """By how much noise changes the value of an action along some drives: the mean of all nine, and of the best one.

    The best of nine is that in noise. The noise is drawn anew at each decision.
    """
    rng, changed, best = np.random.default_rng(1), [], []
    for drive in drives:
        cars = drive.cars[: len(drive.actions)]
        true = nine_drives(cars, policy, DEFAULT).values
        noisy = nine_drives(NOISE.seen(cars, None, DEFAULT, rng), policy, DEFAULT).values
        changed.append((noisy - true).ravel())
        best.append((noisy - true)[np.arange(len(cars)), noisy.argmax(axis=1)])
    return float(np.concatenate(changed).mean()), float(np.concatenate(best).mean())


def in_noise(values_of: Callable, policy: Policy, roads: int = 1) -> Policy:
    """A look-ahead that sees the other cars a little off, by `NOISE`, drawn anew at each decision.

    It imagines its futures on so many noisy roads and goes by the mean of their values.
    """
    decide, rng = decide_by(policy), np.random.default_rng(0)

    def drive(observations: np.ndarray, cars: np.ndarray) -> PolicyOutput:
        noisy = [NOISE.seen(cars, None, DEFAULT, rng) for _ in range(roads)]
        values = np.mean([values_of(each, decide, HORIZON, 1.0, worth) for each in noisy], axis=0)
        return PolicyOutput(values.argmax(axis=1), q_values=values)

    return drive
