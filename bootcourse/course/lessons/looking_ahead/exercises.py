"""Exercises of the lesson on looking ahead: the value of each action by rollouts, and the shield."""

import numpy as np

from bootcourse.course.exercise import MANY_ROWS, exercise
from bootcourse.course.lessons.looking_ahead import imagined_road
from bootcourse.road.state import EGO, LANE, SPEED, TRAP_1, TRAP_2, X, Y
from bootcourse.road.vector_env import TrapVectorEnv
from bootcourse.rule import rule
from bootcourse.scenario import ACTION_NAMES, DEFAULT, IDLE

FAST = ACTION_NAMES.index("accelerate straight")


def keep(cars):
    """Keeps straight."""
    return np.full(len(cars), IDLE)


def accelerate(cars):
    """Accelerates, whoever is ahead."""
    return np.full(len(cars), FAST)


def by_lane(cars):
    """Brakes in the rightmost lane, keeps its speed in the others: it has to be asked again at each decision."""
    return np.where(cars[:, EGO, LANE] == DEFAULT.road.lanes - 1, 1, IDLE)


def by_rule(cars):
    """The rule."""
    return rule(cars, DEFAULT).actions


def nothing(speeds):
    """Nothing, at each speed."""
    return np.zeros_like(speeds)


def reached(roads: int, decisions: int, action: int, seed: int) -> np.ndarray:
    """The cars of some roads after some decisions of the same action, (roads, vehicles, 10)."""
    env = TrapVectorEnv(roads)
    env.reset(seed=seed)
    for _ in range(decisions):
        env.step(np.full(roads, action))
    return env.cars.copy()


def blocked() -> np.ndarray:
    """One road on which the ego touches both cars ahead at the next step, whatever it does."""
    cars = reached(1, 0, IDLE, 1)
    cars[0, TRAP_1, X], cars[0, TRAP_1, SPEED] = cars[0, EGO, X] + 5.0, 1.0
    cars[0, TRAP_2, [X, Y]] = cars[0, TRAP_1, [X, Y]]
    return cars


def cases(rng):
    """One decision; accidents for some actions; a policy that must be asked again; discounted, or without W.

    Then 16 at random; at last eight roads on which drives end early, late, and not at all within 20 decisions, also of
    one action.
    """
    worth = imagined_road.worth
    yield reached(2, 0, IDLE, 3), keep, 1, 1.0, worth
    yield reached(2, 4, FAST, 5), keep, 4, 1.0, worth
    yield reached(2, 3, FAST, 7), accelerate, 6, 1.0, worth
    yield reached(3, 3, FAST, 7), by_rule, 4, 1.0, nothing
    yield reached(3, 3, FAST, 7), by_rule, 4, 0.8, nothing
    yield reached(3, 2, IDLE, 9), by_lane, 5, 0.8, worth
    yield reached(2, 0, IDLE, 11), by_rule, 10, 1.0, worth
    for seed in range(16):
        policy = (keep, accelerate, by_lane, by_rule)[rng.integers(4)]
        cars, horizon = reached(2, int(rng.integers(5)), FAST, 20 + 2 * seed), int(rng.integers(1, 9))
        yield cars, policy, horizon, float(rng.choice([1.0, 0.9])), worth
    cars = reached(8, 1, IDLE, 60)
    cars[4:, EGO + 1 :, X] += 500.0  # m: nobody is near
    yield cars, keep, 20, 1.0, worth


@exercise(
    "Q(s, a): the return of doing a and then following the policy, over the horizon (Tesauro & Galperin 1996)",
    minutes=18, difficulty=3, cases=cases,
    # every action touches the car ahead within the first decision: -10, and nothing follows
    worked=[((blocked(), keep, 3, 1.0, imagined_road.worth), np.full((1, 9), DEFAULT.reward.accident))],
    mistakes={
        "range(horizon) -> range(horizon + 1)":
            "You imagine one decision too many: the horizon counts the first decision, too.",
        "values += alive * gamma**decision * rewards -> values += gamma**decision * rewards":
            "Your imagined car earns after its accident. An accident ends the episode: nothing is added from there on.",
        "gamma**decision * rewards -> rewards":
            "Your rewards are not discounted: the reward of decision k counts γ to the power of k.",
        "gamma**decision * rewards -> gamma ** (decision + 1) * rewards":
            "You discount the first reward, too: the decisions count from 0.",
        "alive * gamma**horizon * worth(imagined[:, 0, 3]) -> gamma**horizon * worth(imagined[:, 0, 3])":
            "A drive that ended in an accident has no future: add the worth of the last speed only where the car is "
            "still driving.",
        "gamma**horizon * worth -> worth":
            "The worth of the last speed comes after the horizon: it counts γ to the power of h.",
        "values += alive * gamma**horizon * worth(imagined[:, 0, 3]) ->":
            "What comes after the horizon is missing. A drive that ends slowly is then worth as much as one that ends "
            "fast.",
        "first if decision == 0 else policy(imagined) -> policy(imagined)":
            "All nine drives begin with the policy's own action, so the nine values are equal. The first decision is "
            "the action that is judged.",
        "first if decision == 0 else policy(imagined) -> first":
            "You hold the action for the whole drive. Only the first decision is given; after it the policy decides.",
        "policy(imagined) -> policy(cars).repeat(9)":
            "You ask the policy about the road as it is now. Ask it about the imagined road, again at each decision.",
        "values.reshape(-1, 9) -> values.reshape(9, -1).T":
            "The values of different roads are mixed up. `cars.repeat(9, axis=0)` keeps the nine copies of a road "
            "together.",
        "return values.reshape(-1, 9) - values.reshape(-1, 9).max(axis=1, keepdims=True)":
            "You subtract the best value. Return the values themselves: others compare them with returns.",
    },
    hints=(
        "Copy each road nine times with `cars.repeat(9, axis=0)`: the first actions are then 0 to 8 for each road, "
        "`np.tile(np.arange(9), len(cars))`. One loop over the decisions is left.",
        "Keep `alive`, one bool for each copy: a reward counts where the copy was alive before the decision. After the "
        "last decision `worth(imagined[:, 0, 3])` counts in the same way. At last `values.reshape(-1, 9)`.",
    ),
)  # fmt: skip
def rollout_values(cars, policy, horizon, gamma, worth):
    first, imagined = np.tile(np.arange(9), len(cars)), cars.repeat(9, axis=0)
    values, alive = np.zeros(len(first)), np.ones(len(first), dtype=bool)
    for decision in range(horizon):
        actions = first if decision == 0 else policy(imagined)
        imagined, rewards, crashed = imagined_road.step(imagined, actions)
        values += alive * gamma**decision * rewards
        alive &= ~crashed
    values += alive * gamma**horizon * worth(imagined[:, 0, 3])
    return values.reshape(-1, 9)


NINE_VALUES = np.array([[5.0, -3.0, 7.0, 1.0, 0.0, 2.0, -1.0, 4.0, 3.0]])
SECOND_CRASHES = np.array([[False, True] + [False] * 4 + [True] + [False] * 2])


def shield_cases(rng):
    """The base's action safe, or not, or all nine not; several roads; the best one is the base's; then 30 at random.

    At last 130 roads with values in the thousands, the best of them often that of a drive with an accident.
    """
    everywhere = np.ones((1, 9), dtype=bool)
    yield np.array([6]), NINE_VALUES, SECOND_CRASHES
    yield np.array([2]), NINE_VALUES, SECOND_CRASHES
    yield np.array([1]), NINE_VALUES - 20, everywhere
    yield np.array([2]), NINE_VALUES - 20, everywhere
    yield np.array([1, 0, 1]), np.tile(NINE_VALUES, (3, 1)), np.tile(SECOND_CRASHES, (3, 1))
    for _ in range(30):
        roads = int(rng.integers(1, 7))
        accidents = rng.random((roads, 9)) < rng.choice([0.1, 0.5, 0.9])
        values = np.where(accidents, rng.uniform(-10, 10, (roads, 9)), rng.uniform(100, 160, (roads, 9)))
        yield rng.integers(0, 9, roads), values, accidents
    yield rng.integers(0, 9, MANY_ROWS), rng.normal(0, 3000, (MANY_ROWS, 9)), rng.random((MANY_ROWS, 9)) < 0.5


@exercise(
    "the base policy's action, unless its imagined drive ends in an accident: then the best of the nine",
    minutes=8, difficulty=2, cases=shield_cases,
    worked=[
        ((np.array([0]), NINE_VALUES, SECOND_CRASHES), np.array([0])),  # safe: it stays, although 2 is worth more
        ((np.array([1]), NINE_VALUES, SECOND_CRASHES), np.array([2])),  # 1 ends in an accident: the best is 2
    ],
    hints=(
        "First, for each road, one question: does the drive of the base's own action end in an accident?",
        "`accidents[np.arange(len(actions)), actions]` answers it, and `np.where` chooses between two actions.",
    ),
    mistakes={
        "np.where(danger, values.argmax(axis=1), actions) -> values.argmax(axis=1)":
            "You take the best action everywhere: this is the look-ahead. The shield keeps the base's action "
            "where its drive ends well.",
        "accidents[np.arange(len(actions)), actions] -> accidents.any(axis=1)":
            "You overrule the base wherever *any* of the nine drives ends in an accident. Only the drive of its own "
            "action counts.",
        "accidents[np.arange(len(actions)), actions] -> accidents.all(axis=1)":
            "You overrule the base only where all nine drives end in an accident: look at the drive of its own action.",
        "np.where(danger, values.argmax(axis=1), actions) -> np.where(danger, actions, values.argmax(axis=1))":
            "The two are exchanged: you keep the base's action where it ends in an accident.",
        "values.argmax(axis=1) -> accidents.argmin(axis=1)":
            "You take the first action without an accident. Take the best of the nine by their values.",
        "values.argmax(axis=1) -> values.max(axis=1)":
            "This is the best *value*. Return an action, 0 to 8, for each road.",
    },
)  # fmt: skip
def shield(actions, values, accidents):
    danger = accidents[np.arange(len(actions)), actions]
    return np.where(danger, values.argmax(axis=1), actions)
