"""Figures of the lesson on finding and keeping: each agent's success while it trains."""

from collections.abc import Mapping, Sequence

import numpy as np
from matplotlib.figure import Figure
from matplotlib.ticker import FixedLocator, NullLocator

from bootcourse.learn.bootstrap import demonstration_share
from bootcourse.methods import display_name, style
from bootcourse.plots.figure import INK, QUIET, SMALL, TEXT, finish, new_figure, one_axes, plain_axes
from bootcourse.plots.training_curves import WINDOW
from bootcourse.research.clocks import UPDATES
from bootcourse.research.results import WINDOW as IN_A_ROW
from bootcourse.research.results import Results
from bootcourse.statistics import rolling_means

PANEL, GAP = 1.15, 0.5  # inches: the height of a panel, and between two
LEAST = 3e-8  # the lowest part of ξ that is drawn


def seed_by_seed(results: Results, methods: Sequence[str], title: str, mark: int, words: str) -> Figure:
    """Success in training, a panel for each method: a thin line for each agent, a thick one for their mean.

    mark: the episode of a vertical line, and the words at it.
    """
    height = 1.15 + len(methods) * (PANEL + GAP)
    figure, alt_parts = new_figure(height), []
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
        alt_parts.append(f"{display_name(method)}: " + ", ".join(f"{mean[i]:.0f} % at episode {at[i]}" for i in near))
    ax.set_xlabel("training episode", fontsize=TEXT, color=INK)
    each = f"Success in the last {WINDOW} episodes (%). Thin: agents. Thick: their mean"
    figure.text(0.012, 0.1 / height, f"{each}.", fontsize=SMALL, color=QUIET)
    return finish(figure, title, f"{each}: {'; '.join(alt_parts)}.")


def fading(cells: Mapping[tuple[str, str], Results]) -> Figure:
    """ξ over training with each number of updates, β, and a dot where half of the agents have found the way out.

    cells: `clocks.cells`. All are parts of their start, on logarithmic axes; agents with the soft constraint alone.
    """
    title = "With more updates ξ is almost gone when the way out is found; β is not"
    words = "training episode; dot: half of the agents with the soft constraint alone have found the way out"
    figure, ax = one_axes(3.8, title, words, "part of its start, median agent; ξ, 2: two updates for a decision")
    alt_parts, colour = [], style("soft").colour
    for updates in UPDATES:
        agents = cells[updates, "π̃"].of("soft")
        part = np.median(agents.curves["xi"] / agents.curves["xi"][:, :1], axis=0)
        episodes, half, tenth = np.arange(1, len(part) + 1), half_found(agents), int(np.argmax(part < 0.1))
        ax.plot(episodes, np.where(part > LEAST, part, np.nan), color=colour, linewidth=2)
        ax.plot(half, part[half - 1], "o", color=colour, mec=INK, ms=8, zorder=4)
        ax.annotate(
            f"ξ, {updates}", (half, part[half - 1]), (7, 4), textcoords="offset points", fontsize=TEXT, color=INK
        )
        words = f"ξ with {updates} updates is a tenth after {tenth} episodes, and half have the way out after {half}"
        alt_parts.append(f"{words}, at {part[half - 1]:.2g} of ξ")
    demos = cells["1/4", "π̃"].of("demos").agents[0]
    share = demonstration_share(episodes, demos["beta_start"], demos["beta_episodes"]) / demos["beta_start"]
    ax.plot(episodes, np.where(share > 0, share, np.nan), color=style("demos").colour, linewidth=2)
    ax.annotate("β", (demos["beta_episodes"], 0.02), (5, 0), textcoords="offset points", fontsize=TEXT, color=INK)
    ax.set(xscale="log", yscale="log", xlim=(20, len(part)), ylim=(LEAST, 1.5))
    for axis, places in ((ax.xaxis, [20, 50, 100, 200, 500, 1000]), (ax.yaxis, [1, 1e-2, 1e-4, 1e-6])):
        axis.set_major_locator(FixedLocator(places))
        axis.set_major_formatter("{x:g}")
        axis.set_minor_locator(NullLocator())
    return finish(figure, title, ". ".join(alt_parts) + ".")


def half_found(agents: Results) -> int:
    """The episode by which half of the agents have found the way out."""
    windows = np.lib.stride_tricks.sliding_window_view(agents.curves["success"], IN_A_ROW, axis=1).mean(-1) > 0.5
    ends = np.where(windows.any(1), windows.argmax(1) + IN_A_ROW, agents.curves["success"].shape[1])
    return int(np.sort(ends)[(len(ends) - 1) // 2])
