"""Small networks for many agents at once: every parameter has a leading agents axis.

On networks this small, calling a library costs more than the arithmetic. One batched matrix product
for all agents costs little more than one agent's.
"""

from collections.abc import Sequence

import torch
from torch import Tensor


def init_mlp(sizes: Sequence[int], generators: Sequence[torch.Generator]) -> list[Tensor]:
    """Weights and biases, drawn for each agent from its own generator.

    sizes: (inputs, hidden ..., outputs) -> [(agents, inputs, hidden), (agents, 1, hidden), ...].
    Uniform within ±1/√inputs, torch's default for a linear layer.
    """
    parameters = []
    for n_in, n_out in zip(sizes, sizes[1:], strict=False):
        for rows in (n_in, 1):
            draws = [torch.rand(rows, n_out, generator=generator) for generator in generators]
            parameters.append((torch.stack(draws) * 2 - 1) / n_in**0.5)
    return parameters


def mlp(parameters: Sequence[Tensor], x: Tensor) -> Tensor:
    """(agents, batch, inputs) -> (agents, batch, outputs), ReLU between the layers."""
    for weight, bias in zip(parameters[:-2:2], parameters[1:-2:2], strict=True):
        x = torch.baddbmm(bias, x, weight).relu_()
    return torch.baddbmm(parameters[-1], x, parameters[-2])
