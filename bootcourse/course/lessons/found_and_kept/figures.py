"""Figures of the lesson on finding and keeping: who found and kept the way out, what it is worth in training, and how
often single agents drive as the paper's.
"""

from collections.abc import Mapping

import numpy as np
from matplotlib.figure import Figure

from bootcourse.colours import TRAP
from bootcourse.course.lessons.found_and_kept import ways
from bootcourse.course.shipped import shipped_experiment
from bootcourse.methods import display_name, style
from bootcourse.plots.figure import INK, QUIET, TEXT, axes_at, finish, new_figure, plain_axes
from bootcourse.research.cells import VARIED
from bootcourse.research.experiments import clocks
from bootcourse.research.results import Results

DRAWN_FROM = "2"  # the updates for a decision of the agents that the lesson shows


WORTHS = {  # the title of each picture
    "demos": "Just before the bonus ends, the ways out are worth less than staying",
    "demos, β for ever": "If the bonus never ends, they keep a way out that does not pay",
    "bootstrapped": "With both aids the ways out pay more and more as the bonus ends",
}
FIRST_SHOWN = 400  # the training episode with which the pictures of worth begin


def worths(cell: str) -> Figure:
    """What each agent's drives are worth to it while it learns, thick where it gets ahead on most roads.

    cell: of the experiment `ways`.
    """
    agents = shipped_experiment("ways")[cell]
    episode, worth, ahead = (agents.notes[name] for name in ("episode", "worth", "success"))
    staying, look = ways.staying(agents.agents[0]["gamma"]), style(agents.methods[0])
    figure = new_figure(4.0)
    ax = axes_at(figure, 0.55, 0.8, 5.1, 2.3)
    plain_axes(ax, f"worth of a drive at γ = 0.8, without the bonus (mean of {ways.ROADS} roads)")
    had, ends = ways.at(agents, ways.BEFORE, "success") > 0.5, ahead[:, -1] > 0.5
    for at, each, share, out in zip(*(part[had | ends] for part in (episode, worth, ahead, ends)), strict=True):
        colour = look.colour if out else TRAP
        ax.plot(at, each, color=colour, linewidth=0.5 if out else 0.9, alpha=0.5, zorder=1)
        ax.plot(at, np.where(share > 0.5, each, np.nan), "-", color=colour, linewidth=1.3, alpha=0.8, zorder=2)
    place = episode[had, np.argmax(episode[had] > ways.BEFORE, axis=1) - 1]
    ax.plot(place, ways.at(agents, ways.BEFORE)[had], "o", ms=4, color=INK, zorder=4)
    ax.axhline(staying, color=INK, linewidth=1.1, linestyle=(0, (4, 3)), zorder=3)
    words, beside = f"staying behind:\n{staying:.2f}", ax.get_yaxis_transform()
    ax.text(1.01, staying, words, transform=beside, fontsize=TEXT, color=INK, va="center")
    if (end := agents.agents[0]["beta_episodes"]) is not None:
        ax.axvline(end, color=QUIET, linewidth=1.1, linestyle=(0, (1, 2)), zorder=1)
        ax.text(end + 15, 1.82, "no demonstrations from here on", fontsize=TEXT, color=QUIET, va="center")
    ax.set(xlim=(FIRST_SHOWN, episode.max()), ylim=(0, 1.9))
    ax.set_xlabel("training episode", fontsize=TEXT, color=INK)
    others = "" if ends[had].all() else " Dark red: at the end it does not."
    key = (
        f"Thick: the agent gets ahead on most roads; dot: so just before episode 1,000.{others}\n"
        "Left out: agents that do so neither then nor at the end. (Worths below 0, after accidents, are cut.)"
    )
    figure.text(0.012, 0.12 / figure.get_figheight(), key, fontsize=TEXT, color=QUIET)
    alt = ""
    for last, name in ((ways.BEFORE, "Just before episode 1,000"), (ways.EPISODES, f"At episode {ways.EPISODES:,}")):
        each = ", ".join(f"{one:.2f}" for one in np.sort(ways.out(agents, last)))
        alt += f"{name} the ways out of those that get ahead on most roads are worth {each}. "
    return finish(figure, WORTHS[cell], f"{alt}Staying behind is worth {staying:.2f}.")


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
    for place, (each, value) in enumerate(zip(updates, values, strict=True)):
        few = min(len(cells[each].of(method)) for method in VARIED) < 10
        ax.plot(place, value, "o", ms=7, mfc="white" if few else colour, mec=colour, mew=1.6, zorder=3)
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
    ax.set_xlabel(
        "updates for a decision; below: agents of each method (empty dot: fewer than ten)",
        fontsize=TEXT,
        color=INK,
        labelpad=20,
    )
    title = f"With {DRAWN_FROM} updates {counted[DRAWN_FROM]:.0%} of the draws give the paper's rates".replace(
        "%", " %"
    )
    chance = "; ".join(f"{u} {v:.0f} % [{a:.0f}, {b:.0f}]" for u, v, (a, b) in zip(updates, values, bars, strict=True))
    return finish(figure, title, f"For each number of updates, chance [95 %]: {chance}.")
