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


@wrong("rollout_values")
def the_agent_asked_once(cars, policy, horizon):
    """The policy decides after the first step, and its action is held from then on."""
    values = np.zeros((len(cars), 9))
    for action in range(9):
        here, rewards, crashed = imagined_road.step(cars, np.full(len(cars), action))
        alive, held = ~crashed, policy(here)
        values[:, action] = rewards
        for _ in range(horizon - 1):
            here, rewards, crashed = imagined_road.step(here, held)
            values[:, action] += alive * rewards
            alive &= ~crashed
        values[:, action] += alive * imagined_road.worth(here[:, 0, 3])
    return values


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
