"""How rows are drawn from a table: each with the same chance, and each for itself?"""

import torch

from bootcourse.course.exercise import NotAsAsked


def in_float32(rows: torch.Tensor) -> None:
    """Raises NotAsAsked for rows in another type: a network could not read them."""
    if rows.dtype != torch.float32:
        name = str(rows.dtype).removeprefix("torch.")
        raise NotAsAsked(f"Your rows are in {name}: keep them in float32, as they come, because the networks need it.")


def drawn_evenly(numbers: torch.Tensor, held: int) -> bool:
    """Are `held` numbers drawn, each about as often as chance would?

    A count may be off by 6 standard deviations, and by less than half: of 20 tables of a few rows, each drawn some 300
    times, a right answer fails in fewer than 1 of 10⁶ checks.
    """
    counts = numbers.unique(return_counts=True)[1]
    mean = numbers.numel() / held
    allowed = min(0.5 * mean, 6 * (mean * (1 - 1 / held)) ** 0.5)
    return len(counts) == held and bool(((counts - mean).abs() < allowed).all() or held == 1)


def independent(numbers: torch.Tensor, held: int) -> bool:
    """Are these rows drawn each for itself, from `held` rows, in whatever order? numbers: (times, batch).

    Counted are the pairs of rows, within a batch and between a batch and the next, that lie a given number of places
    apart, in a circle. They are compared with what the rows' own shares make of independent draws: then all pairs are
    independent, two by two, so a count has the variance of a binomial one. It may be off by 6 standard deviations: a
    right answer fails in fewer than 1 of 10⁷ checks.
    """
    places, shares = torch.arange(numbers.shape[1]), torch.bincount(numbers.flatten().long() % held, minlength=held)
    shares = shares / numbers.numel()
    within = (numbers[:, :, None] - numbers[:, None, :])[:, places[:, None] < places]
    between = numbers[1:, :, None] - numbers[:-1, None, :]
    for steps in (within.flatten().long() % held, between.flatten().long() % held):
        apart = torch.minimum(steps, held - steps)
        counts = torch.bincount(apart, minlength=held // 2 + 1)
        share = torch.stack([(shares * shares.roll(k)).sum() * (1 if 2 * k in (0, held) else 2)
                             for k in range(held // 2 + 1)])  # fmt: skip
        deviation = (len(steps) * share * (1 - share)).sqrt()
        if bool(((counts - len(steps) * share).abs() > 6 * deviation).any()):
            return False
    return True


def drawn_apart(numbers: torch.Tensor, held: int) -> bool:
    """Are the rows of a batch independent, neither one row again and again nor neighbours? numbers: (times, batch)."""
    steps = (numbers[:, 1:] - numbers[:, :-1]).flatten()
    by_chance = {0: 1 / held, 1: (held - 1) / held**2}  # the chance of such a step between two rows
    return all(float((steps == step).sum()) <= (1 + chance) / 2 * len(steps) for step, chance in by_chance.items())
