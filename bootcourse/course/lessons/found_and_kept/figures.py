"""Figures of the lesson on finding and keeping: who found and kept the way out, and what it is worth in training."""

from collections.abc import Mapping

import numpy as np
from matplotlib.figure import Figure

from bootcourse.colours import TRAP
from bootcourse.course.lessons.found_and_kept import walks, ways
from bootcourse.course.shipped import shipped_experiment
from bootcourse.learn.settings import settings_for
from bootcourse.methods import display_name, style
from bootcourse.plots.figure import INK, QUIET, TEXT, axes_at, finish, new_figure, plain_axes
from bootcourse.research.cells import VARIED
from bootcourse.research.results import Results
from bootcourse.scenario import IDLE

WORTHS = {  # the title of each picture: (the agents that are ahead later, of all)
    "demos": "{0} of {1} end on faster ways, the others at staying; many crash",
    "demos, β for ever": "If the bonus never ends, {0} of {1} stay ahead, all below staying",
}


def worths(cell: str) -> Figure:
    """What the ways out are worth just before β ends, and at each later look; at the right, the late looks' median.

    cell: of the experiment `ways`. Shown: the agents that get ahead on most roads just before β ends.
    """
    agents = shipped_experiment("ways")[cell]
    had = ways.had_a_way(agents)
    before, after = ways.at(agents, ways.BEFORE)[had], ways.late(agents)[had]
    ahead = ways.late(agents, "success")[had] > 0.5
    staying, colour = ways.staying(agents.agents[0]["gamma"]), style(agents.methods[0]).colour
    figure = new_figure(3.8)
    ax = axes_at(figure, 0.55, 0.65, 4.3, 2.6)
    words = f"worth of a drive at γ = 0.8, without the bonus (mean of {ways.ROADS} roads); cut at −1: they crash"
    plain_axes(ax, words)
    ax.set(xlim=(-0.05, 1.06), ylim=(-1, 1.8), yticks=(-1, 0, 1))
    ax.set_xticks((0, 0.45, 0.9), ("just before 1,000", f"{ways.LATE:,}", f"{ways.EPISODES:,}"), fontsize=TEXT)
    ax.set_xlabel(
        f"training episode; the dots at the right: the median from {ways.LATE:,} on", fontsize=TEXT, color=INK
    )
    looks = np.arange(agents.notes["worth"].shape[1]) * ways.EVERY
    later, just_before = looks > ways.BEFORE, looks[looks <= ways.BEFORE][-1]
    at = np.r_[0, 0.9 * (looks[later] - just_before) / (ways.EPISODES - just_before)]
    for first, way, last, out in zip(before, agents.notes["worth"][had], after, ahead, strict=True):
        look = {"color": colour if out else TRAP, "zorder": 3 if out else 4}
        ax.plot(at, np.r_[first, way[later]], linewidth=0.7, alpha=0.7, **look)
        ax.plot((0, 1), (first, last), "o", ms=6, mec="white", mew=0.6, **look)
    ax.axhline(staying, color=INK, linewidth=1.5, zorder=2)
    ax.text(1.09, staying + 0.04, f"staying behind: {staying:.2f}", fontsize=TEXT, color=INK, va="center")
    ax.text(1.09, np.median(after[ahead]), f"{ahead.sum()} ahead of trap 1", fontsize=TEXT, color=colour, va="center")
    if behind := (~ahead).sum():
        ax.text(1.09, staying - 0.1, f"{behind} behind it", fontsize=TEXT, color=TRAP, va="center")
    each = [", ".join(f"{one:.2f}" for one in np.sort(worth)) for worth in (before, after[ahead], after[~ahead])]
    alt = (
        f"A line for each of {had.sum()} agents, through all looks. Just before episode 1,000 their ways out are worth "
        f"{each[0]}. In the episodes {ways.LATE:,} to {ways.EPISODES:,} (median), {ahead.sum()} are ahead, on ways "
        f"worth {each[1]}"
        + (f"; {behind} are behind, worth {each[2]}" if behind else "")
        + f". Staying behind is worth {staying:.2f}."
    )
    return finish(figure, WORTHS[cell].format(ahead.sum(), had.sum()), alt)


def two_hills() -> Figure:
    """What the rule's drive is worth if it begins with seconds of keeping straight, or of accelerating."""
    figure, staying = new_figure(3.3), ways.staying(settings_for("demos").gamma)
    ax = axes_at(figure, 0.55, 0.65, 4.5, 2.1)
    plain_axes(ax, f"worth of a drive at γ = 0.8, without the bonus (mean of {walks.TRIED} roads)")
    kept, sped = walks.means(IDLE), walks.means(walks.FASTER)
    colour = style("demos").colour
    ax.axhline(staying, color=INK, linewidth=1.5, zorder=1)
    ax.text(20.6, staying, f"staying behind: {staying:.2f}", fontsize=TEXT, color=INK, va="center")
    ax.plot(walks.KEPT, kept, "o-", color=TRAP, ms=4, linewidth=1.5)
    ax.text(7, 0.66, "keep straight for k seconds, then the rule", fontsize=TEXT, color=TRAP, va="center")
    ax.plot(walks.SPED, sped, "o-", color=colour, ms=5, linewidth=2)
    ax.text(3.5, sped[3], "accelerate for k seconds, then the rule", fontsize=TEXT, color=colour, va="center")
    ax.text(4.2, 0.43, f"k = 4: all crash ({sped[4]:.1f})".replace("-", "−"), fontsize=TEXT, color=colour, va="center")
    ax.plot(0, kept[0], "o", color=style("rule").colour, ms=8, zorder=4)
    ax.text(0.4, 0.5, "the rule", fontsize=TEXT, color=style("rule").colour, va="center")
    ax.set(xlim=(-0.5, 20.5), ylim=(0.38, 1.06), xticks=range(0, 21, 5), yticks=(0.4, 0.6, 0.8, 1))
    ax.tick_params(labelsize=TEXT)
    ax.set_xlabel("k, seconds", fontsize=TEXT, color=INK)
    shown = [", ".join(f"{each:.2f}" for each in some) for some in (kept[:4], sped)]
    alt = f"Keeping straight for 0, 1, 2, 3 seconds: {shown[0]}, and so on up to {kept[-1]:.2f} for {len(kept) - 1}. "
    alt += f"Accelerating for 0 to 4 seconds: {shown[1]}: then all crash. Staying behind is worth {staying:.2f}."
    return finish(figure, "From the rule's drive two hills are in reach, one with a cliff", alt)


def found_and_kept(results: Results, printed: Mapping[str, float] | None = None) -> Figure:
    """A square for each agent, a row for each method, which has ten; beside it how many found the way out, and kept it.

    Filled: it found the way out and kept it; empty: found and did not keep it, with a cross if it crashes on most
    roads; a dot: never found it. printed: the paper's success of each method, %, for a last column.
    """
    left, top, tall, counted, crossed = 1.7, 0.85, 0.34, {}, {}
    figure = new_figure(top + tall * len(VARIED) + 0.5)
    ax = axes_at(figure, left, top, 3.5, tall * len(VARIED))
    heads = {1.08: "found", 1.2: "kept"} | ({1.36: "the paper"} if printed else {})
    for x, head in heads.items():
        ax.text(x, 1.03, head, transform=ax.transAxes, ha="center", va="bottom", fontsize=TEXT, color=INK)
    for y, method in enumerate(VARIED):
        way_out, keeps = results.found_and_kept(method)
        found, kept = int(way_out.sum()), int(keeps.sum())
        crash = int((way_out & ~keeps & (results.of(method).scores("accident") > 0.5)).sum())
        n, colour = len(results.of(method)), style(method).colour
        for first, after, fill in ((0, kept, colour), (kept, found, "white")):
            at = range(first, after)
            ax.plot(at, [y] * len(at), "s", ms=8.5, color=fill, mec=colour, mew=1.6)
        ax.plot(range(found - crash, found), [y] * crash, "x", ms=6, color=colour, mew=1.6)
        ax.plot(range(found, n), [y] * (n - found), "o", ms=2.5, color=QUIET)
        cells = [f"{found}", f"{kept}"] + ([f"{printed[method]:.0f} %"] if printed else [])
        for x, words in zip(heads, cells, strict=True):
            ax.text(x, y, words, transform=ax.get_yaxis_transform(), ha="center", va="center", fontsize=TEXT, color=INK)
        keep = "and keep it" if kept == found else f"{kept or 'none'} keep{'' if kept > 1 else 's'} it"
        counted[method] = f"{found} of {n} find the way out{' ' if kept == found else ', '}{keep}"
        crossed[method] = f", {crash} crash{'es' if crash == 1 else ''} on most roads" if crash else ""
    ax.set(xlim=(-0.6, 9.6), ylim=(len(VARIED) - 0.5, -0.5), xticks=())
    ax.set_yticks(range(len(VARIED)), map(display_name, VARIED), fontsize=TEXT, color=INK)
    ax.tick_params(axis="y", length=0)
    for side in ax.spines.values():
        side.set_visible(False)
    key = "An agent each: ■ found and kept   □ found, not kept   ⊠ the same, and crashes on most roads   · not found"
    figure.text(0.012, 0.14 / figure.get_figheight(), key, fontsize=TEXT, color=INK)
    paper = {method: f" (the paper: {rate:.0f} %)" for method, rate in (printed or {}).items()}
    alt = "; ".join(
        f"{display_name(method)}: {words}{crossed[method]}{paper.get(method, '')}" for method, words in counted.items()
    )
    return finish(figure, f"With demonstrations alone {counted['demos']}", f"{alt}.")
