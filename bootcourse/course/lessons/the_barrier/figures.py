"""A figure of the barrier: what attempts to leave are worth."""

from collections.abc import Mapping

import numpy as np
from matplotlib.figure import Figure

from bootcourse.course.lessons.the_barrier.attempts import Outcome
from bootcourse.methods import style
from bootcourse.plots.figure import INK, QUIET, SMALL, TEXT, axes_at, finish, new_figure, plain_axes


def worth(outcomes: Mapping[str, Outcome], title: str) -> Figure:
    """What each kind of attempt is worth at two discounts, beside the line of the one that "stays"; its accidents."""
    kinds = [name for name in outcomes if name != "stays"]
    height, top = 0.3 * len(kinds), 1.0
    figure, listed = new_figure(top + height + 0.62), []
    for k, gamma in enumerate((0.8, 0.95)):
        ax = axes_at(figure, 2.2 + 2.05 * k, top, 1.85, height)
        plain_axes(ax, "", grid="x")
        values = [outcomes[name].values(gamma).mean() for name in kinds]
        stays = outcomes["stays"].values(gamma).mean()
        ax.axvline(stays, color=INK, linewidth=1.2, linestyle=(0, (4, 2)))
        ax.text(stays, -0.75, f"stays: {stays:.2f}", fontsize=TEXT, color=INK, ha="center", va="bottom")
        for row, (name, value) in enumerate(zip(kinds, values, strict=True)):
            ax.plot(value, row, "o", color=style("rule").colour if "rule" in name else QUIET, markersize=6)
            side, align = (-7, "right") if value < stays else (7, "left")
            look = {"ha": align, "va": "center", "fontsize": TEXT, "color": INK, "textcoords": "offset points"}
            ax.annotate(f"{value:.2f}".replace("-", "−"), (value, row), xytext=(side, 0), **look)
        ax.set_yticks(range(len(kinds)), kinds if k == 0 else [""] * len(kinds))
        ax.tick_params(axis="y", labelcolor=INK, labelsize=TEXT)
        ax.set_ylim(len(kinds) - 0.5, -0.6)
        room = np.ptp([stays, *values])
        ax.set_xlim(min(stays, *values) - 0.5 * room, max(stays, *values) + 0.4 * room)
        ax.set_xlabel(f"worth at γ = {gamma}", fontsize=TEXT, color=INK)
        listed.append(f"At γ = {gamma} staying is worth {stays:.2f}")
        listed += [f"{name}: {value:.2f}" for name, value in zip(kinds, values, strict=True)]
    shares = [f"{100 * outcomes[name].accident.mean():.0f} %" for name in kinds]
    for row, words in enumerate(["accidents", *shares]):
        high = 1 - (top + 0.3 * (row - 0.45) - 0.02 * (row == 0)) / figure.get_figheight()
        figure.text(0.985, high, words, fontsize=TEXT, color=INK, ha="right", va="center")
    words = f"Worth: the discounted sum of the rewards from the start, mean of {len(outcomes['stays'].ahead)} roads."
    figure.text(0.012, 0.06 / figure.get_figheight(), words, fontsize=SMALL, color=QUIET)
    return finish(figure, title, f"{'; '.join(listed)}. Accidents, in this order: {', '.join(shares)}.")
