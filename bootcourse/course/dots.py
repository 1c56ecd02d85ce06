"""Charts of rows of dots, a dot for each agent: filled, for instance, if it escapes; a bar for a mean or the truth."""

from collections.abc import Sequence

import numpy as np
from matplotlib.axes import Axes

from bootcourse.colours import INK
from bootcourse.plots.figure import SMALL, TEXT, plain_axes

COLUMN = 0.25  # of the width of the axes, from one cell beside a row to the next


def dots(
    ax: Axes,
    values: Sequence[float],
    place: float,
    colour: str,
    filled: Sequence[bool] | None = None,
    bar: float | None = None,
    spread: float = 0.28,
    size: float = 18,
) -> None:
    """Draw the values of a row, (agents,), the smallest on top, each within `spread` of the row's place.

    filled: which dots are, (agents,); without it all. bar: a value that is drawn as a thick upright line.
    """
    values = np.asarray(values, dtype=float)
    order, filled = np.argsort(values), np.ones(len(values), bool) if filled is None else np.asarray(filled)
    places = place + (np.linspace(-spread, spread, len(values)) if len(values) > 1 else np.zeros(1))
    fills = np.where(filled[order], colour, "white")
    look = {"s": size, "edgecolors": colour, "linewidths": 1.1, "zorder": 3, "clip_on": False}
    ax.scatter(values[order], places, c=fills, **look)
    if bar is not None:
        ax.plot([bar] * 2, [place - spread - 0.08, place + spread + 0.08], color=INK, linewidth=2, zorder=4)


def beside(ax: Axes, place: float, *cells: str, colour: str = INK) -> None:
    """Write cells to the right of a row, each column at its place."""
    for column, words in enumerate(cells):
        at = 1.04 + COLUMN * column, place
        ax.annotate(words, at, xycoords=("axes fraction", "data"), va="center", fontsize=SMALL, color=colour)


def name_rows(ax: Axes, names: Sequence[str], x_label: str, places: Sequence[float] | None = None) -> None:
    """Name the rows on the left, the first on top, and what the dots' places mean below."""
    plain_axes(ax, "", grid="x")
    ax.set_yticks(range(len(names)) if places is None else places, names)
    ax.tick_params(axis="y", labelcolor=INK, labelsize=TEXT)
    ax.set_ylim(len(names) - 0.5, -0.5)
    ax.set_xlabel(x_label, fontsize=SMALL, color=INK)
