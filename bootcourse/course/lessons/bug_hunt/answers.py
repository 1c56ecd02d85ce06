"""Answers to the exercises of the bug hunt."""

import numpy as np

from tests.answers import right, right_lines, wrong, wrong_lines

right_lines("""end_error
    row by row: errors = [row[a] - r for row, a, r, over in zip(q, actions, rewards, terminated, strict=True) if over]
        sum(errors) / len(errors) if errors else 0
    with weights: taken = np.take_along_axis(q, actions[:, None], 1)[:, 0]
        ((taken - rewards) * terminated).sum() / max(terminated.sum(), 1)
""")


@wrong("end_error", "NaN")
def nan_without_accidents(q, actions, rewards, terminated):
    with np.errstate(invalid="ignore"):
        return ((q[np.arange(len(q)), actions] - rewards) * terminated).sum() / terminated.sum()


wrong_lines("""end_error
    minus ten by heart: taken = q[np.arange(len(actions)), actions]
        np.sum((taken + 10) * terminated) / max(1, terminated.sum())
    where the reward is minus ten: crashed = rewards == -10
        np.sum((q[np.arange(len(actions)), actions] + 10)[crashed]) / max(1, crashed.sum())
""")


BUGS = ("flipped_kl", "sampled", "shifted_labels", "no_end", "bonus_for_all", "no_stop")
TRUE = dict(zip("ABCDEF", BUGS, strict=True))
right_lines("""diagnose
    with a dictionary: TRUE[agent]
    with branches:
        if agent in "ABC":
            return ("flipped_kl", "sampled", "shifted_labels")["ABC".index(agent)]
        if agent == "D":
            return "no_end"
        "bonus_for_all" if agent == "E" else "no_stop"
""")

wrong_lines("""diagnose
    one twice: {**TRUE, "D": "sampled"}[agent]  # Not all six verdicts are right
    in words: TRUE[agent].replace("_", " ")  # the six names are
    five of them: {letter: TRUE[letter] for letter in "ABCDE"}[agent]  # raises an error
""")


def right_y(reward, demo, bonus, end, value, gamma):
    return reward + bonus * demo + gamma * (1 - end) * value


right_lines("""unmasks
    at random: rng = np.random.default_rng(1)
        rows = [rng.normal(0, 3, 20), rng.integers(0, 2, 20), 1.7, rng.integers(0, 2, 20), rng.normal(0, 3, 20), 0.6]
        bool((abs(target(*rows) - right_y(*rows)) > 1e-9).any())
""")


@right("unmasks")
def with_names_and_lists(target):
    reward, demo, end, value = [1.0, -10.0, 0.5, -3.0], [0, 0, 1, 1], [0, 1, 0, 1], [4.0, 2.0, 7.0, -1.0]
    y = target(reward=reward, demo=demo, bonus=3.0, end=end, next_value=value, gamma=0.5)
    return [round(float(each), 6) for each in y] != [3.0, -10.0, 7.0, 0.0]


wrong_lines("""unmasks
    with the paper's numbers: rng = np.random.default_rng(1)
        rows = [rng.normal(0, 3, 20), rng.integers(0, 2, 20), 2.0, rng.integers(0, 2, 20), rng.normal(0, 3, 20), 0.8]
        not np.allclose(target(*rows), right_y(*rows))  # bonus of 2
    equal next values: rng = np.random.default_rng(1)
        rows = [rng.normal(0, 3, 20), rng.integers(0, 2, 20), 1.7, rng.integers(0, 2, 20), np.full(20, 4.0), 0.6]
        not np.allclose(target(*rows), right_y(*rows))
    without the end in its own y: reward, end = np.array([1.0, -10.0]), np.array([0.0, 1.0])
        not np.allclose(target(reward, 0 * end, 3.0, end, 4 + end, 0.5), reward + 0.5 * (4 + end))  # by hand once more
    to the last digit: rng = np.random.default_rng(1)
        rows = [rng.normal(0, 3, 20), rng.integers(0, 2, 20), 1.7, rng.integers(0, 2, 20), rng.normal(0, 3, 20), 0.6]
        bool((target(*rows) != right_y(*rows)).any())  # compare with `np.allclose`
    drawn anew each time: rng = np.random.default_rng()
        rng.random() < 0.5  # differently each time
""")

wrong_lines("""end_error
    clipped: np.clip(solution(q, actions, rewards, terminated), -20, 20)
""")


def errors_of(target):
    """By how much a target function misses y, for four transitions."""
    reward, value = np.array([1.0, -4.0, 2.0, 0.0]), np.array([3.0, 5.0, -2.0, 7.0])
    demo, end = np.arange(4) // 2, np.arange(4) % 2
    return np.abs(target(reward, demo, 3.0, end, value, 0.5) - (reward + 3.0 * demo + 0.5 * (1 - end) * value))


right_lines("""unmasks
    any error: (errors_of(target) > 1e-9).any()
    as a number: int(errors_of(target).max() > 1e-9)
    at random: rng = np.random.default_rng(5); reward, value = rng.normal(size=(2, 50))
        demo, end = rng.integers(0, 2, (2, 50))
        y = [r + 1.7 * d + (0 if e else 0.6 * v) for r, d, e, v in zip(reward, demo, end, value, strict=True)]
        not np.allclose(target(reward, demo, 1.7, end, value, 0.6), y)
""")

wrong_lines("""unmasks
    how many are wrong: int((errors_of(target) > 1e-9).sum())  # True or False
    each row: errors_of(target) > 1e-9  # a NumPy array
    the error: float(errors_of(target).max())  # True or False
    not a number: float("nan")
    a wide margin: errors_of(target).max() > 2.0
    bonus of the course: reward, value = np.array([1.0, -4.0, 2.0, 0.0]), np.array([3.0, 5.0, -2.0, 7.0])
        demo, end = np.arange(4) // 2, np.arange(4) % 2
        not np.allclose(target(reward, demo, 2.0, end, value, 0.5), reward + 2 * demo + 0.5 * (1 - end) * value)
    to the last digit: rng = np.random.default_rng(5); reward, value = rng.normal(size=(2, 50))
        demo, end = rng.integers(0, 2, (2, 50))
        bool((target(reward, demo, 1.7, end, value, 0.6) != reward + 1.7 * demo + 0.6 * (1 - end) * value).any())
""")
