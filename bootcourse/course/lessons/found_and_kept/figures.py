"""Figures of the lesson on finding and keeping: agents' success, the two clocks, and who found and kept."""

from collections.abc import Mapping

import numpy as np
from matplotlib.figure import Figure
from matplotlib.ticker import FixedLocator, NullLocator

from bootcourse.course.charts import lines
from bootcourse.learn.bootstrap import demonstration_share
from bootcourse.methods import display_name, style
from bootcourse.plots.figure import (
    GRID,
    INK,
    QUIET,
    SMALL,
    TEXT,
    WIDTH,
    axes_at,
    finish,
    new_figure,
    one_axes,
    plain_axes,
    wrapped,
)
from bootcourse.research.experiments.clocks import UPDATES
from bootcourse.research.results import Results
from bootcourse.statistics import IN_A_ROW, found_after, rolling_means

LEAST = 1e-4  # the lowest part of ξ that is drawn
SHORT = {"1/4": "¼"}  # how a figure writes a number of updates


def one_agent(success: np.ndarray, method: str, title: str) -> Figure:
    """Success in training of one agent, (episodes,), its first and last good window marked."""
    means = rolling_means(100 * success[None], IN_A_ROW, len(success))
    at, share = means[0], means[1][0]
    words, look = f"success in the last {IN_A_ROW} episodes (%)", style(method)._replace(line="-")
    figure = lines(at, {method: share}, title, "training episode", words, looks=[look])
    good = np.flatnonzero(share > 50)
    for place, words in ((good[0], "found"), (good[-1], "last had it")):
        figure.axes[0].plot(at[place], share[place], "o", color=INK, ms=6, zorder=5)
        figure.axes[0].annotate(
            f"{words}: {at[place]:,.0f}", (at[place], share[place]), (8, 0), ha="left", va="center",
            textcoords="offset points", fontsize=TEXT, color=INK,
        )  # fmt: skip
    figure.alt += (
        f" More than half of a window for the first time at {at[good[0]]:.0f}, the last at {at[good[-1]]:.0f}."
    )
    return figure


def agent_by_agent(results: Results, method: str, title: str, mark: int, words: str) -> Figure:
    """When each of a method's agents has the way out in training: a row for each, a bar where it has.

    mark: the episode of a vertical line, and the words at it.
    """
    figure, ax = one_axes(4.0, title, "training episode", f"bar: over half of the last {IN_A_ROW} ended ahead")
    success, seeds = results.of(method).curves["success"], []
    shares = np.lib.stride_tricks.sliding_window_view(success, IN_A_ROW, axis=1).mean(axis=-1)
    for row, share in enumerate(shares):
        edges = IN_A_ROW + np.flatnonzero(np.diff(np.concatenate([[0], share > 0.5, [0]])))
        ax.plot([0, success.shape[1]], [row, row], color=GRID, linewidth=0.8, zorder=1)
        ax.broken_barh([(a, b - a) for a, b in edges.reshape(-1, 2)], (row - 0.33, 0.66), color=style(method).colour)
        seeds.append(f"seed {results.of(method).agents[row]['seed']} {_spans(edges)}")
    ax.axvline(mark, color=INK, linewidth=1, linestyle=(0, (2, 2)), zorder=3)
    ax.annotate(words, (mark, 1.03), xycoords=("data", "axes fraction"), xytext=(5, 0), va="bottom",
                textcoords="offset points", fontsize=TEXT, color=QUIET)  # fmt: skip
    ax.grid(False)
    ax.set(xlim=(0, success.shape[1]), ylim=(len(shares) - 0.4, -0.6))
    ax.set_yticks(range(len(shares)), [f"seed {agent['seed']}" for agent in results.of(method).agents])
    return finish(figure, title, f"When each agent has the way out, {display_name(method)}: {'; '.join(seeds)}.")


def _spans(edges: np.ndarray) -> str:
    """ "206 to 900 and 990 to 1,200", of (first, one after the last) of each bar."""
    return " and ".join(f"{a:,} to {b - 1:,}" for a, b in edges.reshape(-1, 2)) or "never"


def fading(cells: Mapping[tuple[str, str], Results]) -> Figure:
    """ξ over training with each number of updates, and β beside it; dots where half have found the way out.

    ξ on logarithmic axes, β, a straight line, on linear ones.

    cells: `clocks.cells`. Dots on ξ: agents with the soft constraint alone; on β: with demonstrations by π̃ alone.
    """
    title = "With more updates less of ξ is left when the way out is found"
    tall, top, wide, left, right = 2.6, 0.85, 2.98, 0.6, 3.85
    figure = new_figure(top + tall + 0.8)
    ax, beside = (axes_at(figure, at, top, wide, tall) for at in (left, right))
    alt_parts, soft, demos = [], style("soft").colour, style("demos").colour
    for updates in UPDATES:
        agents = cells[updates, "π̃"].of("soft")
        part = np.median(agents.curves["xi"] / agents.curves["xi"][:, :1], axis=0)
        episodes, half, tenth = np.arange(1, len(part) + 1), half_found(agents), int(np.argmax(part < 0.1))
        fallen = int(np.argmax(part < LEAST)) if part.min() < LEAST else len(part)  # what follows is below the axis
        ax.plot(episodes[:fallen], part[:fallen], color=soft, linewidth=2)
        below = part[half - 1] < LEAST
        ax.plot(half, max(part[half - 1], LEAST), "v" if below else "o", color=soft, mec=INK, ms=8, zorder=4,
                clip_on=False)  # fmt: skip
        number, low = SHORT.get(updates, updates), 5 * LEAST
        _number(ax, number, int(np.argmax(part < low)), low, (9, -2))
        _number(ax, number, half, max(part[half - 1], LEAST), (-10, 4) if below else (12, 3))
        words = f"ξ with {updates} updates is a tenth after {tenth} episodes, and half have the way out after {half}"
        alt_parts.append(f"{words}, at {part[half - 1]:.2g} of ξ")
    of = cells["1/4", "π̃"].of("demos").agents[0]
    share = demonstration_share(episodes, of["beta_start"], of["beta_episodes"]) / of["beta_start"]
    beside.plot(episodes, share, color=demos, linewidth=2)
    found = [half_found(cells[updates, "π̃"].of("demos")) for updates in UPDATES]
    beside.plot(found, share[np.array(found) - 1], "o", color=demos, mec=INK, ms=8, zorder=4)
    for episode in sorted({round(at, -1) for at in found}):  # dots that lie on each other have one label
        numbers = [SHORT.get(u, u) for u, at in zip(UPDATES, found, strict=True) if round(at, -1) == episode]
        _number(beside, " and ".join(numbers), episode, share[episode - 1], (-9 - 4 * len(numbers), -13))
    for each, words in ((ax, "ξ, soft constraint alone (logarithmic)"), (beside, "β, demonstrations alone, by π̃")):
        plain_axes(each, "")
        each.set_title(words, loc="left", fontsize=TEXT, color=INK, pad=8)
        each.set_xlabel("training episode" + " (logarithmic)" * (each is ax), fontsize=TEXT, color=INK)
    ax.set(xscale="log", yscale="log", xlim=(30, len(part)), ylim=(LEAST, 1.5))
    for axis, places in ((ax.xaxis, [50, 100, 200, 500, 1000]), (ax.yaxis, [1, 1e-1, 1e-2, 1e-3, 1e-4])):
        axis.set_major_locator(FixedLocator(places))
        axis.set_major_formatter("{x:,g}" if axis is ax.xaxis else lambda y, _: f"{y:g}")
        axis.set_minor_locator(NullLocator())
    beside.set(xlim=(0, len(part)), ylim=(0, 1.05), xticks=(0, 500, 1000), yticks=(0, 0.5, 1))
    beside.xaxis.set_major_formatter("{x:,g}")
    beside.yaxis.set_major_formatter("{x:g}")
    height = figure.get_figheight()
    figure.text(0.012, 1 - 0.55 / height, "share of its start that is left (ξ: median agent)", fontsize=TEXT, color=INK)
    key = "Dot: half of the agents have found the way out (▼: below the axis). Numbers: updates for a decision."
    figure.text(0.012, 0.1 / height, key, fontsize=TEXT, color=INK)
    alt_parts.append(f"On β half of the agents with demonstrations alone have the way out after {found}")
    return finish(figure, title, ". ".join(alt_parts) + ".")


def _number(ax, words: str, x: float, y: float, offset: tuple[float, float]) -> None:
    ax.annotate(words, (x, y), offset, ha="center", textcoords="offset points", fontsize=TEXT, color=INK)


def half_found(agents: Results) -> int:
    """The episode by which half of the agents have found the way out."""
    success = agents.curves["success"]
    after = found_after(success)
    ends = np.where(after > 0, after, success.shape[1])
    return int(np.sort(ends)[(len(ends) - 1) // 2])


Rows = Mapping[str, tuple[Results, str]]  # {words: (results, method)}, a row of squares each


def found_and_kept(panels: Mapping[str, Rows], title: str, of_rows: str = "") -> Figure:
    """A square for each agent, panels side by side with the same rows.

    Filled: it found the way out and kept it; empty: found and did not keep it; a dot: never found it.
    of_rows: what the rows' words are, written above them.
    """
    names = list(next(iter(panels.values())))
    left, top, tall = 0.25 + 0.075 * max(map(len, (*names, *of_rows.splitlines()))), 0.95, 0.34
    if len(wrapped(title).splitlines()) == 2:
        top += 0.15
    if not any(panels):  # no words above the panels
        top -= 0.2
    uneven = len({len(results.of(method)) for rows in panels.values() for results, method in rows.values()}) > 1
    figure, alt_parts = new_figure(top + tall * len(names) + (0.7 if uneven else 0.5)), []
    wide = (WIDTH - left - 0.1) / len(panels)
    for column, (panel, rows) in enumerate(panels.items()):
        ax = axes_at(figure, left + column * wide, top, min(wide - 0.15, 4.0), tall * len(rows))
        for y, (words, (results, method)) in enumerate(rows.items()):
            found, kept = (int(each.sum()) for each in results.found_and_kept(method))
            n, colour = len(results.of(method)), style(method).colour
            for x in range(n):
                if x < found:
                    ax.plot(x, y, "s", ms=8.5, color=colour if x < kept else "white", mec=colour, mew=1.6)
                else:
                    ax.plot(x, y, "o", ms=2.5, color=QUIET)
            counted = f"{found} of {n} found it, {kept} kept it"
            alt_parts.append(": ".join(part for part in (panel.replace("\n", " "), words, counted) if part))
        ax.set(xlim=(-0.6, 9.6), ylim=(len(rows) - 0.5, -0.5), xticks=(), yticks=())
        for side in ax.spines.values():
            side.set_visible(False)
        ax.set_title(panel, loc="left", fontsize=TEXT, color=INK, pad=5)
        if not column:
            ax.set_yticks(range(len(rows)), names, fontsize=TEXT, color=INK)
            ax.tick_params(axis="y", length=0)
    height = figure.get_figheight()
    figure.text(0.012, 1 - (top - 0.07) / height, of_rows, va="bottom", fontsize=SMALL, color=QUIET)
    key = "■ found, and has it at the end   □ found, but not at the end   · did not find it.   Each mark is an agent."
    key += "\nRows with fewer marks have fewer agents." if uneven else ""
    figure.text(0.012, 0.14 / height, key, fontsize=TEXT, color=INK)
    return finish(figure, title, f"Agents that found and kept the way out. {'; '.join(alt_parts)}.")
