"""What this lesson shows beside its exercises: policies to compare, what an actor learns, how a thermostat turns."""

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
    """π and Q of two actions after 200 steps of an optimiser that may move both; in_loss: Q -> the Q of the loss."""
    logits, q = torch.zeros(1, 2, requires_grad=True), torch.tensor([[1.0, 3.0]], requires_grad=True)
    optimiser = torch.optim.Adam([logits, q], lr=0.05)
    for _ in range(200):
        loss = -sac.soft_value(sac.log_policy(logits), in_loss(q), torch.tensor(1.0)).mean()
        optimiser.zero_grad()
        loss.backward()
        optimiser.step()
    return [f"{number:.2f}" for number in (*logits.softmax(-1)[0].tolist(), *q[0].tolist())]


def turns(entropy: float, target_entropy: float) -> str:
    """What a step down the temperature's loss does to α: "falls" or "rises"."""
    log_alpha = torch.zeros((), requires_grad=True)
    loss = sac.temperature_loss(log_alpha, torch.tensor([entropy]), torch.tensor(target_entropy))
    return "falls" if torch.autograd.grad(loss, log_alpha)[0] > 0 else "rises"
