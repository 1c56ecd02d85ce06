"""Figures of the lesson on finding and keeping: one agent's success, who found and kept the way out, and how often
single agents drive as the paper's.
"""

from collections.abc import Mapping

import numpy as np
from matplotlib.figure import Figure

from bootcourse.course.charts import lines
from bootcourse.methods import display_name, style
from bootcourse.plots.figure import INK, QUIET, TEXT, axes_at, finish, new_figure, plain_axes
from bootcourse.research.cells import VARIED
from bootcourse.research.experiments import clocks
from bootcourse.research.results import Results
from bootcourse.statistics import IN_A_ROW, rolling_means

DRAWN_FROM = "2"  # the updates for a decision of the agents that the lesson shows


def one_agent(results: Results, which: int, title: str) -> Figure:
    """Training of one agent of one method: how often it is ahead, its first and last good window, and β's end."""
    success, end = results.curves["success"][which], results.agents[which]["beta_episodes"]
    at, (share,) = rolling_means(100 * success, IN_A_ROW, len(success))
    look = style(results.methods[0])._replace(line="-")
    words = f"% of the last {IN_A_ROW} episodes"
    figure = lines(at, {"ahead of trap 1": share}, title, "training episode", words, looks=[look])
    ax, good = figure.axes[0], np.flatnonzero(share > 50)
    ax.axvline(end, color=INK, linewidth=1.1, linestyle=(0, (4, 3)), zorder=1)
    ax.text(end + 25, 90, f"no demonstrations\nafter {end:,}", fontsize=TEXT, color=QUIET, va="center")
    for place, words, away, side in ((good[0], "found", (8, 9), "left"), (good[-1], "last had it", (-8, -9), "right")):
        ax.plot(at[place], share[place], "o", color=INK, ms=6, zorder=5)
        ax.annotate(
            f"{words}: {at[place]:,.0f}", (at[place], share[place]), away, ha=side, va="center",
            textcoords="offset points", fontsize=TEXT, color=INK, zorder=4,
            bbox={"facecolor": "white", "edgecolor": "none", "pad": 1},
        )  # fmt: skip
    figure.alt += (
        f" More than half of a window for the first time at {at[good[0]]:.0f}, the last at {at[good[-1]]:.0f}. A dashed"
        f" line at {end:,}: no demonstrations after it."
    )
    return figure


def found_and_kept(results: Results, printed: Mapping[str, float] | None = None) -> Figure:
    """A square for each agent, a row for each method, which has ten; beside it how many found the way out, and kept it.

    Filled: it found the way out and kept it; empty: found and did not keep it; a dot: never found it. printed: the
    paper's success of each method, %, for a last column.
    """
    left, top, tall, counted = 1.7, 0.85, 0.34, {}
    figure = new_figure(top + tall * len(VARIED) + 0.5)
    ax = axes_at(figure, left, top, 3.5, tall * len(VARIED))
    heads = {1.08: "found", 1.2: "kept"} | ({1.36: "the paper"} if printed else {})
    for x, head in heads.items():
        ax.text(x, 1.03, head, transform=ax.transAxes, ha="center", va="bottom", fontsize=TEXT, color=INK)
    for y, method in enumerate(VARIED):
        found, kept = (int(each.sum()) for each in results.found_and_kept(method))
        n, colour = len(results.of(method)), style(method).colour
        for first, after, fill in ((0, kept, colour), (kept, found, "white")):
            at = range(first, after)
            ax.plot(at, [y] * len(at), "s", ms=8.5, color=fill, mec=colour, mew=1.6)
        ax.plot(range(found, n), [y] * (n - found), "o", ms=2.5, color=QUIET)
        cells = [f"{found}", f"{kept}"] + ([f"{printed[method]:.0f} %"] if printed else [])
        for x, words in zip(heads, cells, strict=True):
            ax.text(x, y, words, transform=ax.get_yaxis_transform(), ha="center", va="center", fontsize=TEXT, color=INK)
        keep = "and keep it" if kept == found else f"{kept or 'none'} keep{'' if kept > 1 else 's'} it"
        counted[method] = f"{found} of {n} find the way out{' ' if kept == found else ', '}{keep}"
    ax.set(xlim=(-0.6, 9.6), ylim=(len(VARIED) - 0.5, -0.5), xticks=())
    ax.set_yticks(range(len(VARIED)), map(display_name, VARIED), fontsize=TEXT, color=INK)
    ax.tick_params(axis="y", length=0)
    for side in ax.spines.values():
        side.set_visible(False)
    key = "■ found and kept   □ found, not kept   · not found.   Each mark is an agent."
    figure.text(0.012, 0.14 / figure.get_figheight(), key, fontsize=TEXT, color=INK)
    paper = {method: f" (the paper: {rate:.0f} %)" for method, rate in (printed or {}).items()}
    alt = "; ".join(f"{display_name(method)}: {words}{paper.get(method, '')}" for method, words in counted.items())
    return finish(figure, f"With demonstrations alone {counted['demos']}", f"{alt}.")


def chances(cells: Mapping[str, Results], counted: Mapping[str, float]) -> Figure:
    """How often single agents read as the paper's four rows, in %, over the updates.

    counted: the chance of each of the settings `cells`, by the updates, drawn as a dot; the bar is the interval over
    seeds, see `clocks.pattern`.
    """
    updates, colour, at = list(cells), style("rule").colour, range(len(cells))
    figure = new_figure(3.7)
    ax = axes_at(figure, 0.5, 0.8, 5.2, 2.1)
    plain_axes(ax, "% of the draws with all four rates as the paper's; bar: 95 % over seeds")
    values = [100 * counted[each] for each in updates]
    bars = [[100 * part for part in clocks.pattern(cells[each])[1:]] for each in updates]
    ax.vlines(at, *np.transpose(bars), color=colour, linewidth=2, alpha=0.5)
    ax.plot(at, values, "o", ms=7, color=colour, zorder=3)
    for place, (each, value) in enumerate(zip(updates, values, strict=True)):
        bold = "bold" if each == DRAWN_FROM else "normal"
        ax.text(place + 0.08, value, f"{value:.0f} %", fontsize=TEXT, fontweight=bold, color=INK, va="center")
        sizes = sorted({len(cells[each].of(method)) for method in VARIED})
        agents = f"{sizes[0]} agents" if len(sizes) == 1 else f"{sizes[0]} to {sizes[-1]} agents"
        ax.text(place, -0.125, agents, transform=ax.get_xaxis_transform(), fontsize=TEXT, color=QUIET,
                ha="center", va="top")  # fmt: skip
    ax.axvline(0.5, color=QUIET, linewidth=0.8)
    for x, side, words in ((0.44, "right", "four roads"), (0.56, "left", "one road")):
        ax.text(x, 98, words, fontsize=TEXT, color=QUIET, ha=side, va="top")
    ax.set(xlim=(-0.5, len(updates) - 0.5), ylim=(0, 100))
    ax.set_xticks(at, [each.replace("1/4", "¼") for each in updates], fontsize=TEXT, color=INK)
    ax.set_xlabel("updates for a decision; grey: agents of each method", fontsize=TEXT, color=INK, labelpad=20)
    few, many = (f"{each(values):.0f}" for each in (min, max))
    title = f"The paper's four rates come in {few} to {many} % of the draws"
    chance = "; ".join(f"{u} {v:.0f} % [{a:.0f}, {b:.0f}]" for u, v, (a, b) in zip(updates, values, bars, strict=True))
    return finish(figure, title, f"For each number of updates, chance [95 %]: {chance}.")
