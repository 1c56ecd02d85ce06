"""Figures of the lesson on finding and keeping: agents' success, the two clocks, and who found and kept."""

from collections.abc import Mapping

import numpy as np
from matplotlib.figure import Figure
from matplotlib.ticker import FixedLocator, NullLocator

from bootcourse.course.charts import lines
from bootcourse.learn.bootstrap import demonstration_share
from bootcourse.methods import display_name, style
from bootcourse.plots.figure import (
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
from bootcourse.plots.training_curves import WINDOW
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
    for place, words in ((good[0], "found"), (good[-1], "lost")):
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
    """Success in training of a method's agents, a thin line for each and a thick one for their mean.

    mark: the episode of a vertical line, and the words at it.
    """
    each = f"success, {WINDOW} episodes (%); thick: mean"
    figure, ax = one_axes(4.0, title, "training episode", each)
    at, success = rolling_means(100 * results.of(method).curves["success"], WINDOW)
    mean, colour = success.mean(axis=0), style(method).colour
    ax.plot(at, success.T, color=colour, linewidth=0.8, alpha=0.55)
    ax.plot(at, mean, color=colour, linewidth=2.6)
    ax.axvline(mark, color=QUIET, linewidth=1, linestyle=(0, (2, 2)), zorder=1)
    ax.annotate(words, (mark, 1.03), xycoords=("data", "axes fraction"), xytext=(5, 0), va="bottom",
                textcoords="offset points", fontsize=TEXT, color=QUIET)  # fmt: skip
    ax.set(xlim=(0, at[-1]), ylim=(-4, 104), yticks=(0, 50, 100))
    near = np.searchsorted(at, [mark - 200, mark, at[-1]])
    means = ", ".join(f"{mean[i]:.0f} % at episode {at[i]}" for i in near)
    alt = (
        f"Success in the last {WINDOW} episodes, a thin line for each agent. {display_name(method)}, the mean: {means}."
    )
    return finish(figure, title, alt)


def fading(cells: Mapping[tuple[str, str], Results]) -> Figure:
    """ξ over training with each number of updates, and β beside it; dots where half have found the way out.

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
        _number(ax, SHORT.get(updates, updates), half, max(part[half - 1], LEAST), (8, 5))
        words = f"ξ with {updates} updates is a tenth after {tenth} episodes, and half have the way out after {half}"
        alt_parts.append(f"{words}, at {part[half - 1]:.2g} of ξ")
    of = cells["1/4", "π̃"].of("demos").agents[0]
    share = demonstration_share(episodes, of["beta_start"], of["beta_episodes"]) / of["beta_start"]
    beside.plot(episodes, np.where(share > 0, share, np.nan), color=demos, linewidth=2)
    found = [half_found(cells[updates, "π̃"].of("demos")) for updates in UPDATES]
    beside.plot(found, share[np.array(found) - 1], "o", color=demos, mec=INK, ms=8, zorder=4)
    for episode in sorted({round(at, -1) for at in found}):  # dots that lie on each other have one label
        numbers = [SHORT.get(u, u) for u, at in zip(UPDATES, found, strict=True) if round(at, -1) == episode]
        _number(beside, " and ".join(numbers), episode, share[episode - 1], (-3, -14))
    for each, words in ((ax, "ξ, soft constraint alone"), (beside, "β, demonstrations alone, driven by π̃")):
        plain_axes(each, "")
        each.set_title(words, loc="left", fontsize=TEXT, color=INK, pad=8)
        each.set_xlabel("training episode (logarithmic)", fontsize=TEXT, color=INK)
        each.set(xscale="log", yscale="log", xlim=(30, len(part)), ylim=(LEAST, 1.5))
        for axis, places in ((each.xaxis, [50, 100, 200, 500, 1000]), (each.yaxis, [1, 1e-1, 1e-2, 1e-3, 1e-4])):
            axis.set_major_locator(FixedLocator(places))
            axis.set_major_formatter("{x:,g}" if axis is each.xaxis else lambda y, _: f"{y:g}")
            axis.set_minor_locator(NullLocator())
    beside.tick_params(labelleft=False)
    height = figure.get_figheight()
    figure.text(0.012, 1 - 0.55 / height, "share of its start (logarithmic; ξ: median agent)", fontsize=TEXT, color=INK)
    key = "Dot: half of the agents have found the way out. Its number: updates for a decision. ▼ below the axis."
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
    key = "■ found the way out and kept it   □ found it, did not keep it   · did not find it.   Each mark is an agent."
    key += "\nRows with fewer marks have fewer agents." if uneven else ""
    figure.text(0.012, 0.14 / height, key, fontsize=TEXT, color=INK)
    return finish(figure, title, f"Agents that found and kept the way out. {'; '.join(alt_parts)}.")
