"""The figures of the lesson on seeds: each agent's success, our rates beside the paper's, and who wins each pair."""

from collections.abc import Sequence

import numpy as np
from matplotlib.colors import ListedColormap
from matplotlib.figure import Figure

from bootcourse.course.dots import beside, dots, name_rows
from bootcourse.methods import display_name, style
from bootcourse.plots.figure import INK, QUIET, SMALL, TEXT, finish, new_figure, one_axes, plain_axes
from bootcourse.research.paper import PRINTED
from bootcourse.research.results import Results
from bootcourse.research.tables import escaped
from bootcourse.statistics import ESCAPES, escapes, improvement, rate


def who_escapes(results: Results, methods: Sequence[str]) -> Figure:
    """Each agent's success on the held-out roads as a dot, one row for each method; filled if it escapes."""
    height = 1.15 + 0.75 * len(methods)
    figure, alt_parts = new_figure(height), []
    ax = figure.add_axes((0.24, 0.5 / height, 0.57, 1 - 1.1 / height))
    ax.axvline(100 * ESCAPES, color=QUIET, linewidth=1, linestyle=(0, (2, 2)), zorder=1)
    for row, method in enumerate(methods):
        success, colour = 100 * results.of(method).scores("success"), style(method).colour
        dots(ax, success, row, colour, success >= 100 * ESCAPES, spread=0.38)
        one = (success >= 100 * ESCAPES).sum() == 1
        words = f"{escaped(results, method)} escape{'s' if one else ''}"
        beside(ax, row, words)
        alt_parts.append(f"{display_name(method)}: {', '.join(f'{each:.0f}' for each in success)} %")
    words = f"success of an agent on the held-out roads (%); filled: {100 * ESCAPES:.0f} % or more (dashed), it escapes"
    name_rows(ax, [display_name(method) for method in methods], words)
    ax.set_xlim(-2, 102)
    everyone = np.concatenate([results.of(method).scores("success") for method in methods])
    split = int(((everyone > 0.9) | (everyone < 0.1)).sum())
    who = f"each of {split} agents gets out" if split == len(everyone) else f"{split} of {len(everyone)} agents get out"
    title = f"Success is all or nothing: {who} on over 90 % of the roads or on under 10 %"
    return finish(figure, title, f"A dot for each agent. {'; '.join(alt_parts)}.")


def beside_the_paper(results: Results, methods: Sequence[str]) -> Figure:
    """Each method's rate of escape with its exact interval: of our agents, and of one that drove all of the paper's."""
    title = "With one agent behind each of its rates, the paper's intervals overlap ours"
    figure, ax = one_axes(3.6, title, "rate of escape (%) with its exact 95 % interval", "")
    ax.set_position((0.2, 0.17, 0.56, 0.66))
    plain_axes(ax, "", grid="x")
    alt = []
    for row, method in enumerate(methods):
        ours, one = escapes(results.of(method).scores("success")), PRINTED[method]["success"].mean
        theirs = rate(np.array([one >= 100 * ESCAPES]))  # does the one agent escape?
        words = f"ours: {escaped(results, method)}", f"the paper's {one:g} %: {theirs.value:.0f} of 1"
        rows = (row - 0.17, ours, words[0], style(method).colour), (row + 0.17, theirs, words[1], QUIET)
        for place, each, says, colour in rows:
            value, low, high = (100 * part for part in each)
            ax.plot([low, high], [place] * 2, color=colour, linewidth=5, alpha=0.55, solid_capstyle="butt")
            ax.plot(value, place, "o", color=colour, ms=6, clip_on=False)
            ax.text(1.03, place, says, transform=ax.get_yaxis_transform(), va="center", fontsize=SMALL, color=INK)
            alt.append(f"{display_name(method)}, {says} ({low:.0f} to {high:.0f} %)")
    ax.set_yticks(range(len(methods)), [display_name(method) for method in methods])
    ax.tick_params(axis="y", labelcolor=INK, labelsize=TEXT)
    ax.set(xlim=(0, 100), ylim=(len(methods) - 0.5, -0.5))
    return finish(figure, title, f"{'; '.join(alt)}.")


def pairs(results: Results, first: str, second: str) -> Figure:
    """Each pair of an agent of two methods as a square, in the colour of the one that earns more."""
    ours, theirs = (np.sort(results.of(method).scores("returns")) for method in (first, second))
    wins, found = ours[:, None] > theirs, improvement(ours, theirs)
    low, high = (f"{100 * end:.0f}" for end in found[1:])
    title = f"In {wins.sum()} of {wins.size} pairs {display_name(first)} earns more (95 % interval: {low} to {high})"
    figure, ax = one_axes(4.2, title, f"return of an agent: {display_name(second)}", "")
    ax.set_position((0.2, 0.14, 0.5, 0.72))
    colours = ListedColormap([style(second).colour, style(first).colour])
    ax.pcolormesh(wins, cmap=colours, edgecolors="white", linewidth=2)
    for ticks, group in ((ax.set_xticks, theirs), (ax.set_yticks, ours)):
        ticks(np.arange(len(group)) + 0.5, [f"{each:.0f}".replace("-", "−") for each in group])
    ax.set_ylabel(f"return of an agent: {display_name(first)}", fontsize=TEXT, color=INK, rotation=90, ha="center")
    ax.yaxis.set_label_coords(-0.13, 0.5)
    for height, method, count in ((0.75, first, wins.sum()), (0.55, second, (~wins).sum())):
        words = f"■ {display_name(method)}\n    earns more: {count}"
        ax.text(1.04, height, words, transform=ax.transAxes, fontsize=TEXT, color=style(method).colour, va="center")
    return finish(figure, title, "A square for each pair, in the order of the returns.")
