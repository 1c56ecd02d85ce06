"""For exercises that write a loss: what counts is its value *and* where it sends a gradient."""

from collections.abc import Callable

import torch
from torch import Tensor


def loss_and_slopes(answer: Callable, arguments: tuple, of: tuple[int, ...]):
    """(loss, its slope with respect to the arguments at the places `of`).

    What is not a loss of tensors (a text, a list) is handed back as it is, and so is the plain value where
    the answer writes into its arguments: the guard compares those.
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
