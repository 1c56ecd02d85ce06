"""What the lesson on demonstrations shows of a bonus in four learners, and of the margin in one state."""

from collections.abc import Sequence

import numpy as np
import torch
from matplotlib.figure import Figure

from bootcourse.learn.bootstrap import large_margin_loss
from bootcourse.methods import style
from bootcourse.plots.figure import INK, QUIET, SMALL, TEXT, axes_at, finish, new_figure, one_axes, plain_axes
from bootcourse.scenario import ACTION_NAMES


def margin_example(q: Sequence[float], expert: int) -> tuple[float, list[float]]:
    """The margin loss of one state with these Q, and its gradient in each of them. expert: the demonstrated action."""
    values = torch.tensor([q], requires_grad=True)
    loss = large_margin_loss(values, torch.tensor([expert])).sum()
    return loss.item(), torch.autograd.grad(loss, values)[0][0].tolist()


def margin_bars(q: Sequence[float], expert: int, margin: float = 1.0) -> Figure:
    """The Q of the nine actions, (9,), with the margin on all but the expert's, whose bar is coloured."""
    q, others = np.asarray(q), np.arange(len(ACTION_NAMES)) != expert
    short = q.max() - q[expert]
    title = f"The expert's action is {short:.1f} short of the largest Q: the printed filter is off"
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
    ax.annotate("expert", (expert, q[expert] / 2), ha="center", va="center", fontsize=SMALL, color=INK)
    ax.set_xticks(at, [action.replace(" ", "\n") for action in ACTION_NAMES], fontsize=SMALL)
    ax.set(xlim=(-0.5, len(q) - 0.5), ylim=(0, 1.12 * (q + margin * others).max()))
    named = ", ".join(f"{action} {value:.1f}" for action, value in zip(ACTION_NAMES, q, strict=True))
    alt = (
        f"Bars of Q: {named}. The expert's is {ACTION_NAMES[expert]}; all others have the margin of {margin:g} on top."
    )
    return finish(figure, title, alt)


def with_and_without_bonus(
    updates: Sequence[int], lead: np.ndarray, largest: np.ndarray, success: np.ndarray
) -> Figure:
    """What c = 2 changes in the critics and on the road, each (4, times): two learners with it, then two without.

    lead: of the demonstrated action's Q over the others' mean. largest: % of states. success: % of the last episodes.
    """
    with_it, without = (" and ".join(f"{each:.0f}" for each in pair) for pair in (largest[:2, -1], largest[2:, -1]))
    title = f"At the end the demonstrated action has the largest Q in {with_it} % of the states, without a bonus in "
    title += without
    figure, bonus, control = new_figure(3.0), style("demos").colour, QUIET
    parts = {"lead over the others' mean, in Q": lead, "largest Q, % of states": largest}
    parts |= {"success in training, %": success}
    alts = []
    for i, (label, values) in enumerate(parts.items()):
        ax = axes_at(figure, 0.35 + 2.3 * i, 1.05, 1.9, 1.4)
        plain_axes(ax, label)
        ax.plot(updates, values[2:].T, color=control, linewidth=1.2, linestyle="--")
        ax.plot(updates, values[:2].T, color=bonus, linewidth=1.2)
        ax.set(xlim=(0, max(updates)), ylim=(0, 100) if i else None)
        ax.xaxis.set_major_formatter("{x:,.0f}")
        ax.locator_params(axis="x", nbins=4)
        ax.set_xlabel("update", fontsize=TEXT, color=INK)
        ends = [" and ".join(f"{each:.3g}" for each in pair) for pair in (values[:2, -1], values[2:, -1])]
        alts.append(f"{label}, at the end: {ends[0]} with c = 2, {ends[1]} with c = 0.")
    for x, words, colour in ((0.35, "c = 2", bonus), (0.9, "c = 0, dashed", control)):
        figure.text(x / 7, 1 - 0.68 / 3.0, words, color=colour, fontsize=TEXT, fontweight="bold")
    return finish(figure, title, " ".join(alts))
