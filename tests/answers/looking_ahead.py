"""Answers to the exercises of the lesson on looking ahead."""

import numpy as np

from bootcourse.course.lessons.looking_ahead import imagined_road
from tests.answers import right, right_lines, wrong, wrong_lines


@right("rollout_values")
def all_branches_in_one_array(cars, policy, horizon):
    """Nine copies of each road side by side; the accidents are left out of the array from then on."""
    roads = len(cars)
    copies = np.repeat(cars, 9, axis=0)
    actions = np.tile(np.arange(9), roads)
    values, going = np.zeros(9 * roads), np.arange(9 * roads)
    for decision in range(horizon):
        if decision:
            actions = policy(copies)
        copies, rewards, crashed = imagined_road.step(copies, actions)
        values[going] += rewards
        going, copies = going[~crashed], copies[~crashed]
        if not len(going):
            break
    values[going] += imagined_road.worth(copies[:, 0, 3])
    return values.reshape(roads, 9)


@right("rollout_values")
def road_by_road(cars, policy, horizon):
    """One road and one action at a time, with a loop that ends at the accident."""
    values = []
    for road in cars:
        of_road = []
        for action in range(9):
            here, total = road[None], 0.0
            for decision in range(horizon):
                chosen = policy(here) if decision else np.array([action])
                here, reward, crashed = imagined_road.step(here, chosen)
                total += float(reward[0])
                if crashed[0]:
                    break
            else:
                total += float(imagined_road.worth(here[0, 0, 3]))
            of_road.append(total)
        values.append(of_road)
    return np.array(values)


@right("rollout_values")
def by_recursion(cars, policy, horizon):
    def earned(cars, actions, left):
        following, rewards, crashed = imagined_road.step(cars, actions)
        later = earned(following, policy(following), left - 1) if left > 1 else imagined_road.worth(following[:, 0, 3])
        return rewards + np.where(crashed, 0.0, later)

    return np.stack([earned(cars, np.full(len(cars), action), horizon) for action in range(9)], axis=1)


@wrong("rollout_values")
def the_average_reward(cars, policy, horizon):
    return by_recursion(cars, policy, horizon) / horizon


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
    transposed: solution(cars, policy, horizon).T
    one action: solution(cars, policy, horizon)[:, :1]
    the best action: solution(cars, policy, horizon).argmax(axis=1)
    a fixed horizon: solution(cars, policy, 10)
    discounted: 0.8 * solution(cars, policy, horizon)
""")


@right("shield")
def one_road_at_a_time(actions, values, accidents):
    chosen = []
    for action, nine, ends in zip(actions, values, accidents, strict=True):
        chosen.append(int(np.argmax(nine)) if ends[action] else int(action))
    return np.array(chosen)


right_lines("""shield
    by take_along_axis: np.where(np.take_along_axis(accidents, actions[:, None], 1)[:, 0], values.argmax(1), actions)
    by a mask: (lambda bad: bad * values.argmax(1) + (1 - bad) * actions)(accidents[range(len(actions)), actions] * 1)
""")

wrong_lines("""shield
    the worst: np.where(accidents[np.arange(len(actions)), actions], values.argmin(1), actions)
    always the base: actions
    brakes: np.where(accidents[np.arange(len(actions)), actions], 1, actions)
    the first road alone: solution(actions, values, accidents)[:1]
    by a low value: np.where(values[np.arange(len(actions)), actions] < 1, values.argmax(1), actions)
""")
