"""PPO's clipped loss of one decision against its ratio."""

from collections.abc import Callable

import numpy as np
import torch
from matplotlib.figure import Figure
from torch import Tensor

from bootcourse.methods import style
from bootcourse.plots.figure import INK, QUIET, SMALL, TEXT, axes_at, finish, new_figure, plain_axes

RATIOS = np.linspace(0.3, 1.7, 141)
POINTS = (0.5, 1.5)  # where a dot says what the gradient does


def hinges(clipped_loss: Callable[[Tensor, Tensor, float], Tensor], clip: float, title: str) -> Figure:
    """Two panels, for a decision that turned out well (A = 2) and one that turned out badly (A = −2)."""
    figure, colour, alt_parts = new_figure(3.5), style("ppo").colour, []
    for left, advantage in zip((0.5, 4.0), (2.0, -2.0), strict=True):
        ax = axes_at(figure, left, 1.0, 2.85, 1.9)
        losses = [clipped_loss(torch.tensor([r]), torch.tensor([advantage]), clip).item() for r in RATIOS]
        ax.plot(RATIOS, losses, color=colour, linewidth=2.2)
        for edge in (1 - clip, 1 + clip):
            ax.axvline(edge, color=QUIET, linewidth=1, linestyle=(0, (2, 2)), zorder=1)
        for ratio in POINTS:
            leaf = torch.tensor([ratio], requires_grad=True)
            loss = clipped_loss(leaf, torch.tensor([advantage]), clip)
            slope, height = torch.autograd.grad(loss.sum(), leaf)[0].item(), loss.item()
            words = "stays" if slope == 0 else "gets rarer" if slope > 0 else "gets likelier"
            ax.scatter([ratio], [height], color=colour, s=40, zorder=3)
            side = {"stays": "center", "gets likelier": "right", "gets rarer": "left"}[words]
            away = (0, 9 if words == "stays" else -16)
            ax.annotate(words, (ratio, height), away, textcoords="offset points", ha=side, fontsize=SMALL, color=INK)
            alt_parts.append(f"A = {advantage:g}, ρ = {ratio:g}: the action {words}")
        plain_axes(ax, f"loss of a decision, A = {advantage:g}".replace("-", "−"))
        ax.set_xlabel("ratio ρ (above 1: the action is likelier now)", fontsize=TEXT, color=INK)
        ax.margins(y=0.2)
    return finish(figure, title, f"The loss against the ratio. {'; '.join(alt_parts)}.")
