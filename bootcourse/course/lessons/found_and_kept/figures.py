"""Figures of the lesson on finding and keeping: each agent's success while it trains."""

from collections.abc import Sequence

import numpy as np
from matplotlib.figure import Figure

from bootcourse.methods import display_name, style
from bootcourse.plots.figure import INK, QUIET, SMALL, TEXT, finish, new_figure, plain_axes
from bootcourse.plots.training_curves import WINDOW
from bootcourse.research.results import Results
from bootcourse.statistics import rolling_means

PANEL, GAP = 1.15, 0.5  # inches: the height of a panel, and between two


def seed_by_seed(results: Results, methods: Sequence[str], title: str, mark: int, words: str) -> Figure:
    """Success in training, a panel for each method: a thin line for each agent, a thick one for their mean.

    mark: the episode of a vertical line, and the words at it.
    """
    height = 1.15 + len(methods) * (PANEL + GAP)
    figure, told = new_figure(height), []
    for row, method in enumerate(methods):
        bottom = height - 0.8 - row * (PANEL + GAP) - PANEL
        ax = figure.add_axes((0.06, bottom / height, 0.9, PANEL / height))
        at, success = rolling_means(100 * results.of(method).curves["success"], WINDOW)
        mean, colour = success.mean(axis=0), style(method).colour
        ax.plot(at, success.T, color=colour, linewidth=0.8, alpha=0.55)
        ax.plot(at, mean, color=colour, linewidth=2.6)
        ax.axvline(mark, color=QUIET, linewidth=1, linestyle=(0, (2, 2)), zorder=1)
        if row == 0:
            ax.annotate(words, (mark, 1.02), xycoords=("data", "axes fraction"), xytext=(5, 0), va="bottom",
                        textcoords="offset points", fontsize=SMALL, color=QUIET)  # fmt: skip
        plain_axes(ax, display_name(method))
        ax.set(xlim=(0, at[-1]), ylim=(-4, 104), yticks=(0, 50, 100))
        ax.tick_params(labelbottom=row == len(methods) - 1)
        near = np.searchsorted(at, [mark - 200, mark, at[-1]])
        told.append(f"{display_name(method)}: " + ", ".join(f"{mean[i]:.0f} % at episode {at[i]}" for i in near))
    ax.set_xlabel("training episode", fontsize=TEXT, color=INK)
    each = f"Success in the last {WINDOW} episodes (%). Thin: agents. Thick: their mean"
    figure.text(0.012, 0.1 / height, f"{each}.", fontsize=SMALL, color=QUIET)
    return finish(figure, title, f"{each}: {'; '.join(told)}.")
