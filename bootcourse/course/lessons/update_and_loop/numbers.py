"""What the text of the lesson on SAC's update and loop names: trainings of ours on the pole, with and without marks.

    python -m bootcourse.course.lessons.update_and_loop.numbers

trains them again, in about a minute and a half. Other processors round otherwise, and may give other tests.
"""

import numpy as np

from bootcourse.course.lessons.update_and_loop import by_hand, worlds
from bootcourse.course.lessons.update_and_loop.worlds import GAMMA  # noqa: F401 (the text names it)
from bootcourse.research.experiments import checks

BLOCK, SOLVED = 2_000, 475  # pushes from one test to the next; Gymnasium's mark
# The tests of the seeds 0 to 4 with the exercises' answers: before the training and after each block.
FIVE = (
    (9.2, 489.9, 174.7, 240.1, 500.0, 500.0),
    (9.4, 440.1, 500.0, 500.0),
    (9.4, 269.1, 125.8, 500.0, 500.0),
    (11.7, 166.6, 260.2, 129.6, 480.0, 500.0),
    (9.4, 247.0, 148.7, 314.8, 500.0, 500.0),
)
AFTER = (500.0, 500.0, 500.0, 500.0, 500.0)  # after training, a mean of 100 episodes
# Q along a fall, see `worlds.along_falls`, after the first block of the same trainings.
EARLY = (
    (41.1, 39.3, 34.2, 24.9, 14.0, 5.8, 1.3, -0.3, -1.1),
    (38.5, 36.9, 32.3, 24.9, 16.3, 8.9, 4.1, 2.0, 0.9),
    (43.9, 43.2, 40.0, 33.0, 22.2, 11.1, 4.1, 0.8, -1.3),
    (41.2, 39.9, 35.8, 27.8, 16.4, 6.8, 1.9, -0.7, -2.8),
    (40.4, 39.2, 35.3, 27.1, 15.0, 5.1, 0.5, -1.2, -2.6),
)
# Agents of the same seeds after a block in which no fall is marked: the least Q along a fall, Q of the fallen pole, Q 8
# pushes before, the most that Q can be, and for how many pushes they balance.
UNMARKED = (
    (470.6, 851.0, 470.6, 124.2, 9.4),
    (307.6, 471.2, 307.6, 133.1, 9.4),
    (304.8, 621.1, 304.8, 135.7, 9.4),
    (223.0, 277.7, 227.3, 140.6, 9.4),
    (204.7, 261.2, 205.0, 164.7, 9.2),
)


def solved() -> int:
    """How many of the five solved the pole: two tests in a row reach the mark, and so does the mean of 100 episodes."""
    return sum(min(*tests[-2:], after) >= SOLVED for tests, after in zip(FIVE, AFTER, strict=True))


def pushes() -> list[int]:
    """After how many pushes each of the five stopped."""
    return [BLOCK * (len(tests) - 1) for tests in FIVE]


def with_setbacks() -> int:
    """How many of the five had a test that was worse than the one before."""
    return sum(min(np.diff(tests)) < 0 for tests in FIVE)


def falling() -> int:
    """How many of the five expect less with each push towards the fall, after their first block."""
    return sum(max(np.diff(q)) < 0 for q in EARLY)


def last_push() -> list[float]:
    """What the five expect one push before the fall, where 1 is right, whatever they do."""
    return [q[-2] for q in EARLY]


def unmarked() -> int:
    """How many of those without marks have a Q above all that is possible, most for a fallen pole, and fall at once."""
    return sum(least > most and fallen > before and length < 10 for least, fallen, before, most, length in UNMARKED)


def train(seed: int) -> tuple[list[float], float, list[float]]:
    """Train as the lesson does, with the exercises' answers: the tests, the mean of 100 episodes, a row of `EARLY`."""
    from bootcourse.course.lessons.update_and_loop import exercises

    agent, rng, env = by_hand.SAC(seed), np.random.default_rng(seed), checks.cartpole()
    kept, tests = exercises.ReplayBuffer.solution(50_000), [by_hand.balanced(agent)]
    early: list[float] = []
    while min(tests[-2:]) < SOLVED and len(tests) <= 30:
        exercises.train.solution(agent, env, kept, exercises.update.solution, BLOCK, rng)
        tests.append(by_hand.balanced(agent))
        early = early or worlds.along_falls(agent).tolist()
    return tests, by_hand.balanced(agent, 100), early


def train_unmarked(seed: int) -> tuple[float, ...]:
    """Train for a block without marks, with the exercises' answers: a row of `UNMARKED`."""
    from bootcourse.course.lessons.update_and_loop import exercises

    agent, rows = by_hand.SAC(seed), worlds.Unmarked(exercises.ReplayBuffer.solution(50_000))
    rng = np.random.default_rng(seed)
    exercises.train.solution(agent, checks.cartpole(), rows, exercises.update.solution, BLOCK, rng)
    q = worlds.along_falls(agent)
    return float(q.min()), float(q[-1]), float(q[0]), worlds.most_possible(agent), by_hand.balanced(agent)


if __name__ == "__main__":
    for seed in range(len(FIVE)):
        print(seed, *train(seed), train_unmarked(seed), flush=True)
