"""Many small panels of the same kind side by side: one for each agent, or for each teacher."""

import math
from collections.abc import Mapping, Sequence

import numpy as np
from matplotlib.figure import Figure
from matplotlib.ticker import MaxNLocator

from bootcourse.colours import OTHER
from bootcourse.plots.figure import INK, QUIET, SMALL, TEXT, WIDTH, finish, new_figure, plain_axes, wrapped

HEIGHT, GAP, LEFT, FOOT = 1.15, 0.42, 0.5, 0.5  # inches


def many(
    named: Mapping[str, tuple[Sequence[float], np.ndarray]],
    title: str,
    x_label: str,
    y_label: str,
    reference: str | None = None,
    columns: int = 3,
    limits: tuple[float, float] | None = None,
) -> Figure:
    """A panel for each name, {name: (x (points,), values (seeds, points))}: a line for each seed.

    reference: the name of one that has no panel of its own and is drawn in grey in every other panel. All
    panels share their axes; limits cuts the values' axis. The alt text gives where every line ends.
    """
    own = [name for name in named if name != reference]
    rows, title = math.ceil(len(own) / columns), wrapped(title)
    head = 0.82 + 0.2 * title.count("\n")
    total = head + rows * HEIGHT + (rows - 1) * GAP + FOOT
    width = (WIDTH - LEFT - 0.15 - 0.25 * (columns - 1)) / columns
    figure = new_figure(total)
    low, high = limits or _limits(named)
    last_x = max(x[-1] for x, _ in named.values())
    for k, label in enumerate(own):
        row, column = divmod(k, columns)
        left, bottom = LEFT + column * (width + 0.25), total - head - (row + 1) * HEIGHT - row * GAP
        ax = figure.add_axes((left / WIDTH, bottom / total, width / WIDTH, HEIGHT / total))
        if reference is not None:
            x, values = named[reference]
            ax.plot(x, values.T, color="#9AA5B1", linewidth=1.0, zorder=2)
        x, values = named[label]
        ax.plot(x, values.T, color=OTHER.colour, linewidth=1.3, zorder=3)
        plain_axes(ax, "")
        ax.text(0, 1.05, label, transform=ax.transAxes, fontsize=TEXT, color=INK, fontweight="bold", va="bottom")
        ax.set(xlim=(0, last_x), ylim=(low, high))
        ax.xaxis.set_major_locator(MaxNLocator(3 if columns < 5 else 2))
        if column:
            ax.tick_params(labelleft=False)
        if k + columns < len(own):
            ax.tick_params(labelbottom=False)
        else:
            ax.set_xlabel(x_label, fontsize=SMALL, color=QUIET)
    grey = f"; grey: {reference}" if reference is not None else ""
    words = f"{y_label}, a line for each seed{grey}"
    figure.text(0.012, 1 - (0.36 + 0.2 * title.count("\n")) / total, words, fontsize=TEXT, color=QUIET, va="top")
    return finish(figure, title, f"Small panels of {y_label} against {x_label}. {_told(named)}")


def _limits(named: Mapping) -> tuple[float, float]:
    everything = np.concatenate([np.ravel(values) for _, values in named.values()])
    low, high = np.nanmin(everything), np.nanmax(everything)
    room = 0.06 * (high - low) or 1.0
    return float(low - room), float(high + room)


def _told(named: Mapping) -> str:
    def last(row: np.ndarray) -> str:
        known = row[np.isfinite(row)]
        return f"{known[-1]:.3g}" if known.size else "unknown"

    return " ".join(f"{name} ends at {', '.join(map(last, values))}." for name, (_, values) in named.items())
