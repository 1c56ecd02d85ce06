"""How rows are drawn from a table: each with the same chance, and each for itself?"""

import torch

from bootcourse.course.exercise import NotAsAsked


def in_float32(rows: torch.Tensor) -> None:
    """Raises NotAsAsked for rows in another type: a network could not read them."""
    if rows.dtype != torch.float32:
        name = str(rows.dtype).removeprefix("torch.")
        raise NotAsAsked(f"Your rows are in {name}: keep them in float32, as they come, because the networks need it.")


def drawn_evenly(numbers: torch.Tensor, held: int) -> bool:
    """Are `held` numbers drawn, each about as often as chance would?"""
    counts = numbers.unique(return_counts=True)[1]
    return len(counts) == held and bool(((counts * held / numbers.numel() - 1).abs() < 0.5).all())


def drawn_apart(numbers: torch.Tensor, held: int) -> bool:
    """Are the rows of a batch independent, neither one row again and again nor neighbours? numbers: (times, batch)."""
    steps = (numbers[:, 1:] - numbers[:, :-1]).flatten()
    by_chance = {0: 1 / held, 1: (held - 1) / held**2}  # the chance of such a step between two rows
    return all(float((steps == step).sum()) <= (1 + chance) / 2 * len(steps) for step, chance in by_chance.items())
