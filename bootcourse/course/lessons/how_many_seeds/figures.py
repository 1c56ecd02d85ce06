"""The figures of the lesson on seeds: each agent's success, comparisons without a change, and new agents."""

from collections.abc import Callable, Mapping, Sequence

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from bootcourse.colours import INK
from bootcourse.course.dots import beside, dots, name_rows
from bootcourse.course.lessons.how_many_seeds import counts
from bootcourse.methods import display_name, style
from bootcourse.plots.figure import GRID, QUIET, SMALL, TEXT, axes_at, finish, new_figure, plain_axes
from bootcourse.research.results import Results
from bootcourse.research.tables import escaped
from bootcourse.statistics import ESCAPES


def who_escapes(results: Results, methods: Sequence[str]) -> Figure:
    """Each agent's success on the held-out roads as a dot, one row for each method; filled if it escapes."""
    height = 1.15 + 0.6 * len(methods)
    figure, alt_parts = new_figure(height), []
    ax = figure.add_axes((0.24, 0.5 / height, 0.57, 1 - 1.1 / height))
    ax.axvline(100 * ESCAPES, color=QUIET, linewidth=1, linestyle=(0, (2, 2)), zorder=1)
    for row, method in enumerate(methods):
        if row:
            ax.axhline(row - 0.5, color=GRID, linewidth=1, zorder=0)
        success, colour = 100 * results.of(method).scores("success"), style(method).colour
        dots(ax, success, row, colour, success >= 100 * ESCAPES, spread=0.27)
        one = (success >= 100 * ESCAPES).sum() == 1
        words = f"{escaped(results, method)} escape{'s' if one else ''}"
        beside(ax, row, words)
        ax.texts[-1].set_fontsize(TEXT)
        alt_parts.append(f"{display_name(method)}: {', '.join(f'{each:.0f}' for each in success)} %")
    words = f"success of an agent on the held-out roads (%); filled: {100 * ESCAPES:.0f} % or more (dashed), it escapes"
    name_rows(ax, [display_name(method) for method in methods], words)
    in_large_letters(ax)
    ax.set_xlim(-2, 102)
    everyone = np.concatenate([results.of(method).scores("success") for method in methods])
    split = int(((everyone > 0.9) | (everyone < 0.1)).sum())
    who = f"each of {split} agents gets out" if split == len(everyone) else f"{split} of {len(everyone)} agents get out"
    title = f"Here success is all or nothing: {who} on over 90 % of the roads or on under 10 %"
    return finish(figure, title, f"A dot for each agent. {'; '.join(alt_parts)}.")


def in_large_letters(ax: Axes) -> None:
    """The numbers of the scale below, and what they mean, as large as the rows' names."""
    ax.tick_params(axis="x", labelsize=TEXT)
    ax.xaxis.label.set_fontsize(TEXT)


def nothing_changed(results: Results) -> Figure:
    """Five of the bootstrapped agents less five, drawn often: each difference of the two IQMs, with its interval."""
    effects = counts.drawn_twice(results.of("bootstrapped").scores("returns"))
    wrong = [counts.leaves_out_0(effect) for effect in effects]
    figure = new_figure(3.5)
    ax = axes_at(figure, 0.5, 0.75, 6.3, 2.4)
    plain_axes(ax, "difference of the two IQMs of the return, with its 95 % interval; orange: leaves out 0")
    ax.axhline(0, color=INK, linewidth=1.2, zorder=4)
    for place, (effect, apart) in enumerate(zip(effects, wrong, strict=True)):
        colour = style("bootstrapped").colour if apart else "#B8BEC6"
        ax.plot([place] * 2, [effect.low, effect.high], color=colour, linewidth=2.5, solid_capstyle="butt", zorder=2)
        ax.plot(place, effect.value, "o", color=colour, markeredgecolor=INK, markeredgewidth=0.4, markersize=3.5)
    first = wrong.index(True)
    words = f"the first: {counts.with_ends(effects[first])}".replace("-", "−")
    ax.text(first, -152, words, fontsize=TEXT, color=style("bootstrapped").colour, va="top")
    ax.set_ylim(-185, 150)
    ax.set_xticks([])
    ax.set_xlabel(f"{len(effects)} comparisons, in the order of their differences", fontsize=SMALL, color=INK)
    title = f"Nothing was changed, but in {sum(wrong)} of {len(effects)} comparisons the interval leaves out 0"
    out = [counts.with_ends(effect) for effect, apart in zip(effects, wrong, strict=True) if apart]
    return finish(figure, title, f"Those that leave out 0: {'; '.join(out)}.")


def new_agents(new: Mapping[str, Results], success: Mapping[str, np.ndarray], interval_of: Callable) -> Figure:
    """The student's difference of two groups, and that of 5, 10, 20 and 40 new agents of each: with intervals."""
    sizes = [5, 10, 20, len(new["changed"])]
    effects = [counts.effect_of(success, interval_of), *(counts.of_new_agents(new, each) for each in sizes)]
    names = [f"yours: {len(success['changed'])} of each", *(f"new: {each} of each" for each in sizes)]
    figure = new_figure(2.9)
    ax = axes_at(figure, 1.25, 0.45, 4.6, 1.9)
    ax.axvline(0, color=INK, linewidth=1.2, zorder=1)
    for row, effect in enumerate(effects):
        colour = style("bootstrapped").colour if row else QUIET
        ax.plot([effect.low, effect.high], [row] * 2, color=colour, linewidth=3, solid_capstyle="butt")
        ax.plot(effect.value, row, "o", color=colour, markersize=7)
        beside(ax, row, counts.with_ends(effect).replace("-", "−"))
        ax.texts[-1].set_fontsize(TEXT)
    name_rows(ax, names, "success: changed less unchanged, in points (IQM, 95 % interval); new: without the bonus")
    in_large_letters(ax)
    title = f"With {sizes[-1]} of each, a difference above {effects[-1].high:.0f} points is not believable"
    said = "; ".join(f"{name}, {counts.with_ends(effect)}" for name, effect in zip(names, effects, strict=True))
    return finish(figure, title, f"Differences: {said}.")
