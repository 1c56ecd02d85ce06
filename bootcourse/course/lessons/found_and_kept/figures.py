"""Figures of the lesson on finding and keeping: one agent's success, and who found and kept the way out."""

from collections.abc import Mapping

import numpy as np
from matplotlib.figure import Figure

from bootcourse.colours import Style
from bootcourse.course.charts import lines
from bootcourse.methods import display_name, style
from bootcourse.plots.figure import INK, QUIET, TEXT, WIDTH, axes_at, finish, new_figure
from bootcourse.research.cells import VARIED
from bootcourse.research.results import Results
from bootcourse.statistics import IN_A_ROW, rolling_means

# Titles that answer a prediction stand here, so that the student's cell does not give it away.
IN_THE_STUDY = "With demonstrations alone half of the agents find the way out, and none keeps it"
OF_TWO_GROUPS = "With two updates and π̃ all ten with demonstrations keep it, five with the soft constraint"


def one_agent(results: Results, which: int, title: str) -> Figure:
    """Training of one agent of one method: how often it is ahead, its first and last good window, how often it crashes.

    The second line counts the accidents of the episodes that do not end ahead.
    """
    success, accident = (results.curves[measure][which] for measure in ("success", "accident"))
    crashed = (success == 0) & (accident > 0)
    at, (share, crashes) = rolling_means(100 * np.stack([success, crashed]), IN_A_ROW, len(success))
    look = style(results.methods[0])._replace(line="-")
    named, looks = {"ahead of trap 1": share, "crashed behind trap\u00a01": crashes}, [look, Style(QUIET, ":")]
    words = f"% of the last {IN_A_ROW} episodes"
    figure = lines(at, named, title, "training episode", words, looks=looks)
    good = np.flatnonzero(share > 50)
    for place, words in ((good[0], "found"), (good[-1], "last had it")):
        figure.axes[0].plot(at[place], share[place], "o", color=INK, ms=6, zorder=5)
        figure.axes[0].annotate(
            f"{words}: {at[place]:,.0f}", (at[place], share[place]), (8, 0), ha="left", va="center",
            textcoords="offset points", fontsize=TEXT, color=INK, zorder=4,
            bbox={"facecolor": "white", "edgecolor": "none", "pad": 1},
        )  # fmt: skip
    figure.alt += (
        f" More than half of a window for the first time at {at[good[0]]:.0f}, the last at {at[good[-1]]:.0f}."
    )
    return figure


def found_and_kept(panels: Mapping[str, Results], title: str) -> Figure:
    """A square for each agent, a row for each method: {words: the four methods' ten agents each}, side by side.

    Filled: it found the way out and kept it; empty: found and did not keep it; a dot: never found it.
    """
    left, tall, alt_parts = 1.95, 0.34, []
    top = 0.95 if any(panels) else 0.75  # room for the panels' words
    figure, wide = new_figure(top + tall * len(VARIED) + 0.5), (WIDTH - left - 0.1) / len(panels)
    for column, (panel, results) in enumerate(panels.items()):
        ax = axes_at(figure, left + column * wide, top, min(wide - 0.15, 4.0), tall * len(VARIED))
        for y, method in enumerate(VARIED):
            found, kept = (int(each.sum()) for each in results.found_and_kept(method))
            n, colour = len(results.of(method)), style(method).colour
            for x in range(n):
                if x < found:
                    ax.plot(x, y, "s", ms=8.5, color=colour if x < kept else "white", mec=colour, mew=1.6)
                else:
                    ax.plot(x, y, "o", ms=2.5, color=QUIET)
            counted = f"{found} of {n} found it, {kept} kept it"
            alt_parts.append(": ".join(part for part in (panel, display_name(method), counted) if part))
        ax.set(xlim=(-0.6, 9.6), ylim=(len(VARIED) - 0.5, -0.5), xticks=(), yticks=())
        for side in ax.spines.values():
            side.set_visible(False)
        ax.set_title(panel, loc="left", fontsize=TEXT, color=INK, pad=5)
        if not column:
            ax.set_yticks(range(len(VARIED)), map(display_name, VARIED), fontsize=TEXT, color=INK)
            ax.tick_params(axis="y", length=0)
    key = "■ found and kept   □ found, not kept   · not found.   Each mark is an agent."
    figure.text(0.012, 0.14 / figure.get_figheight(), key, fontsize=TEXT, color=INK)
    return finish(figure, title, f"Agents that found and kept the way out. {'; '.join(alt_parts)}.")
