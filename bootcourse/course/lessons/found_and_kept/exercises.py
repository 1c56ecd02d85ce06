"""Exercises of the lesson on finding the way out and keeping it."""

import numpy as np

from bootcourse.course.exercise import exercise


def training_curves(rng):
    """At the two limits and one beside them; in the first window or the last; then 30 at random, as in the panel."""
    yield np.repeat([[0, 0], [1, 1]], 30, axis=1), 40, 5
    for ahead, behind in ((39, 11), (40, 10), (41, 9)):  # the most of a window
        yield np.repeat([[0, 1, 0]], [60, ahead, behind + 50], axis=1), 40, 25
    for left in (9, 10, 11):  # at the end of the training: the last window has so many ahead
        yield np.repeat([[1, 0]], [50, 50 - left], axis=1), 40, 10
        yield np.repeat([[1, 0, 1]], [50, 50 - left, 60], axis=1), 40, 10
    yield np.repeat([[1, 0, 1, 0], [0, 1, 0, 1]], 45, axis=1), 30, 20
    for _ in range(30):
        share = np.repeat(rng.beta(0.4, 0.4, (130, 6)), 40, axis=1)  # it changes every 40 episodes
        yield (rng.random(share.shape) < share).astype(np.float32), rng.integers(36, 46), rng.integers(5, 36)


@exercise(
    "a window of 50 with at least `had` ahead, and after it one with `limit` or fewer", minutes=12, difficulty=3,
    cases=training_curves,
    worked=[
        ((np.repeat([[1, 0], [0, 1]], 50, axis=1), 40, 25), np.array([True, False])),  # had and lost; found late
        ((np.repeat([[1, 0, 1], [1, 1, 1]], [40, 20, 60], axis=1), 38, 30), np.array([True, False])),  # 30 ahead of 50
    ],
    hints=(
        "First count the successes of every 50 episodes in a row, for each agent: `sums = np.cumsum(...)` with a 0 in "
        "front, then the difference of sums 50 apart.",
        "`np.maximum.accumulate(good, axis=1)` stays True from the first True on: it says at each window whether the "
        "agent had the way out by then.",
    ),
    mistakes={
        "np.maximum.accumulate(ahead >= had, axis=1) -> (ahead >= had).any(axis=1)[:, None]":
            "Your function counts low windows *before* the agent had the way out, too: each agent begins with some. "
            "Only a low window after one with `had` ahead is a loss.",
        "ahead <= limit -> ahead < limit":
            "A window with exactly `limit` ahead counts as lost, too.",
        "ahead >= had -> ahead > had":
            "A window with exactly `had` ahead is enough: *at least* `had`.",
        "return by_then[:, -1] & (ahead[:, -1] <= limit)":
            "You look at the last window alone. An agent that loses the way out and finds it again has lost it once.",
        "return by_then.any(axis=1)":
            "You say who had the way out. An agent that lost it also has, later, a low window: 50 whole episodes.",
        "return (ahead <= limit).any(axis=1)":
            "You say who had a low window. Each agent that begins to learn has one: look only after a window with "
            "`had` ahead.",
        "return ~(by_then & (ahead <= limit)).any(axis=1)":
            "Your answers are the opposite: True means that the agent lost the way out.",
        "ahead = sums[:, 50:] - sums[:, :-50] -> ahead = (sums[:, 50:] - sums[:, :-50])[:, ::50]":
            "Your windows do not overlap. Each episode from the 50th on ends a window.",
        "ahead = sums[:, 50:] - sums[:, :-50] -> ahead = (sums[:, 50:] - sums[:, :-50]) / 50":
            "You compare a mean, which is at most 1, with `had` and `limit`: count the successes of a window.",
    },
)  # fmt: skip
def ever_lost(success, had, limit):
    sums = np.cumsum(np.pad(success, ((0, 0), (1, 0))), axis=1)
    ahead = sums[:, 50:] - sums[:, :-50]
    by_then = np.maximum.accumulate(ahead >= had, axis=1)
    return (by_then & (ahead <= limit)).any(axis=1)


def table_cases(rng):
    """Certain rows, halves, one agent, one episode; then 30 at random."""
    yield [np.array([0.0, 0.0]), np.array([1.0])], [0, 1], 20
    yield [np.array([0.5, 0.5])], [1], 2
    yield [np.array([0.0, 1.0]), np.array([0.0, 1.0])], [1, 0], 20
    yield [np.array([0.25]), np.array([0.75, 1.0])], [0, 1], 1
    for _ in range(30):
        rows = [rng.beta(0.5, 0.5, rng.integers(1, 11)) for _ in range(rng.integers(1, 5))]
        yield rows, rng.integers(0, 2, len(rows)).tolist(), int(rng.integers(1, 21))


@exercise(
    "the product over rows of the mean over agents of s^episodes, or of (1 - s)^episodes", minutes=10, difficulty=2,
    cases=table_cases,
    worked=[
        (([np.array([1.0, 0.0])], [1], 20), 0.5),  # one agent of two drives all 20 ahead
        (([np.array([0.5]), np.array([0.0, 0.0, 0.0, 1.0])], [1, 0], 2), 0.1875),  # 1/4 times 3/4
    ],
    hints=(
        "An agent that succeeds with probability s does so in all `episodes` drives with probability s ** episodes, "
        "and in none with (1 - s) ** episodes.",
        "Which agent stands behind a row is drawn: take the *mean* over the row's agents. The rows are independent.",
    ),
    mistakes={
        "np.mean -> np.prod":
            "You ask that all agents of a row drive like that. One of them is drawn: take the mean over the agents.",
        "np.mean(success**episodes if all_ahead else (1 - success) ** episodes) -> "
        "np.mean(success if all_ahead else 1 - success) ** episodes":
            "You average the agents first, as if each drive had an agent of its own. One agent drives them all: the "
            "power first, then the mean.",
        "(1 - success) ** episodes -> 1 - success**episodes":
            "1 - s ** episodes is the chance of at least one failure. The row says 0 %: every drive has to fail.",
        "np.prod -> np.mean":
            "You average the rows. The table reads as printed if every row does: multiply.",
        "success**episodes if all_ahead else (1 - success) ** episodes -> success**episodes":
            "You ask for 100 % in each row. A row that prints 0 % asks that no drive succeeds.",
    },
)  # fmt: skip
def reads_as_printed(rows, printed, episodes):
    chances = []
    for success, all_ahead in zip(rows, printed, strict=True):
        chances.append(np.mean(success**episodes if all_ahead else (1 - success) ** episodes))
    return np.prod(chances)
