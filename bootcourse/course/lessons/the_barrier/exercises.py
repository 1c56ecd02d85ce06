"""Exercises of the lesson on the barrier."""

import numpy as np

from bootcourse.course.exercise import exercise


def luck_cases(rng):
    """One attempt, every action good, one decision; then 50 at random."""
    yield from ((3, 2, 1), (9, 20, 5), (1, 1, 9), (1, 8, 1000))
    yield from ((rng.integers(1, 9), rng.integers(1, 8), rng.integers(1, 300)) for _ in range(50))


@exercise(
    "1 - (1 - (g/9)^n)^tries: the chance of a way out by chance", minutes=5, difficulty=2, cases=luck_cases,
    worked=[((3, 2, 1), 1 / 9), ((3, 1, 2), 5 / 9)],  # (1/3)²; 1 - (2/3)²
    hints=(
        "First one attempt: `good` of nine actions are right, `decisions` times in a row.",
        "Then all attempts: the chance that all of them fail is (1 - once) to the power of `tries`.",
    ),
    mistakes={
        "return tries * once":
            "Your chance can be above 1, because it counts two lucky attempts twice. Compute the chance that *every* "
            "attempt fails.",
        "return min(1.0, tries * once)":
            "You add the chances of the attempts, which counts two lucky ones twice. Compute the chance that *every* "
            "attempt fails.",
        "return (1 - once) ** tries":
            "This is the chance that *no* attempt is lucky. The chance of at least one is 1 minus that.",
        "return once":
            "This is the chance of one attempt. There are `tries` of them, and one lucky one is enough.",
        "return once**tries":
            "This is the chance that *all* attempts are lucky. One is enough.",
        "return 1 - (1 - good / 9) ** (decisions * tries)":
            "This is the chance that at least one decision is right. All decisions of one attempt have to be right.",
        "(good / 9) ** decisions -> min(1.0, decisions * good / 9)":
            "Within an attempt you add the chances. The chance that all decisions are right is their product.",
    },
)  # fmt: skip
def luck(good, decisions, tries):
    once = (good / 9) ** decisions
    return 1 - (1 - once) ** tries


DRIVES = np.array([[1.0, 2.0, 4.0, 8.0], [1.0, -10.0, 0.0, 0.0], [3.0, 0.0, 2.0, 0.0]])
LASTED = np.array([4, 2, 3])  # s


def going_on_cases(rng):
    """Three drives by hand at each second, one drive alone, none discounted; then 40 at random, most with crashes."""
    yield from ((DRIVES, LASTED, 0.5, t) for t in range(4))
    yield DRIVES[:1], LASTED[:1], 0.8, 2
    yield DRIVES, LASTED, 1.0, 1
    for _ in range(40):
        drives, seconds = rng.integers(2, 200), rng.integers(3, 60)
        lasted = rng.integers(1, seconds + 1, drives)
        rewards = np.where(np.arange(seconds) < lasted[:, None], rng.uniform(0, 1, (drives, seconds)), 0.0)
        crashed = rng.random(drives) < 0.5
        rewards[crashed, lasted[crashed] - 1] = -rng.integers(1, 11)
        yield rewards, lasted, rng.uniform(0.5, 1), int(rng.integers(0, lasted.max()))


@exercise(
    "the mean of Σ_k γ^k r_(t+k) over the drives that still run after t s", minutes=6, difficulty=2,
    cases=going_on_cases,
    worked=[
        ((DRIVES, LASTED, 0.5, 0), (4.0 - 4.0 + 3.5) / 3),  # 1 + 1 + 1 + 1; 1 - 5; 3 + 0 + 0.5
        ((DRIVES, LASTED, 0.5, 2), (8.0 + 2.0) / 2),  # 4 + 4; 2; the second drive has ended
    ],
    hints=(
        "First choose: of the drives with `lasted > t` the seconds from t on.",
        "`rest = rewards[lasted > t, t:]`; then `rest @ gamma ** np.arange(rest.shape[1])` is a sum for each drive.",
    ),
    mistakes={
        "rewards[lasted > t, t:] -> rewards[:, t:]":
            "You count the drives that have ended, too, with 0. Only those that still run have a rest.",
        "lasted > t -> lasted >= t":
            "A drive that lasted exactly t seconds has ended after t seconds: it has no rest.",
        "rewards[lasted > t, t:] -> rewards[lasted == lasted.max(), t:]":
            "You take the longest drives alone. Those that end later than t seconds count, too, with their accidents.",
        "np.arange(rest.shape[1]) -> np.arange(t, rewards.shape[1])":
            "You discount from the drive's start. You stand at second t: the first reward that follows counts in full.",
        "np.arange(rest.shape[1]) -> np.arange(1, rest.shape[1] + 1)":
            "You discount the first reward that follows. It comes at once and counts in full: γ⁰ = 1.",
        "t:] -> t + 1:]":
            "You leave out a reward. After t seconds the next one is that of column t.",
        "t:] -> :]":
            "You count the seconds that are already driven, too. The rest begins in column t.",
        "return rest.sum(axis=1).mean()":
            "You add the rewards without discounting them.",
        ".mean() -> .sum()":
            "You return the sum over the drives. Take their mean.",
    },
)  # fmt: skip
def going_on(rewards, lasted, gamma, t):
    rest = rewards[lasted > t, t:]
    return (rest @ gamma ** np.arange(rest.shape[1])).mean()
