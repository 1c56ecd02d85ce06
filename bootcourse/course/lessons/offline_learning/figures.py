"""The figure of the lesson on offline learning: how far each agent is from the planner's bound."""

from collections.abc import Mapping, Sequence

import numpy as np
from matplotlib.figure import Figure

from bootcourse.methods import display_name, style
from bootcourse.plots.figure import INK, QUIET, TEXT, finish, new_figure, plain_axes
from bootcourse.research.results import Results


def shares_of_the_bound(
    results: Results, methods: Sequence[str], bound: np.ndarray, marks: Mapping[str, float], title: str
) -> Figure:
    """A dot for each agent at its share of the bound (%), a row for each method.

    bound: the planner's return on each test road. marks: {driver: share}, vertical lines.
    """
    height = 1.35 + 0.45 * len(methods)
    figure, alt_parts = new_figure(height), []
    ax = figure.add_axes((0.22, 0.5 / height, 0.74, 0.45 * len(methods) / height))
    for row, method in enumerate(methods):
        shares = 100 * np.sort(results.of(method).scores("returns")) / bound.mean()
        ax.plot(shares, row + np.linspace(-0.28, 0.28, len(shares)), "o", color=style(method).colour, ms=5)
        alt_parts.append(f"{display_name(method)}: {', '.join(f'{share:.0f}' for share in shares)} %")
    for words, share in marks.items():
        ax.axvline(share, color=QUIET, linewidth=1, linestyle=(0, (2, 2)), zorder=1)
        ax.annotate(words, (share, 1.01), xycoords=("data", "axes fraction"), ha="center", va="bottom", fontsize=TEXT,
                    color=INK)  # fmt: skip
    plain_axes(ax, "", grid="")
    ax.set_yticks(range(len(methods)), [display_name(method) for method in methods])
    ax.tick_params(axis="y", labelcolor=INK, labelsize=TEXT)
    ax.set(xlim=(-12, 104), ylim=(len(methods) - 0.5, -0.5))
    ax.set_xlabel("share of the bound (%); dots: agents", fontsize=TEXT, color=INK)
    lines = ", ".join(f"{words} {share:.0f} %" for words, share in marks.items())
    return finish(figure, title, f"Shares of the bound. {'; '.join(alt_parts)}. Lines: {lines}.")
