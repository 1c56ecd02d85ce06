"""Do agents with the exercises' answers solve the pole, and what do they expect if no fall is marked?

    bootcourse study pole --out DIR    # about six minutes

In two kinds no fall is marked, but rows of fallen poles are added (`worlds.WithFallen`); in two the guess of a fallen
pole is frozen (`worlds.FrozenGuess`), in one of these at 30. With marks agents train until two tests in a row reach
gymnasium's mark; ten more of each kind train for one block. Other processors round otherwise, and may give other tests.
"""

from functools import partial
from itertools import zip_longest
from pathlib import Path

import numpy as np

from bootcourse.course.lessons.update_and_loop import by_hand, exercises, worlds
from bootcourse.research.cells import results_of
from bootcourse.research.experiment import Computed, Experiment
from bootcourse.research.problems import cartpole
from bootcourse.research.results import Results
from bootcourse.research.tables import markdown

NAME = "pole"
BLOCK, SOLVED = 2_000, 475  # pushes from one test to the next; gymnasium's mark
KINDS = ("marked", "unmarked", "paid-0", "paid-1", "frozen", "frozen-30")
BLOCKS = dict.fromkeys(KINDS, 1) | {"marked": 30}  # cell: the most blocks of a training
BUFFERS = {  # what keeps the rows
    "marked": lambda buffer: buffer,
    "unmarked": worlds.Unmarked,
    "paid-0": partial(worlds.WithFallen, paid=0),
    "paid-1": partial(worlds.WithFallen, paid=1),
    "frozen": worlds.Unmarked,
    "frozen-30": worlds.Unmarked,
}
FROZEN = {"frozen": worlds.FrozenGuess, "frozen-30": worlds.FrozenAt30}  # agents whose guess of a fallen pole is
MORE = 10  # agents of each kind that train for one block only


def cells(seeds: int = 5) -> dict[str, dict]:
    """With falls marked, and without; without, but with rows of fallen poles that are paid 0, or 1, or a frozen guess.

    Then more of each kind, with the seeds that follow.
    """
    more = {f"more-{kind}": {"kind": kind, "seeds": MORE, "first": seeds, "blocks": 1} for kind in BLOCKS}
    return {kind: {"kind": kind, "seeds": seeds} for kind in BLOCKS} | more


def train_kind(kind: str, seeds: int, first: int = 0, blocks: int = 0) -> Results:
    """Train agents one after the other, and keep what `train` says of them; notes are filled up with NaN.

    first: the first seed. blocks: the most of a training; 0: as many as BLOCKS has.
    """
    numbers, blocks = range(first, first + seeds), blocks or BLOCKS[kind]
    tests, q, most, after = zip(*(train(kind, seed, blocks) for seed in numbers), strict=True)
    notes = np.split(np.array([*zip_longest(*tests, *q, fillvalue=np.nan)]).T, 2)
    return Results(
        [{"method": "by hand", "seed": seed, "teacher": "none"} for seed in numbers],
        np.full(seeds, -1),
        notes=dict(zip(("tests", "q"), notes, strict=True)),
        measured={"most": np.array(most), "after": np.array(after)},
    )


def train(kind: str, seed: int, blocks: int) -> tuple[list[float], np.ndarray, float, float]:
    """Train an agent as the lesson does.

    Returns its tests, before the training and after each block; after the first block Q along a fall, see
    `worlds.along_falls`, and the most that Q can be; after the training a mean of 100 episodes.
    """
    agent = FROZEN.get(kind, by_hand.SAC)(seed)
    rng, env = np.random.default_rng(seed), cartpole()
    kept, tests, expected = BUFFERS[kind](exercises.ReplayBuffer.solution(50_000)), [by_hand.balanced(agent)], ()
    while min(tests[-2:]) < SOLVED and len(tests) <= blocks:
        exercises.train.solution(agent, env, kept, exercises.update.solution, BLOCK, rng)
        tests.append(by_hand.balanced(agent))
        expected = expected or (worlds.along_falls(agent), worlds.most_possible(agent))
    return tests, *expected, by_hand.balanced(agent, 100)


def section(computed: dict[str, Computed], folder: Path) -> list[str]:
    """How each agent did."""
    rows = []
    for kind, agents in computed[NAME].items():
        each = agents.notes["tests"], agents.notes["q"], agents.measured["after"], agents.measured["most"]
        for agent, (tests, q, after, most) in zip(agents.agents, zip(*each, strict=True), strict=True):
            values = (f"{value:.0f}" for value in (after, q[0], q[worlds.BEFORE], most))
            rows.append([kind, agent["seed"], f"{BLOCK * (np.isfinite(tests).sum() - 1):,}", *values])
    of_q = f"Q {worlds.BEFORE} pushes before a fall", "Q of a fallen pole", "the most that Q can be"
    headings = ["falls", "seed", "pushes in training", "pushes balanced", *of_q]
    return ["## The pole, with falls marked and without\n", ABOUT, markdown(headings, rows)]


ABOUT = f"""Agents of the lesson on the update and the loop, trained with the answers to its exercises. Pushes balanced:
after training, a mean of 100 episodes of at most 500 pushes. Q: after {BLOCK:,} pushes, a mean of 40 falls. Paid 0 and
1: no fall is marked, but rows are added that say what a push pays a fallen pole, which stays fallen. Frozen: no fall
is marked, and critics that never learn say what a fallen pole is worth; frozen-30: it is always 30. More: other seeds,
{BLOCK:,} pushes.
"""

EXPERIMENT = Experiment(NAME, cells, results_of(train_kind), section=section)
