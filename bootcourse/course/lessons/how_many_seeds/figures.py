"""The figure of the lesson on seeds: each agent's success after training."""

from collections.abc import Sequence

import numpy as np
from matplotlib.figure import Figure

from bootcourse.methods import display_name, style
from bootcourse.plots.figure import INK, QUIET, SMALL, TEXT, finish, new_figure, plain_axes
from bootcourse.research.results import Results
from bootcourse.research.tables import escaped
from bootcourse.statistics import ESCAPES


def who_escapes(results: Results, methods: Sequence[str]) -> Figure:
    """Each agent's success on the held-out roads as a dot, one row for each method; filled if it escapes."""
    height = 1.15 + 0.5 * len(methods)
    figure, alt_parts = new_figure(height), []
    ax = figure.add_axes((0.24, 0.5 / height, 0.6, 1 - 1.1 / height))
    ax.axvline(100 * ESCAPES, color=QUIET, linewidth=1, linestyle=(0, (2, 2)), zorder=1)
    for row, method in enumerate(methods):
        success, colour = np.sort(100 * results.of(method).scores("success")), style(method).colour
        places = row + np.linspace(-0.3, 0.3, len(success))
        fills = [colour if each >= 100 * ESCAPES else "white" for each in success]
        ax.scatter(success, places, s=26, c=fills, edgecolors=colour, linewidths=1.2, zorder=3, clip_on=False)
        words = f"{escaped(results, method)} escape"
        ax.annotate(words, (1.04, row), xycoords=("axes fraction", "data"), va="center", fontsize=TEXT, color=INK)
        alt_parts.append(f"{display_name(method)}: {', '.join(f'{each:.0f}' for each in success)} %")
    plain_axes(ax, "", grid="x")
    ax.set_yticks(range(len(methods)), [display_name(method) for method in methods])
    ax.tick_params(axis="y", labelcolor=INK, labelsize=TEXT)
    ax.set(xlim=(-2, 102), ylim=(len(methods) - 0.5, -0.5))
    words = f"success of an agent on the held-out roads (%); filled: {100 * ESCAPES:.0f} % or more, it escapes"
    ax.set_xlabel(words, fontsize=SMALL, color=INK)
    everyone = np.concatenate([results.of(method).scores("success") for method in methods])
    split = int(((everyone > 0.9) | (everyone < 0.1)).sum())
    title = (
        f"Training works or fails: {split} of {len(everyone)} agents succeed on over 90 % of the roads or under 10 %"
    )
    return finish(figure, title, f"A dot for each agent. {'; '.join(alt_parts)}.")
