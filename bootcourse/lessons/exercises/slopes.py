"""For exercises on a loss: its value is compared, and its slopes, which say what it trains."""

from collections.abc import Callable

import torch
from torch import Tensor


def with_slopes(*places: int) -> Callable:
    """The `run` of an exercise that compares (loss, its slope with respect to each argument at these places)."""
    return lambda answer, *arguments: loss_and_slopes(answer, arguments, places)


def loss_and_slopes(answer: Callable, arguments: tuple, of: tuple[int, ...]):
    """(loss, its slope with respect to the arguments at the places `of`).

    An answer that is not a loss (a text, a list) is returned unchanged, and so is the loss of an answer that
    writes into its arguments: the guard finds that.
    """
    before = [a.clone() if isinstance(a, Tensor) else a for a in arguments]
    loss = answer(*arguments)
    written = any(not torch.equal(a, b) for a, b in zip(arguments, before, strict=True) if isinstance(a, Tensor))
    if written or not isinstance(loss, (Tensor, int, float)):
        return loss
    leaves = [a.clone().requires_grad_() if place in of else a for place, a in enumerate(arguments)]
    loss = answer(*leaves)
    slopes = [torch.zeros_like(leaves[place]) for place in of]
    if isinstance(loss, Tensor) and loss.requires_grad:
        found = torch.autograd.grad(loss.sum(), [leaves[place] for place in of], allow_unused=True)
        slopes = [zero if slope is None else slope for zero, slope in zip(slopes, found, strict=True)]
    value = loss.detach() if isinstance(loss, Tensor) else torch.tensor(float(loss))
    return (value, *slopes)
