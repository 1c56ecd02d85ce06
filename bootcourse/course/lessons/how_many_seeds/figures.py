"""The figures of the lesson on seeds: each agent's success, and comparisons in which nothing was changed."""

from collections.abc import Sequence

import numpy as np
from matplotlib.figure import Figure

from bootcourse.colours import INK
from bootcourse.course.dots import beside, dots, name_rows
from bootcourse.course.lessons.how_many_seeds import counts
from bootcourse.methods import display_name, style
from bootcourse.plots.figure import GRID, QUIET, SMALL, axes_at, finish, new_figure, plain_axes
from bootcourse.research.results import Results
from bootcourse.research.tables import escaped
from bootcourse.statistics import ESCAPES, bracketed


def who_escapes(results: Results, methods: Sequence[str]) -> Figure:
    """Each agent's success on the held-out roads as a dot, one row for each method; filled if it escapes."""
    height = 1.15 + 0.75 * len(methods)
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
        alt_parts.append(f"{display_name(method)}: {', '.join(f'{each:.0f}' for each in success)} %")
    words = f"success of an agent on the held-out roads (%); filled: {100 * ESCAPES:.0f} % or more (dashed), it escapes"
    name_rows(ax, [display_name(method) for method in methods], words)
    ax.set_xlim(-2, 102)
    everyone = np.concatenate([results.of(method).scores("success") for method in methods])
    split = int(((everyone > 0.9) | (everyone < 0.1)).sum())
    who = f"each of {split} agents gets out" if split == len(everyone) else f"{split} of {len(everyone)} agents get out"
    title = f"Here success is all or nothing: {who} on over 90 % of the roads or on under 10 %"
    return finish(figure, title, f"A dot for each agent. {'; '.join(alt_parts)}.")


def nothing_changed(results: Results) -> Figure:
    """The bootstrapped agents split in half many times: each difference of the two IQMs, with its interval."""
    effects = counts.random_halves(results.of("bootstrapped").scores("returns"))
    wrong = [counts.leaves_out_0(effect) for effect in effects]
    figure = new_figure(3.1)
    ax = axes_at(figure, 0.5, 0.75, 6.3, 2.0)
    plain_axes(ax, "difference of the two IQMs of the return, with its 95 % interval; coloured: leaves out 0")
    ax.axhline(0, color=INK, linewidth=1.2)
    for place, (effect, apart) in enumerate(zip(effects, wrong, strict=True)):
        colour = style("bootstrapped").colour if apart else QUIET
        ax.plot([place] * 2, [effect.low, effect.high], color=colour, linewidth=2.5 if apart else 1.2,
                solid_capstyle="butt")  # fmt: skip
        ax.plot(place, effect.value, "o", color=colour, markersize=5)
    ax.set_xticks([])
    ax.set_xlabel(f"{len(effects)} comparisons, in the order of their differences", fontsize=SMALL, color=INK)
    title = f"Nothing was changed, but in {sum(wrong)} of {len(effects)} comparisons the interval leaves out 0"
    return finish(figure, title, f"In order: {'; '.join(map(bracketed, effects))}.")
