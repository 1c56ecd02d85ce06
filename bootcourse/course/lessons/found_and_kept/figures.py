"""Figures of the lesson on finding and keeping: each agent's success, the two clocks, and who found and kept."""

from collections.abc import Mapping, Sequence

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.ticker import FixedLocator, NullLocator

from bootcourse.colours import Style
from bootcourse.course.charts import lines
from bootcourse.learn.bootstrap import demonstration_share
from bootcourse.methods import display_name, style
from bootcourse.plots.figure import INK, QUIET, SMALL, TEXT, axes_at, finish, new_figure, one_axes, plain_axes
from bootcourse.plots.training_curves import WINDOW
from bootcourse.research.clocks import UPDATES
from bootcourse.research.results import WINDOW as IN_A_ROW
from bootcourse.research.results import Results
from bootcourse.statistics import rolling_means

LEAST = 1e-4  # the lowest part of ξ that is drawn
SHORT = {"1/4": "¼"}  # how a figure writes a number of updates


def one_agent(success: np.ndarray, method: str, title: str) -> Figure:
    """Success in training of one agent, (episodes,), its first and last good window marked."""
    means = rolling_means(100 * success[None], IN_A_ROW, len(success))
    at, share = means[0], means[1][0]
    figure = lines(at, {method: share}, title, "training episode", f"success in the last {IN_A_ROW} episodes (%)")
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


def seed_by_seed(results: Results, methods: Sequence[str], title: str, mark: int, words: str) -> Figure:
    """Success in training: a large panel for the first method, small ones below for the others.

    A thin line for each agent, a thick one for their mean. mark: the episode of a vertical line, and the words at it.
    """
    figure, alt_parts = new_figure(5.2), []
    small = 6.3 / (len(methods) - 1)
    places = [(0.45, 1.05, 6.3, 1.85)] + [(0.45 + i * small, 3.5, small - 0.35, 1.05) for i in range(len(methods) - 1)]
    for method, place in zip(methods, places, strict=True):
        ax = axes_at(figure, *place)
        at, success = rolling_means(100 * results.of(method).curves["success"], WINDOW)
        mean, colour = success.mean(axis=0), style(method).colour
        ax.plot(at, success.T, color=colour, linewidth=0.8, alpha=0.55)
        ax.plot(at, mean, color=colour, linewidth=2.6)
        ax.axvline(mark, color=QUIET, linewidth=1, linestyle=(0, (2, 2)), zorder=1)
        if method == methods[0]:
            ax.annotate(words, (mark, 1.02), xycoords=("data", "axes fraction"), xytext=(5, 0), va="bottom",
                        textcoords="offset points", fontsize=SMALL, color=QUIET)  # fmt: skip
        plain_axes(ax, display_name(method))
        ax.set(xlim=(0, at[-1]), ylim=(-4, 104), yticks=(0, 50, 100))
        if method != methods[0]:
            ax.set_xlabel("training episode", fontsize=SMALL, color=QUIET)
        near = np.searchsorted(at, [mark - 200, mark, at[-1]])
        alt_parts.append(f"{display_name(method)}: " + ", ".join(f"{mean[i]:.0f} % at episode {at[i]}" for i in near))
    each = f"Success in the last {WINDOW} episodes (%). Thin: agents. Thick: their mean"
    figure.text(0.012, 0.1 / 5.2, f"{each}.", fontsize=SMALL, color=QUIET)
    return finish(figure, title, f"{each}: {'; '.join(alt_parts)}.")


def fading(cells: Mapping[tuple[str, str], Results]) -> Figure:
    """ξ over training with each number of updates, and β, with dots where half of the agents have found the way out.

    cells: `clocks.cells`. Dots on ξ: agents with the soft constraint alone; on β: with demonstrations by π̃ alone.
    """
    title = "With more updates less of ξ is left when the way out is found"
    figure, ax = one_axes(3.8, title, "training episode", "share of its start (ξ: median agent)", width=0.86)
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
        ax.annotate(
            SHORT.get(updates, updates), (half, max(part[half - 1], LEAST)), (0, 8) if below else (8, 4),
            ha="center", textcoords="offset points", fontsize=TEXT, color=INK,
        )  # fmt: skip
        words = f"ξ with {updates} updates is a tenth after {tenth} episodes, and half have the way out after {half}"
        alt_parts.append(f"{words}, at {part[half - 1]:.2g} of ξ")
    of = cells["1/4", "π̃"].of("demos").agents[0]
    share = demonstration_share(episodes, of["beta_start"], of["beta_episodes"]) / of["beta_start"]
    ax.plot(episodes, np.where(share > 0, share, np.nan), color=demos, linewidth=2)
    found = [half_found(cells[updates, "π̃"].of("demos")) for updates in UPDATES]
    ax.plot(found, share[np.array(found) - 1], "o", color=demos, mec=INK, ms=8, zorder=4)
    for episode in sorted({round(at, -1) for at in found}):  # dots that lie on each other have one label
        numbers = ", ".join(SHORT.get(u, u) for u, at in zip(UPDATES, found, strict=True) if round(at, -1) == episode)
        ax.annotate(
            numbers, (episode, share[episode - 1]), (0, 7), ha="center", textcoords="offset points", fontsize=TEXT,
            color=INK,
        )  # fmt: skip
    ax.annotate("β", (of["beta_episodes"], 0.02), (5, 0), textcoords="offset points", fontsize=TEXT, color=INK)
    ax.annotate("ξ", (98, 1e-3), (-16, 0), textcoords="offset points", fontsize=TEXT, color=INK)
    alt_parts.append(f"On β half of the agents with demonstrations alone have the way out after {found}")
    ax.set(xscale="log", yscale="log", xlim=(20, len(part)), ylim=(LEAST, 1.5))
    for axis, places in ((ax.xaxis, [20, 50, 100, 200, 500, 1000]), (ax.yaxis, [1, 1e-1, 1e-2, 1e-3, 1e-4])):
        axis.set_major_locator(FixedLocator(places))
        axis.set_major_formatter("{x:,g}" if axis is ax.xaxis else lambda y, _: f"{y:.4f}".rstrip("0").rstrip("."))
        axis.set_minor_locator(NullLocator())
    return finish(figure, title, ". ".join(alt_parts) + ".")


def half_found(agents: Results) -> int:
    """The episode by which half of the agents have found the way out."""
    windows = np.lib.stride_tricks.sliding_window_view(agents.curves["success"], IN_A_ROW, axis=1).mean(-1) > 0.5
    ends = np.where(windows.any(1), windows.argmax(1) + IN_A_ROW, agents.curves["success"].shape[1])
    return int(np.sort(ends)[(len(ends) - 1) // 2])


def found_and_kept(cells: Mapping[tuple[str, str], Results]) -> Figure:
    """How many agents found and kept the way out against the updates for a decision, a panel for each kind of help.

    cells: `clocks.cells`. Above: without the soft constraint; below: with it. From left to right: no demonstrations,
    those driven by μ, those driven by π̃.
    """
    title = (
        "With more updates, demonstrations alone seem to keep the way out more often; "
        "the soft constraint alone does not"
    )
    figure, alt_parts = new_figure(5.3), []
    for row, (alone, helped) in enumerate((("sac", "demos"), ("soft", "bootstrapped"))):
        for column, (method, driver) in enumerate(((alone, "μ"), (helped, "μ"), (helped, "π̃"))):
            ax = axes_at(figure, 0.5 + 2.25 * column, 1.0 + 2.1 * row, 1.85, 1.35)
            name = display_name(method) + (f", driver {driver}" if column else "")
            alt_parts.append(f"{name}: " + _shares(ax, cells, method, driver))
            plain_axes(ax, name)
            ax.tick_params(labelleft=column == 0)
    figure.text(0.012, 0.34 / 5.3, "Updates for a decision, and how many agents.", fontsize=TEXT, color=INK)
    words = (
        "Share of the agents (%): ○ found the way out, ● kept it. The number at ● is that of the agents that kept it."
    )
    figure.text(0.012, 0.1 / 5.3, words, fontsize=TEXT, color=INK)
    return finish(figure, title, f"Found and kept, of how many. {'; '.join(alt_parts)}.")


def _shares(ax: Axes, cells: Mapping[tuple[str, str], Results], method: str, driver: str) -> str:
    """Draw one panel; its counts in words."""
    look: Style = style(method)
    counts = [cells[updates, driver].found_and_kept(method) for updates in UPDATES]
    agents = np.array([len(found) for found, _ in counts])
    found, kept = (np.array([each[i].sum() for each in counts]) for i in (0, 1))
    at = np.arange(len(UPDATES))
    ax.plot(at, 100 * found / agents, color=look.colour, linewidth=1, linestyle=(0, (2, 2)))
    ax.plot(at, 100 * found / agents, "o", color="white", mec=look.colour, mew=1.4, ms=8, zorder=3, clip_on=False)
    ax.plot(at, 100 * kept / agents, color=look.colour, linewidth=2)
    ax.plot(at, 100 * kept / agents, "o", color=look.colour, ms=5.5, zorder=4, clip_on=False)
    for x, (share, number) in enumerate(zip(kept / agents, kept, strict=True)):
        ax.annotate(str(number), (x, 100 * share), (0, 13 if share < 0.15 else -7), textcoords="offset points",
                    ha="center", va="bottom" if share < 0.15 else "top", fontsize=TEXT, color=INK)  # fmt: skip
    names = [SHORT.get(updates, updates) for updates in UPDATES]
    ax.set_xticks(at, [f"{name}\nof {n}" for name, n in zip(names, agents, strict=True)])
    ax.set(xlim=(-0.4, len(UPDATES) - 0.6), ylim=(-6, 108), yticks=(0, 50, 100))
    return ", ".join(f"{f} and {k} of {n} with {u}" for f, k, n, u in zip(found, kept, agents, UPDATES, strict=True))
