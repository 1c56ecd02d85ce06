"""Answers to the exercises of the lesson on looking ahead."""

import numpy as np

from bootcourse.course.lessons.looking_ahead import imagined_road
from tests.answers import right, right_lines, wrong, wrong_lines


@right("rollout_values")
def by_recursion(cars, policy, horizon):
    def earned(cars, actions, left):
        following, rewards, crashed = imagined_road.step(cars, actions)
        later = earned(following, policy(following), left - 1) if left > 1 else imagined_road.worth(following[:, 0, 3])
        return rewards + np.where(crashed, 0.0, later)

    return np.stack([earned(cars, np.full(len(cars), action), horizon) for action in range(9)], axis=1)


wrong_lines("""rollout_values
    one action: solution(cars, policy, horizon)[:, :1]
""")


right_lines("""shield
    by take_along_axis: np.where(np.take_along_axis(accidents, actions[:, None], 1)[:, 0], values.argmax(1), actions)
    by a mask: (lambda bad: bad * values.argmax(1) + (1 - bad) * actions)(accidents[range(len(actions)), actions] * 1)
""")

wrong_lines("""shield
    the first road alone: solution(actions, values, accidents)[:1]
    by a low value: np.where(values[np.arange(len(actions)), actions] < 1, values.argmax(1), actions)
""")


@wrong("rollout_values")
def all_roads_stop_at_a_late_accident_of_one(cars, policy, horizon):
    values = np.zeros((len(cars), 9))
    for action in range(9):
        imagined, alive = cars, np.ones(len(cars), dtype=bool)
        for decision in range(horizon):
            actions = np.full(len(cars), action) if decision == 0 else policy(imagined)
            imagined, rewards, crashed = imagined_road.step(imagined, actions)
            values[:, action] += alive * rewards
            alive &= ~crashed
            if decision >= 4 and crashed.any():
                break
        values[:, action] += alive * imagined_road.worth(imagined[:, 0, 3])
    return values
