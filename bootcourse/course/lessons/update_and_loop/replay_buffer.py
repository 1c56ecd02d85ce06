"""The exercise in which a replay buffer is written."""

import functools
import time

import numpy as np
import torch

from bootcourse.course.drawing import drawn_apart, drawn_evenly, in_float32, independent
from bootcourse.course.exercise import NotAsAsked, exercise
from bootcourse.course.values import NUMERIC, plain, shape_words

# Of each row that a buffer should hold. In all cases together some 250 counts are compared with chance, each of which a
# right buffer fails with a probability of 2 in 10⁹: fewer than 1 of 10⁶ right buffers are refused.
DRAWS = 300
COPIES = (
    "Your buffer is right but slow: it copies all its rows to add one or to draw one, and training does both thousands "
    "of times. Overwrite one row of a list or of a table, and pick the drawn rows only."
)
TOGETHER = (
    "The rows that you draw depend on each other: they are neighbours, one row again and again, or one pass through "
    "the table. Draw each row for itself, and keep nothing from call to call."
)
AGAIN = "Your buffer gives the same batch at each call: draw anew each time, with the generator `rng` of that call."
EMPTIED = "Your buffer loses rows when you draw from it: `sample` must leave the rows where they are."
ONCE = "Your buffer draws without replacement. Each draw is made from all rows: a row may come twice in a batch."


def filled_and_drawn(answer, size, added, batch):
    """What a buffer gives back after the rows 1, 2, ... `added` were put in.

    Returns the shape of a batch; the rows that are ever drawn, as in "2 3"; whether each is drawn about equally often;
    whether they come back unchanged; whether two equal generators give the same batch; whether the rows of a batch are
    independent of each other; whether a row comes twice in some batch; whether batches differ; whether rows that are
    drawn stay in the buffer; whether it draws from all of many rows, and none that has been overwritten; whether adding
    and drawing leave the table where it is (all 1 or 0).
    """
    buffer = answer(size)
    if not (hasattr(buffer, "add") and hasattr(buffer, "sample")):
        return buffer
    rows = torch.arange(1.0, added + 1)[:, None] * torch.tensor([1.0, 0.5, -2.0])  # (added, 3)
    for row in rows:
        buffer.add(row.clone())
    try:
        first, again = (buffer.sample(batch, np.random.default_rng(1)) for _ in range(2))
    except ValueError as error:
        if "larger" in str(error):  # than the number of rows, as NumPy and Python say it
            raise NotAsAsked(ONCE) from None
        raise
    if first is None:
        raise NotImplementedError  # the stub: in a notebook its source, a class's, cannot be looked up
    if not isinstance(first, torch.Tensor) or first.dim() != 2 or first.shape[1] != 3:
        answered = plain(first)
        shape = f" of shape {shape_words(answered)}" if answered.kind in NUMERIC else ""
        raise NotAsAsked(f"Your `sample` returns {answered.words}{shape}: the exercise asks for a tensor (batch, n).")
    in_float32(first)
    rng, held = np.random.default_rng(0), min(size, added)
    drawn = torch.stack([buffer.sample(batch, rng) for _ in range(DRAWS * held // batch + 1)])  # (times, batch, 3)
    number = drawn[..., 0].long().clamp(0, added)
    known = number > 0
    intact = torch.equal(drawn[known], rows[number[known] - 1])
    known_rows, same = " ".join(map(str, number.unique().tolist())), torch.equal(first, again)
    twice = bool((number.sort().values.diff() == 0).any())
    differ = bool((number != number[0]).any()) or len(number[0].unique()) == 1  # one row again and again: not apart
    late = number[len(number) // 2 :]  # 150 draws of each row, or more: no row is missing by chance
    seen = torch.cat([first[:, 0], drawn[..., 0].flatten()])
    stay = torch.equal(late.unique(), seen.long().clamp(0, added).unique())
    even = drawn_evenly(number, held)
    # draws that are uneven, or never twice the same, are not independent either: those have their own sentences
    apart = independent(number, held) or (drawn_apart(number, held) and not (even and twice))
    copies = copies_the_table(answer)
    from_all = copies or draws_from_all_of_many(answer)  # one that copies would take seconds for many rows
    judged = even, intact, same, apart, twice, differ, stay, from_all, forgets_what_is_overwritten(answer), not copies
    return np.array(first.shape), known_rows, *map(float, judged)


@functools.cache
def draws_from_all_of_many(answer) -> bool:
    """Do 300 draws of 3,000 rows reach the first and the last quarter? A right buffer misses one in 10³⁷ times."""
    buffer, rng = answer(4000), np.random.default_rng(0)
    for number in range(3000):
        buffer.add(torch.full((3,), float(number)))
    numbers = torch.cat([buffer.sample(100, rng)[:, 0] for _ in range(3)])
    return bool(numbers.min() < 750 and numbers.max() >= 2250)


@functools.cache
def forgets_what_is_overwritten(answer) -> bool:
    """Does a full buffer that has been drawn from give new rows alone, once all its rows are overwritten?"""
    buffer, rng = answer(4), np.random.default_rng(0)
    for number in range(8):
        buffer.add(torch.full((3,), float(number)))
        drawn = buffer.sample(20, rng)[:, 0]
    return bool(drawn.min() >= 4)


@functools.cache
def copies_the_table(answer) -> bool:
    """Does adding or drawing one row take about as long as copying all of them? Measured with a few large rows."""
    size, row = 64, torch.arange(20_000.0)
    table = row.repeat(size, 1)

    def shortest(act):
        """The least computing time of some calls; waiting for a busy processor does not count."""
        times = []
        for _ in range(6):
            start = time.thread_time()
            act()
            times.append(time.thread_time() - start)
        return min(times)

    buffer, rng = answer(size), np.random.default_rng(0)
    for _ in range(size):
        buffer.add(row.clone())

    def slow() -> bool:
        longest = max(shortest(lambda: buffer.add(row.clone())), shortest(lambda: buffer.sample(1, rng)))
        return longest > shortest(table.clone) / 3

    threads = torch.get_num_threads()
    torch.set_num_threads(1)  # the time of others would not count
    try:
        return all(slow() for _ in range(3))  # on a busy processor a single measurement can be wrong
    finally:
        torch.set_num_threads(threads)


def buffer_cases(rng):
    """Half full, just full, one more than full, overwritten twice, more rows than are drawn; then 16 at random."""
    yield from ((6, 3, 8), (6, 6, 8), (6, 7, 8), (5, 13, 8), (8, 8, 4))
    for _ in range(16):
        size = rng.integers(3, 9)
        yield size, rng.integers(3, 3 * size), rng.integers(2, 33)


def of_the_buffer(cases, answers):
    """A sentence on a buffer that gives back the wrong rows."""
    same_batch = [not answer[7].data for answer in answers]
    for (size, added, batch), answer in zip(cases, answers, strict=True):
        shape, known_rows, even, intact, same, apart, twice, differ, stay, far, new, _ = (part.data for part in answer)
        if shape[0] != batch:
            return f"A batch of {batch} rows was asked for, and your buffer gave {shape[0]:.0f}."
        if not differ and sum(same_batch) > len(same_batch) / 2:  # not by chance in a small one
            return AGAIN
        if not stay:
            return EMPTIED
        if known_rows != " ".join(map(str, range(max(added - size, 0) + 1, added + 1))):
            return f"A buffer of size {size} got the rows 1 to {added}; yours then gives back the rows {known_rows}."
        if not intact:
            return "Your buffer gives back rows that nobody put in: look for a row that is overwritten or mixed up."
        if not same:
            return "Two equal generators give different batches: draw with `rng`, so that a training can be repeated."
        if not apart:
            return TOGETHER
        if not twice:
            return ONCE
        if not even:
            return "Your buffer draws some rows more often than others: each row has the same chance."
        if not far:
            return "Of 3,000 rows your buffer draws a part only: each row has the same chance, however many there are."
        if not new:
            return "Your buffer gives back rows that have been overwritten since it was last drawn from."
    return COPIES


@exercise(
    "the last D transitions, of which N are drawn, Table of RL hyper-parameters",
    minutes=4, difficulty=1, cases=buffer_cases, run=filled_and_drawn, explain=of_the_buffer,
    worked=[
        ((2, 3, 4), (np.array([4, 3]), "2 3", *[1.0] * 10)),  # the oldest of three rows is gone
    ],
    hints=(
        "First draw the places of the rows: `batch` whole numbers below `len(self.rows)`, with `rng`.",
        "`rng.integers(n, size=batch)` draws them with replacement; `torch.stack` makes one tensor of a list of rows.",
    ),
    mistakes={
        "len(self.rows) < self.size -> True":
            "Your buffer keeps every row. Once it holds `size` rows, the oldest one has to go for each new one.",
        "self.rows[self.next] = row -> pass":
            "Your full buffer ignores new rows: the agent would learn from its first policy for ever.",
        "self.rows[self.next] = row -> self.rows[-1] = row":
            "Your full buffer throws out the wrong row: a new row replaces the *oldest* one.",
        "% self.size -> % self.size; self.rows = [each.clone() for each in self.rows]": COPIES,
        "rng.integers(len(self.rows), -> rng.integers(max(len(self.rows) - 1, 1),":
            "One row is never drawn: `rng.integers(n)` already stops at n - 1.",
        "return torch.stack([self.rows[self.next - 1]] * batch)":
            "You always give the newest row. Draw each row of the batch at random from all rows.",
        "[], 0 -> [torch.zeros(3)] * size, 0":
            "You also draw places that nobody has written yet: draw among the rows that are filled.",
        "rng.integers(len(self.rows), size=batch) -> torch.randint(len(self.rows), (batch,))":
            "Two equal generators give different batches: draw with `rng`, so that a training can be repeated.",
        "rng.integers(len(self.rows), size=batch) -> "
        "rng.choice(len(self.rows), batch, replace=batch > len(self.rows))": ONCE,
    },
)  # fmt: skip
class ReplayBuffer:
    def __init__(self, size):
        """size: the most rows that it holds."""
        self.size, self.rows, self.next = size, [], 0

    def add(self, row):
        """Keep a row, a tensor (n,). A full buffer forgets its oldest row."""
        if len(self.rows) < self.size:
            self.rows.append(row)
        else:
            self.rows[self.next] = row
        self.next = (self.next + 1) % self.size

    def sample(self, batch, rng):
        """Rows drawn at random: (batch, n); stack only these. rng: a NumPy generator."""
        drawn = rng.integers(len(self.rows), size=batch)
        return torch.stack([self.rows[i] for i in drawn])
