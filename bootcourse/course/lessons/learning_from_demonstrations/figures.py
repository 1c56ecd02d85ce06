"""What the lesson on demonstrations shows of the margin in one state."""

from collections.abc import Sequence

import numpy as np
import torch
from matplotlib.figure import Figure

from bootcourse.learn.bootstrap import large_margin_loss
from bootcourse.methods import style
from bootcourse.plots.figure import INK, QUIET, SMALL, TEXT, finish, one_axes
from bootcourse.scenario import ACTION_NAMES


def margin_example(q: Sequence[float], expert: int) -> tuple[float, list[float]]:
    """The margin loss of one state with these Q, and its gradient in each of them. expert: the demonstrated action."""
    values = torch.tensor([q], requires_grad=True)
    loss = large_margin_loss(values, torch.tensor([expert])).sum()
    return loss.item(), torch.autograd.grad(loss, values)[0][0].tolist()


def margin_bars(q: Sequence[float], expert: int, margin: float = 1.0) -> Figure:
    """The Q of the nine actions, (9,), with the margin on all but the demonstrated one, whose bar is coloured."""
    q, others = np.asarray(q), np.arange(len(ACTION_NAMES)) != expert
    short = q.max() - q[expert]
    title = f"The demonstrated action is {short:.1f} short of the largest Q: the printed filter is off"
    figure, ax = one_axes(3.5, title, "", "Q", width=0.78)
    at, colour = np.arange(len(q)), style("demos").colour
    ax.bar(at, q, width=0.7, color=np.where(others, "#B8BEC6", colour))
    ax.bar(at[others], margin, width=0.7, bottom=q[others], color="none", edgecolor=QUIET, linestyle=(0, (2, 2)))
    for x, value in zip(at, q, strict=True):
        ax.annotate(f"{value:.1f}", (x, value + 0.03), ha="center", va="bottom", fontsize=SMALL, color=INK)
    for height, words in ((q.max(), "largest Q"), ((q + margin * others).max(), "largest Q\n+ margin")):
        ax.axhline(height, color=QUIET, linewidth=1, linestyle=(0, (1, 2)), zorder=0)
        end = (len(q) - 0.5, height)
        ax.annotate(words, end, (6, 0), textcoords="offset points", va="center", fontsize=TEXT, color=INK)
    ax.annotate("shown", (expert, q[expert] / 2), ha="center", va="center", fontsize=SMALL, color=INK)
    ax.set_xticks(at, [action.replace(" ", "\n") for action in ACTION_NAMES], fontsize=SMALL)
    ax.set(xlim=(-0.5, len(q) - 0.5), ylim=(0, 1.12 * (q + margin * others).max()))
    named = ", ".join(f"{action} {value:.1f}" for action, value in zip(ACTION_NAMES, q, strict=True))
    alt = f"Bars of Q: {named}. Demonstrated: {ACTION_NAMES[expert]}; all others have the margin of {margin:g} on top."
    return finish(figure, title, alt)
