"""Figures of the barrier: when agents got out while they learned, and how they drive in the end."""

from collections.abc import Mapping

import numpy as np
from matplotlib.figure import Figure

from bootcourse.colours import ALARM, PALE
from bootcourse.course.lessons.the_barrier import easier
from bootcourse.course.live_curves import LiveCurves
from bootcourse.learn.training import Training
from bootcourse.methods import style
from bootcourse.plots.figure import (
    INK,
    QUIET,
    SMALL,
    TEXT,
    axes_at,
    finish,
    label_ends,
    new_figure,
    one_axes,
    plain_axes,
)
from bootcourse.research.results import Results
from bootcourse.statistics import ESCAPES

DARK = style("sac").colour
BLUES = (DARK, "-"), ("#5AA9DB", "--")  # of the agents of each γ
IDLE = style("idle")

ENDS = {  # how an agent of an easier road ends, in the order of `how_they_end`: its colour
    "escapes, earns more than by staying": DARK,
    "escapes, earns no more": PALE,
    "does not escape, crashes": "white",
    "stays behind": "white",
}
CRASHES = {"marker": "X", "c": ALARM, "edgecolors": "white", "linewidths": 0.5}  # on most roads


def how_they_end(agents: Results, staying: float) -> np.ndarray:
    """How many agents of a kind end in each of the `ENDS`, and how many of these crash on most roads, (2, 4)."""
    out, crashing = agents.scores("success") >= ESCAPES, agents.scores("accident") > 0.5
    more = agents.scores("returns") > staying
    each = np.array([out & more, out & ~more, ~out & crashing, ~out & ~crashing])
    return np.array([each.sum(axis=1), (each & crashing).sum(axis=1)])


class LiveReturns(LiveCurves):
    """The return of each agent while it learns, in a blue for each γ, and what a car earns that does nothing."""

    def __init__(self, idle: float):
        super().__init__()
        self.idle = idle

    def draw(self, training: Training) -> Figure:
        if not self.updates:
            self.note(training)
        returns = np.stack([means["return"] for means in self.means], axis=1)  # (agents, points)
        best = np.nanmax(returns[:, -1])
        who = "Neither agent" if len(returns) == 2 else f"None of the {len(returns)} agents"
        if best < self.idle:
            title = f"{who} earns as much as a car that does nothing"
        else:
            title = f"The best agent earns {best:.0f}, a car that does nothing {self.idle:.0f}"
        figure = new_figure(2.95)
        ax = axes_at(figure, 0.45, 0.75, 5.0, 1.75)
        plain_axes(ax, "return of an episode, mean of an agent's last 50")
        ax.axhline(self.idle, color=IDLE.colour, linestyle=IDLE.line, linewidth=IDLE.width)
        ends = [(self.idle, f"does nothing: {self.idle:.1f}", IDLE.colour)]
        gammas = np.array([settings.gamma for settings in training.settings])
        for (colour, line), gamma in zip(BLUES, dict.fromkeys(gammas.tolist()), strict=False):
            for each in returns[gammas == gamma]:
                ax.plot(self.updates, each, color=colour, linestyle=line, linewidth=2)
            now = np.nanmean(returns[gammas == gamma, -1])
            ends.append((now, f"γ = {gamma:g}: {now:.1f}".replace("-", "−"), colour))
        ax.set(xlim=(0, max(self.updates[-1], 1)))
        ax.set_xlabel("updates of each agent", fontsize=TEXT, color=INK)
        label_ends(ax, ends)
        said = "; ".join(words for _, words, _ in ends)
        return finish(figure, title, f"After {training.updates:,} updates: {said}.")


def escapes(trained: Mapping[str, Results], shown: Mapping[tuple[str, str], str]) -> Figure:
    """A square for each agent, coloured by how it ends, crossed if it crashes on most roads: a block for each kind, and
    a row of it for each γ.

    shown: {(the row's words, the column's words): the kind}, row by row.
    """
    found = {words: how_they_end(trained[kind], easier.staying(kind)) for words, kind in shown.items()}
    rows, columns = (list(dict.fromkeys(words[k] for words in shown)) for k in (0, 1))
    figure = new_figure(3.85)
    ax = axes_at(figure, 0, 0.7, figure.get_figwidth(), 3.15)  # in inches
    ax.set(xlim=(0, figure.get_figwidth()), ylim=(3.15, 0))
    ax.axis("off")
    look = {"marker": "s", "edgecolors": INK, "linewidths": 0.8}
    for column, words in enumerate(columns):
        ax.text(1.55 + 2.7 * column, 0.12, words, va="center", fontsize=TEXT, color=INK)
    for row, words in enumerate(rows):
        ax.text(0.1, 0.8 + 0.95 * row, words, va="center", fontsize=TEXT, color=INK)
    for (row, column), (ends, crossing) in found.items():
        x, y = 1.55 + 2.7 * columns.index(column), 0.4 + 0.95 * rows.index(row)
        kind = shown[row, column]
        gammas = np.array([agent["gamma"] for agent in trained[kind].agents])
        for line, gamma in enumerate(easier.GAMMAS):
            alike = trained[kind].pick(np.flatnonzero(gammas == gamma))
            each, crash = how_they_end(alike, easier.staying(kind))
            across, down = x + 0.09 + 0.2 * np.arange(sum(each)), np.full(sum(each), y + 0.3 + 0.2 * line)
            ax.scatter(across, down, s=125, c=np.repeat([*ENDS.values()], each), **look)
            lasts = np.cumsum(each)  # of each colour those that crash come last
            crossed = [last - 1 - k for last, of in zip(lasts, crash, strict=True) for k in range(of)]
            ax.scatter(across[crossed], down[crossed], s=42, **CRASHES)
            ax.text(x + 2.02, down[0], f"γ = {gamma:g}", va="center", fontsize=SMALL, color=QUIET)
        parts = (sum(ends[:2]), sum(crossing[:2])), (sum(ends[2:]), sum(crossing[2:]))
        words = (
            f"{each} {verb}" + (f" ({of} crash{'es' if of == 1 else ''})" if of else "")
            for (each, of), verb in zip(parts, ("escapes" if parts[0][0] == 1 else "escape", "do not"), strict=True)
        )
        says = ", ".join(words)
        ax.text(x, y + 0.06, says, va="center", fontsize=TEXT, color=INK)
    earns, poor = [*ENDS][:2]
    keys = {earns: ENDS[earns], poor: ENDS[poor], "does not escape": "white", "a cross: crashes on most roads": ""}
    note = f"Escapes: gets ahead of trap 1 on at least {100 * ESCAPES:.0f} % of the roads. It may crash after that."
    for place, (words, colour) in enumerate(keys.items()):
        at = 1.64 + 2.7 * (place % 2), 2.5 + 0.22 * (place // 2)
        if colour:
            ax.scatter(*at, s=70, c=[colour], **look)
        else:
            ax.scatter(*at, s=30, **CRASHES)
        ax.text(at[0] + 0.16, at[1], words, va="center", fontsize=SMALL, color=INK)
    ax.text(1.55, 3.0, note, va="center", fontsize=SMALL, color=QUIET)
    both, _ = found[rows[-1], columns[-1]]
    title = f"Cheap accidents and the free lane together: {sum(both[:2])} of {sum(both)} escape, "
    title += f"{both[0]} earn more than by staying"
    listed = "; ".join(f"{', '.join(words)}: {', '.join(map(str, ends))}" for words, (ends, _) in found.items())
    crossed = "; ".join(f"{', '.join(words)}: {sum(counts)}" for words, (_, counts) in found.items())
    alt = f"A square for each agent. {', '.join(ENDS)}: {listed}. A cross: crashes on most roads: {crossed}."
    return finish(figure, title, alt)


def times_ahead(results: Results) -> np.ndarray:
    """In how many drives each agent got out while it learned, (agents,)."""
    return (results.curves["success"] > 0).sum(axis=1)


def counts_by_quarter(results: Results) -> tuple[np.ndarray, np.ndarray]:
    """In each quarter of an agent's drives: how many got out, and how many there are, each (agents, 4)."""
    drives = [np.array_split(each[np.isfinite(each)] > 0, 4) for each in results.curves["success"]]
    return tuple(np.array([[count(quarter) for quarter in each] for each in drives]) for count in (np.sum, len))


def by_quarter(results: Results) -> np.ndarray:
    """In which share of its drives each agent got out, in each quarter of its drives, (agents, 4)."""
    out, drives = counts_by_quarter(results)
    return out / drives


def getting_out(trained: Mapping[str, Results], shown: Mapping[tuple[str, str], str], chance: float) -> Figure:
    """How often the median agent of each kind gets out while it learns, a line for each kind, and how often random
    drives do.

    shown: as `escapes` has it. chance: the share of random drives from the trap that get out.
    """
    title = "At a price of 10 the median agent does not learn to get out, at 1 it does"
    figure, ax = one_axes(
        3.0, title, "quarter of an agent's drives", "drives that got out (%), median agent", width=0.6
    )
    ax.axhline(100 * chance, color=QUIET, linewidth=0.8)
    ends, said = [(100 * chance, f"at random: {100 * chance:.1f} %", QUIET)], []
    for (start, price), kind in shown.items():
        shares = 100 * np.median(by_quarter(trained[kind]), axis=0)
        colour, line = (DARK, "o-") if "lane" in start else (BLUES[1][0], "s--")
        ax.plot(range(1, 5), shares, line, color=colour, linewidth=2, markersize=4)
        words = f"{price.split()[-1]}, {start.removeprefix('start ')}"
        same = [other for (_, cost), other in shown.items() if cost == price]
        last = [round(100 * np.median(by_quarter(trained[other]), axis=0)[-1]) for other in same]
        if len(set(last)) > 1:
            ends.append((shares[-1], f"price {words}: {shares[-1]:.0f} %", colour))
        elif kind == same[0]:  # their ends lie on one another
            ends.append((shares[-1] - 1, f"price {price.split()[-1]}, either start: {shares[-1]:.0f} %", INK))
        said.append(f"price {words}: {', '.join(f'{share:.1f}' for share in shares)}")
    ax.set(xlim=(0.9, 4), ylim=(-4, 100), xticks=range(1, 5))
    label_ends(ax, ends)
    alt = f"Drives that got out in each quarter of the drives, %. {'; '.join(said)}. Random drives: {100 * chance:.1f}."
    return finish(figure, title, alt)


def while_they_learned(results: Results, chance: float) -> Figure:
    """When each agent got out while it learned: a row for each agent, a mark for each such drive.

    At a row's end stands how the agent then drives on the test roads, if it gets out on 10 % or more; below, how many
    do not.

    chance: that an agent would at least once, if all its actions were random.
    """
    times, ahead = times_ahead(results), results.scores("success")
    escaping = ahead >= ESCAPES
    title = f"{(times > 0).sum()} of {len(times)} agents got out while they learned, "
    title += f"{(times == 1).sum()} of them once; {escaping.sum()} escapes"
    figure = new_figure(4.42)
    ax = axes_at(figure, 0.2, 0.75, 6.5, 2.85)
    plain_axes(ax, "a row for each agent, the one that got out most often first", grid="")
    ax.set_xlabel("drives of an agent while it learned", fontsize=TEXT, color=INK)
    listed = []
    for row, k in enumerate(np.argsort(-times, kind="stable")):
        drives = results.curves["success"][k]
        ax.plot([0, np.isfinite(drives).sum()], [row, row], color=PALE, linewidth=1.0)
        ax.plot(1 + np.flatnonzero(drives > 0), np.full(times[k], row), "|", color=DARK, markersize=7)
        listed.append(f"{times[k]}")
        if ahead[k] >= 0.1:
            label = f"tested: gets out on {100 * ahead[k]:.0f} % of roads{', escapes' * int(escaping[k])}"
            ax.text(np.isfinite(drives).sum() + 12, row, label, fontsize=TEXT, color=INK, va="center")
            listed[-1] += f" ({label})"
    ax.set(ylim=(len(times) - 0.3, -0.8), yticks=[])
    ax.set_xlim(left=0)
    words = f"A mark: a drive that got out. If all actions were random, {len(times) * chance:.0f} of {len(times)} "
    words += "agents would have one in 400 drives."
    others = f"Tested, the other {(ahead < 0.1).sum()} agents get out on less than 10 % of the roads."
    figure.text(0.012, 0.015, f"{words}\n{others}", fontsize=SMALL, color=QUIET)
    return finish(figure, title, f"{words} {others}\nThe agents' drives that got out: {', '.join(listed)}.")
