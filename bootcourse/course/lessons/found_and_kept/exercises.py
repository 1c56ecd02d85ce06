"""Exercises of the lesson on finding the way out and keeping it."""

import numpy as np

from bootcourse.course.exercise import exercise


def training_curves(rng):
    """Never, always, found and kept, found and lost, a window as long as the training; then 30 at random.

    Then windows of 42 to 300, as in a training, with agents that are ahead in about half of them.
    """
    yield np.zeros((2, 6)), 3
    yield np.ones((1, 5)), 2
    yield np.array([[0, 0, 1, 1, 1, 1], [0, 1, 1, 1, 0, 0]]), 2
    yield np.array([[1, 1, 0, 0, 0, 1, 0, 0]]), 2
    yield np.array([[0, 1, 1, 0]]), 4
    for _ in range(30):
        agents, episodes = rng.integers(1, 4), rng.integers(6, 20)
        yield (rng.random((agents, episodes)) < rng.random((agents, 1))).astype(int), rng.integers(2, 6)
    for window in (42, 49, 50, 51, 58, 88, 100, 101, 104, 300):  # of some, half of the weights 1 / n is not quite 1/2
        half = np.tile([0, 1], (3, window))  # of an even window exactly half
        half[1, window - 1], half[2, window] = 1, 0  # one more, one fewer
        yield half, window
        yield (rng.random((4, 5 * window)) < 0.5).astype(int), window


@exercise(
    "means over a sliding window: the ends of the first and of the last above one half", minutes=12, difficulty=3,
    cases=training_curves,
    worked=[
        # the means of three in a row end with episodes 3 to 7: 1/3, 2/3, 1, 2/3, 1/3
        ((np.array([[0, 0, 1, 1, 1, 0, 0]]), 3), np.array([[4, 6]])),
        ((np.array([[0, 0, 0, 0], [1, 0, 1, 1]]), 4), np.array([[0, 0], [4, 4]])),
    ],
    hints=(
        "First the mean of every `window` episodes in a row, for each agent: `sums = np.cumsum(...)` with a 0 in "
        "front, then the difference of sums `window` apart, divided by `window`.",
        "`often.argmax(axis=1)` is the place of the first True. For the last one, look for the first in the reversed "
        "row, `[:, ::-1]`. `often.any(axis=1)` tells where there is none.",
    ),
    mistakes={
        "window + often.argmax(axis=1) -> 1 + often.argmax(axis=1)":
            "Your first number says where the first good window *begins*. Say with which episode it ends.",
        "return np.where(often.any(axis=1)[:, None], ends + 1 - window, 0)":
            "Your numbers say where the two windows *begin*. Say with which episodes they end.",
        "return np.where(often.any(axis=1)[:, None], ends - 1, 0)":
            "Both numbers are one too small: episodes are counted from 1, so a window of the first `window` episodes "
            "ends with episode `window`.",
        "means > 0.5 -> means > 0.55":
            "Your bar is higher than one half: in a window of 50 episodes 26 are more than half.",
        "means > 0.5 -> means >= 0.5":
            "Half is not more than half: an agent that is ahead in every second episode has not found the way out.",
        "window + often.argmax(axis=1), last -> last, window + often.argmax(axis=1)":
            "Your two numbers are swapped: the end of the first good window, then that of the last.",
        "window + often.argmax(axis=1) -> window - 1 + often.argmax(axis=1)":
            "Your first number is one too small: episodes are counted from 1, so a window of the first `window` "
            "episodes ends with episode `window`.",
        "often.any(axis=1)[:, None] -> True":
            "An agent without a good window gets numbers, too: `argmax` of a row without True is 0. Answer 0 and 0 "
            "there.",
        "often[:, ::-1].argmax(axis=1) -> np.zeros(len(often), int)":
            "Your second number is the training's last episode. Say with which episode the last *good* window ends.",
    },
)  # fmt: skip
def forgetting(success, window):
    sums = np.cumsum(np.pad(np.asarray(success, dtype=float), ((0, 0), (1, 0))), axis=1)
    means = (sums[:, window:] - sums[:, :-window]) / window
    often = means > 0.5
    last = window + means.shape[1] - 1 - often[:, ::-1].argmax(axis=1)
    ends = np.stack([window + often.argmax(axis=1), last], axis=1)
    return np.where(often.any(axis=1)[:, None], ends, 0)


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
