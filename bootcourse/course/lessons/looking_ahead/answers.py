"""Answers to the exercises of the lesson on looking ahead."""

import numpy as np

from bootcourse.course.lessons.looking_ahead import imagined_road
from tests.answers import equivalent, right, right_lines, wrong, wrong_lines


@right("rollout_values")
def by_recursion(cars, policy, horizon, gamma, worth):
    def earned(cars, actions, left):
        following, rewards, crashed = imagined_road.step(cars, actions)
        later = earned(following, policy(following), left - 1) if left > 1 else worth(following[:, 0, 3])
        return rewards + gamma * np.where(crashed, 0.0, later)

    return np.stack([earned(cars, np.full(len(cars), action), horizon) for action in range(9)], axis=1)


wrong_lines("""rollout_values
    one action: solution(cars, policy, horizon, gamma, worth)[:, :1]
""")


right_lines("""shield
    by take_along_axis: np.where(np.take_along_axis(accidents, actions[:, None], 1)[:, 0], values.argmax(1), actions)
    by a mask: (lambda bad: bad * values.argmax(1) + (1 - bad) * actions)(accidents[range(len(actions)), actions] * 1)
""")

wrong_lines("""shield
    the first road alone: solution(actions, values, accidents)[:1]
    by a low value: np.where(values[np.arange(len(actions)), actions] < 1, values.argmax(1), actions)
""")


@right("rollout_values")
def action_by_action(cars, policy, horizon, gamma, worth, stops_from=np.inf):
    """stops_from: the decision from which an accident on one road stops all; wrong, unless it never comes."""
    values = np.zeros((len(cars), 9))
    for action in range(9):
        imagined, alive = cars, np.ones(len(cars), dtype=bool)
        for decision in range(horizon):
            actions = np.full(len(cars), action) if decision == 0 else policy(imagined)
            imagined, rewards, crashed = imagined_road.step(imagined, actions)
            values[:, action] += alive * gamma**decision * rewards
            alive &= ~crashed
            if decision >= stops_from and crashed.any():
                break
        values[:, action] += alive * gamma**horizon * worth(imagined[:, 0, 3])
    return values


@wrong("rollout_values")
def all_roads_stop_at_a_late_accident_of_one(cars, policy, horizon, gamma, worth):
    return action_by_action(cars, policy, horizon, gamma, worth, stops_from=4)


equivalent(
    "rollout_values",
    "values.reshape(-1, 9)  ->  values.reshape(-2, 9)",
    "NumPy takes any negative length as the one to work out.",
)
