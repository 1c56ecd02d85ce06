"""Small networks of many agents: every parameter has a leading agents axis.

For networks this small, one batched matrix product for all agents takes little longer than one agent's.
"""

from collections.abc import Sequence

import torch
from torch import Tensor


def init_mlp(sizes: Sequence[int], generators: Sequence[torch.Generator]) -> list[Tensor]:
    """Weights and biases, uniform within ±1/√inputs (torch's default); one generator for each agent.

    sizes: (inputs, hidden ..., outputs) -> [(agents, inputs, hidden), (agents, 1, hidden), ...].
    """
    parameters = []
    for n_in, n_out in zip(sizes, sizes[1:], strict=False):
        for rows in (n_in, 1):
            draws = [torch.rand(rows, n_out, generator=generator, dtype=torch.float32) for generator in generators]
            parameters.append((torch.stack(draws) * 2 - 1) / n_in**0.5)
    return parameters


def mlp(parameters: Sequence[Tensor], x: Tensor) -> Tensor:
    """The network's outputs, with ReLU between the layers: (agents, batch, inputs) -> (agents, batch, outputs)."""
    for weight, bias in zip(parameters[:-2:2], parameters[1:-2:2], strict=True):
        x = torch.baddbmm(bias, x, weight).relu_()
    return torch.baddbmm(parameters[-1], x, parameters[-2])
