"""The exercise of the lesson on looking ahead: the value of each action by rollouts."""

import numpy as np

from bootcourse.course.exercise import Exercise, Mistake
from bootcourse.course.lessons.looking_ahead import imagined_road
from bootcourse.course.lessons.looking_ahead.imagined_road import step, worth
from bootcourse.policies import rule_policy
from bootcourse.road.state import EGO, LANE, SPEED, TRAP_1, TRAP_2, X, Y
from bootcourse.road.vector_env import TrapVectorEnv
from bootcourse.scenario import ACTION_NAMES, DEFAULT, IDLE, N_ACTIONS

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


by_rule = imagined_road.decide_by(rule_policy(DEFAULT))


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
    """One decision; accidents for some actions; a policy that must be asked again; then 8 at random."""
    yield reached(2, 0, IDLE, 3), keep, 1
    yield reached(2, 4, FAST, 5), keep, 4
    yield reached(2, 3, FAST, 7), accelerate, 6
    yield reached(3, 2, IDLE, 9), by_lane, 5
    yield reached(2, 0, IDLE, 11), by_rule, 10
    for seed in range(8):
        policy = (keep, accelerate, by_lane, by_rule)[rng.integers(4)]
        yield reached(2, int(rng.integers(5)), FAST, 20 + 2 * seed), policy, int(rng.integers(1, 9))


def rollouts(
    asked=lambda decision, action, policy, start, imagined: (
        np.full(len(start), action) if decision == 0 else policy(imagined)
    ),
    pay=lambda alive, rewards: alive * rewards,
    rest=lambda alive, speeds: alive * worth(speeds),
    more=0,
    combine=lambda values: values,
):
    """The solution with one piece replaced, for the known mistakes."""

    def answer(cars, policy, horizon):
        values = np.zeros((len(cars), N_ACTIONS))
        for action in range(N_ACTIONS):
            imagined, alive = cars, np.ones(len(cars), dtype=bool)
            for decision in range(horizon + more):
                imagined, rewards, crashed = step(imagined, asked(decision, action, policy, cars, imagined))
                values[:, action] += pay(alive, rewards)
                alive &= ~crashed
            values[:, action] += rest(alive, imagined[:, EGO, SPEED])
        return combine(values)

    return answer


def first_then(then):
    """`asked` with another choice after the first decision."""
    return lambda decision, action, policy, start, imagined: (
        np.full(len(start), action) if decision == 0 else then(action, policy, start)
    )


rollout_values = Exercise(
    "rollout_values(cars, policy, horizon)", solution=imagined_road.rollout_values, cases=cases,
    worked=(
        # every action touches the car ahead within the first decision: -10, and nothing follows
        ((blocked(), keep, 3), np.full((1, N_ACTIONS), DEFAULT.reward.accident)),
    ),
    mistakes=(
        Mistake(rollouts(more=1),
            "You imagine one decision too many: the horizon counts the first decision, too.",
            "The horizon is how often the policy is asked."),
        Mistake(rollouts(pay=lambda alive, rewards: rewards),
            "Your imagined car earns after its accident. An accident ends the episode: nothing is added from there on.",
            "The road goes on, so the rewards do."),
        Mistake(rollouts(rest=lambda alive, speeds: worth(speeds)),
            "A drive that ended in an accident has no future: add the worth of the last speed only where the car is "
            "still driving.",
            "Every drive has a last speed."),
        Mistake(rollouts(rest=lambda alive, speeds: 0.0),
            "What comes after the horizon is missing. Without it, ten seconds of braking cost more than they gain.",
            "The horizon is the whole future."),
        Mistake(rollouts(asked=lambda decision, action, policy, start, imagined: policy(imagined)),
            "All nine drives begin with the policy's own action, so the nine values are equal. The first decision is "
            "the action that is judged.",
            "A rollout is a drive of the policy."),
        Mistake(rollouts(asked=first_then(lambda action, policy, start: np.full(len(start), action))),
            "You hold the action for the whole drive. Only the first decision is given; after it the policy decides.",
            "To try an action is to keep doing it."),
        Mistake(rollouts(asked=first_then(lambda action, policy, start: policy(start))),
            "You ask the policy about the road as it is now. Ask it about the imagined road, again at each decision.",
            "The policy has one answer."),
        Mistake(rollouts(combine=lambda values: values - values.max(axis=1, keepdims=True)),
            "You subtract the best value. Return the values themselves: others compare them with returns.",
            "Only differences matter."),
    ),
    hints=(
        "Three loops: over the nine actions, over the decisions of a drive; all roads go along as arrays.",
        "Keep `alive`, (roads,) bool: a reward counts where the car was alive before the decision.",
        "`actions = np.full(len(cars), action) if decision == 0 else policy(imagined)`, and after the loop "
        "`values[:, action] += alive * worth(imagined[:, EGO, SPEED])`.",
    ),
    minutes=18, difficulty=3,
    equation="Q(s, a): the return of doing a and then following the policy, over the horizon (Tesauro & Galperin 1996)",
)  # fmt: skip
