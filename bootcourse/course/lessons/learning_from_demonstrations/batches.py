"""The exercise of the lesson on learning from demonstrations in which batches are mixed."""

import numpy as np
import torch

from bootcourse.course.drawing import drawn_apart, drawn_evenly, in_float32, independent
from bootcourse.course.exercise import NotAsAsked, exercise, refuse
from bootcourse.learn.replay_buffer import REWARD


class TableBuffer:
    """A replay buffer with rows that are there already; sample(batch, rng) draws from them."""

    def __init__(self, rows):
        self.rows = rows

    def sample(self, batch, rng):
        return self.rows[torch.from_numpy(rng.integers(len(self.rows), size=batch))]


def numbered(first, count, width=8):
    """Rows with the numbers first, first + 1, ... in column 0, from which all else follows: (count, width).

    The rewards are -10 to 10 in steps of a half, 0 among them.
    """
    numbers = torch.arange(first, first + count)
    rows = numbers[:, None] * torch.linspace(1, 0.5, width)
    rows[:, REWARD] = (7 * numbers % 41 - 20) / 2
    return rows


OWN = 10_000  # the number of the first row of the agent's own
SMALL = 12  # rows of a table so small that each can be drawn often
DRAWS = 150  # of each of these rows


def mixed_many_times(answer, demonstrations, size, beta, bonus):
    """What is in batches that are drawn one after the other from the same tables.

    Returns the shapes of the rows and of the marks; how many rows are demonstrations; the share of the marks that are
    right; the least and the most that was added to the reward of demonstrations, and of own rows; whether nothing else
    was changed; whether the demonstrations are drawn evenly, independently of each other, and anew for each batch;
    whether the own rows of two batches differ; whether equal generators give equal batches.
    """
    width = demonstrations.shape[1]
    own, rng = TableBuffer(numbered(OWN, 400, width)), np.random.default_rng(0)
    pairs = []
    small = len(demonstrations) <= SMALL
    for _ in range(DRAWS * SMALL // round(beta * size) if small else 3):
        pair = answer(own, demonstrations, size, beta, bonus, rng)
        if not (isinstance(pair, (tuple, list)) and len(pair) == 2):
            return refuse(pair, "the rows and their marks")
        for part in pair:
            if not isinstance(part, torch.Tensor):
                return refuse(part, "torch tensors, the rows and their marks, because training needs them")
        if pair[0].dim() != 2 or pair[0].shape[1] != width or pair[1].shape != pair[0].shape[:1]:
            shapes = " and ".join(str(tuple(part.shape)) for part in pair)
            return refuse(pair, f"({size}, {width}) rows and ({size},) marks; yours have the shapes {shapes}")
        in_float32(pair[0])
        pairs.append(pair)
    rows, marks = torch.cat([each for each, _ in pairs]), torch.cat([each for _, each in pairs])
    theirs, known = rows[:, 0] < OWN, numbered(0, OWN + 400, width)[rows[:, 0].long().clamp(0, OWN + 399)]
    mine = rows[theirs, 0]
    if len(mine) and not demonstrations[0, 0] <= mine.min() <= mine.max() <= demonstrations[-1, 0]:
        raise NotAsAsked("Your batch holds demonstrations that it was not given: draw from the table of this call, and "
                         "keep nothing from call to call.")  # fmt: skip
    added = rows - known
    groups = [added[who, REWARD] for who in (theirs, ~theirs)]
    paid = [end(group).item() if len(group) else 0.0 for group in groups for end in (torch.amin, torch.amax)]
    added[:, REWARD] = 0
    right = float((marks == theirs).float().mean())
    count = float(theirs[-size:].sum())
    drawn = [each[:, 0][each[:, 0] < OWN] for each, _ in pairs]
    equal = len({len(each) for each in drawn}) == 1
    even = not (small and equal) or drawn_evenly(torch.stack(drawn), len(demonstrations))
    if equal and sum(map(len, drawn)) > 50:  # a right answer misses a half once in 10¹⁵ times
        even &= bool(min(map(torch.amin, drawn)) < len(demonstrations) / 2 <= max(map(torch.amax, drawn)))
    apart = not equal or (independent if small else drawn_apart)(torch.stack(drawn), len(demonstrations))
    anew = len(drawn[0]) < 4 or any(not torch.equal(drawn[0], each) for each in drawn[1:])
    again = [answer(own, demonstrations, size, beta, bonus, np.random.default_rng(1))[0] for _ in range(2)]
    owned = [each[:, 0][each[:, 0] >= OWN] for each, _ in pairs[-2:]]
    fresh = differ(*owned) and (len(owned[0]) < 4 or 2 * len(owned[0].unique()) > len(owned[0]))
    judged = map(float, (not added.any(), even, apart, anew, fresh, torch.equal(*again)))
    return np.array([*pairs[-1][0].shape, *pairs[-1][1].shape]), count, right, *paid, *judged


def differ(one, other):
    """Whether more than half of two draws differ; fewer than four rows may agree by chance."""
    return len(one) < 4 or len(one) != len(other) or bool((one != other).float().mean() > 0.5)


def batch_cases(rng):
    """Half, none, all, shares that are no whole number from above and below, no bonus; small tables; 16 at random."""
    shares = (8, 0.5, 2.0), (8, 0.0, 2.0), (8, 1.0, 0.5), (64, 0.59, 1.0), (64, 0.51, 1.0), (32, 0.6, 0.0)
    for share in shares:
        yield numbered(0, 300, rng.integers(7, 14)), *share
    yield numbered(0, 3000, 9), 64, 0.5, 2.0
    yield numbered(4000, 300, 9), 16, 0.5, 2.0  # another table of this width
    for width, beta in ((8, 0.5), (11, 0.4), (10, 0.25)):
        yield numbered(0, SMALL, width), 20, beta, 2.0
    for _ in range(16):
        size, beta, bonus = rng.integers(12, 65), rng.uniform(0.1, 0.9), rng.uniform(0.1, 3)
        yield numbered(0, 300, rng.integers(7, 14)), size, beta, bonus


def of_the_batches(cases, answers):
    """A sentence on batches whose size, shares and rewards may be right, but that are not drawn as they should be."""
    for (_, size, beta, bonus), (shape, theirs, right, *paid, kept, even, apart, anew, fresh, same) in zip(
        cases, [[part.data for part in answer] for answer in answers], strict=True
    ):
        wanted = round(beta * size)
        if shape[0] != size or theirs != wanted:
            return (
                f"A batch of {size} with β = {beta:.3g} has {wanted} demonstrations and {size - wanted} own rows: "
                f"yours has {theirs:.0f} and {shape[0] - theirs:.0f}."
            )
        if abs(right - 1) > 1e-6:
            return "Some of your marks are wrong: each is 1 if *its* row is a demonstration, else 0."
        low, high, own_low, own_high = paid
        if high - low > 1e-3 or own_high - own_low > 1e-3:
            return (
                "Your bonus depends on the reward: each demonstration gets all of it, also where its reward is 0 or "
                "negative, and an own row gets none."
            )
        if abs(own_low) > 1e-3 or abs(low - (bonus if wanted else 0)) > 1e-3:
            return (
                f"With a bonus of {bonus:.3g}, your batch adds {low:.3g} to the rewards of the demonstrations "
                f"and {own_low:.3g} to those of the own rows."
            )
        if not kept:
            return "Your batch changes more of a row than its reward: the other columns stay as they are."
        if not anew:
            return (
                "Each of your batches has the same demonstrations: draw them anew for each batch, with the generator "
                "`rng` that you are given."
            )
        if not fresh:
            return (
                "Your own rows are one row again and again, or the same in each batch: ask `own.sample` for as many "
                "as you need, each time, with `rng`."
            )
        if not apart:
            return (
                "The demonstrations of your batches depend on each other: draw each row for itself, at random and with "
                "replacement, so that a row may come twice."
            )
        if not even:
            return "You draw some demonstrations more often than others: each row has the same chance."
        if not same:
            return "Two equal generators give different batches: draw with `rng`, so that a training can be repeated."
    return "Your batches are not drawn as they should be."


@exercise(
    "a share β of a batch are demonstrations, with r + c, Section IV-B",
    minutes=10, difficulty=2, cases=batch_cases, run=mixed_many_times, explain=of_the_batches,
    worked=[
        # half of four rows are demonstrations, paid 2 more
        ((numbered(0, 50), 4, 0.5, 2.0), (np.array([4, 8, 4]), 2.0, 1.0, 2.0, 2.0, 0.0, 0.0, *[1.0] * 6)),
    ],
    hints=(
        "How many rows come from the demonstrations? Draw that many row numbers with `rng.integers`, and index.",
        "Indexing with a tensor of row numbers makes a copy, so `theirs[:, REWARD] += bonus` leaves the table alone.",
    ),
    mistakes={
        ("theirs[:, REWARD] += bonus ->", "return rows, -> rows[:, REWARD] += bonus; return rows,"):
            "You add the bonus to every reward, even where the agent stays behind the trap: only demonstrations get "
            "it.",
        "+= bonus -> -= bonus":
            "Your bonus is subtracted: the critic would learn to avoid what the rule did.",
        ("theirs[:, REWARD] += bonus ->", "return rows, -> rows[n:, REWARD] += bonus; return rows,"):
            "Your bonus goes to the agent's own driving. It belongs to the rows of the *demonstrations*.",
        "theirs[:, REWARD] += bonus ->":
            "You pay no bonus: add it to the reward of each demonstration, in the column `REWARD`.",
        "< n -> >= n":
            "Your marks are the wrong way round: 1 says that a row is a demonstration.",
        "round(beta * size) -> size - round(beta * size)":
            "You swapped the shares: β is the share of the demonstrations.",
        "round -> int":
            "Your number of demonstrations is cut off, not rounded: use `round(beta * size)`.",
        "rng.integers(len(demonstrations), size=n) -> np.arange(n)":
            "You always take the same demonstrations. Draw them at random, with `rng`.",
    },
)  # fmt: skip
def mixed_batch(own, demonstrations, size, beta, bonus, rng):
    n = round(beta * size)
    theirs = demonstrations[torch.from_numpy(rng.integers(len(demonstrations), size=n))]
    theirs[:, REWARD] += bonus
    rows = torch.cat([theirs, own.sample(size - n, rng)])
    return rows, (torch.arange(size) < n).float()
