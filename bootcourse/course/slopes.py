"""The slopes of a loss, which say what it trains: two losses of equal value can have different ones.

Slopes in log-probabilities are taken through their logits, as training takes them: only changes that keep the
probabilities' sum at 1 count, so that `log_pi`, `log_softmax(log_pi)` and `Categorical(logits=log_pi)` are the same.
"""

from collections.abc import Callable

import torch
from torch import Tensor

STEP = 1e-4  # slopes are taken this far from the case, where no two values tie and no maximum has a kink


def loss_and_slopes(places: list[int], logits: list[int], answer: Callable, *arguments):
    """(value, the slope of its sum in the argument at each of the places); None if the answer is None.

    logits: those places whose argument is a log-probability. A slope that autograd cannot give is a text, its error.
    """
    copies = [a.clone() if isinstance(a, Tensor) else a for a in arguments]
    value = answer(*arguments)
    if value is None:
        return None
    random = torch.Generator().manual_seed(0)
    leaves = {}
    for place in places:
        noise = torch.rand(copies[place].shape, generator=random, dtype=copies[place].dtype)
        leaves[place] = (copies[place] + STEP * noise).requires_grad_()
    for place, leaf in leaves.items():
        copies[place] = leaf.log_softmax(-1) if place in logits else leaf.clone()
    slopes = [torch.zeros_like(leaf) for leaf in leaves.values()]
    try:
        loss = answer(*copies)
        if isinstance(loss, Tensor) and loss.requires_grad:
            gradients = torch.autograd.grad(loss.sum(), list(leaves.values()), allow_unused=True)
            slopes = [zero if slope is None else slope for zero, slope in zip(slopes, gradients, strict=True)]
    except Exception as error:  # the value came without one: only autograd can have raised this
        return value, *[f"{type(error).__name__}: {error}" for _ in slopes]
    return value, *slopes
