"""What this lesson shows beside its exercises: policies to compare, what an actor learns."""

from collections.abc import Callable

import torch
from torch import Tensor

from bootcourse.learn import sac

POLICIES = {
    "sure of one of two": [1 - 1e-9, 1e-9],
    "two, 19 to 1": [0.95, 0.05],
    "two, 3 to 1": [0.75, 0.25],
    "two, even": [0.5, 0.5],
    "nine, even": [1 / 9] * 9,
}


def trained(in_loss: Callable[[Tensor], Tensor]) -> list[str]:
    """π(a₂), Q and V after 200 steps of an optimiser that may move both, from an even policy and Q = 1 and 3.

    in_loss: Q -> the Q of the loss. V is given twice: by Q as it is then, and by Q as it was at first.
    """
    logits, q, alpha = torch.zeros(1, 2, requires_grad=True), torch.tensor([[1.0, 3.0]]), torch.tensor([1.0])
    moved = q.clone().requires_grad_()
    optimiser = torch.optim.Adam([logits, moved], lr=0.05)
    for _ in range(200):
        loss = -sac.soft_value(sac.log_policy(logits), in_loss(moved), alpha).mean()
        optimiser.zero_grad()
        loss.backward()
        optimiser.step()
    log_pi = sac.log_policy(logits)
    worth = [sac.soft_value(log_pi, values, alpha).item() for values in (moved, q)]
    return [f"{number:.2f}" for number in (log_pi[0, 1].exp().item(), *moved[0].tolist(), *worth)]
