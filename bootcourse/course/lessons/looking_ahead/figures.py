"""The figures of this lesson: what looking ahead gains at each horizon, and what a wrong model costs.

Both take the results of the experiment `look-ahead`, {cell: agents}; see bootcourse.research.lookahead for the scores.
"""

from collections.abc import Container, Sequence

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.ticker import NullLocator

from bootcourse.episodes.lookahead import HORIZON
from bootcourse.episodes.models import MODELS
from bootcourse.errors import BootcourseError
from bootcourse.methods import display_name, style
from bootcourse.plots.figure import GRID, INK, QUIET, SMALL, TEXT, axes_at, finish, new_figure, plain_axes
from bootcourse.research.lookahead import CLOSELY, FORM_NAMES, FORMS, HORIZONS, Cell, Score, score
from bootcourse.research.results import Results

FARTHEST = 20.0  # below the base policy's return, on the axis of returns
LINEAR = 1.0  # accidents in 1,000 drives: the axis is linear below, logarithmic above


def _accident_axis(axis_of: Axes, axis: str) -> None:
    """Accidents in 1,000 drives: logarithmic, and linear near 0, where a bar may end."""
    getattr(axis_of, f"set_{axis}scale")("symlog", linthresh=LINEAR, linscale=0.6)
    getattr(axis_of, f"set_{axis}ticks")([0, 1, 10, 100, 1000], ["0", "1", "10", "100", "1,000"])
    getattr(axis_of, f"set_{axis}lim")(-0.15, 1400)
    getattr(axis_of, f"{axis}axis").set_minor_locator(NullLocator())


def double_line(ax: Axes, x: Sequence[float], y: Sequence[float], colour: str) -> None:
    """The line of a look-ahead: the base policy's colour, with a white line along its middle."""
    ax.plot(x, y, color=colour, linewidth=4.5, solid_capstyle="butt", zorder=2.5)
    ax.plot(x, y, color="white", linewidth=1.6, solid_capstyle="butt", zorder=2.6)


def by_horizon(cells: dict[str, Results], base: str, title: str) -> Figure:
    """Two panels over the number of decisions that a base policy's agents look ahead; 0: the agents alone."""
    figure, colour = new_figure(3.6), style(base).colour
    of = {h: score(cells, Cell(base, "rollouts" if h else "alone", horizon=h or HORIZON))
          for h in (0, *sorted((*HORIZONS, HORIZON)))}  # fmt: skip
    measures = {
        "return": [one.returns for one in of.values()],
        "accidents in 1,000 drives": [[1000 * value for value in one.accident_rate] for one in of.values()],
    }
    alt_parts = []
    for left, (words, estimates) in zip((0.45, 3.95), measures.items(), strict=True):
        ax = axes_at(figure, left, 0.95, 2.85, 2.05)
        plain_axes(ax, words)
        middle, low, high = np.array(estimates).T
        double_line(ax, list(of), middle, colour)
        ax.errorbar(list(of), middle, [middle - low, high - middle], fmt="o", color=colour, ms=5, lw=1.3, zorder=3)
        ax.set_xticks(list(of), ["alone", *map(str, list(of)[1:])])
        ax.xaxis.set_minor_locator(NullLocator())
        ax.set_xlabel("decisions ahead", fontsize=TEXT, color=INK)
        ax.set_ylim((0, 1.1 * high.max()) if words.startswith("accidents") else (low.min() - 2, high.max() + 2))
        alt_parts.append(f"{words}: {', '.join(f'{m:.1f} at {h}' for h, m in zip(of, middle, strict=True))}")
    return finish(figure, title, f"{'; '.join(alt_parts)}.")


def _check_computed(there: Container, wanted: Sequence, base: str) -> None:
    if missing := [str(one) for one in wanted if one not in there]:
        raise BootcourseError(
            f"These results of {base} lack {', '.join(missing)}: run `bootcourse study look-ahead --out DIR`."
        )


def _name_what_is_off(ax: Axes, scores_of: dict[float, dict[str, Score]], names: list[str], least: float) -> None:
    """Write the returns below `least` at the left edge. scores_of: {height in its row: {model: score}}."""
    for shift, scores in scores_of.items():
        for model, one in scores.items():
            if one.returns.value < least:
                place = (least, names.index(model) + shift)
                ax.annotate(f"◂ {one.returns.value:.1f}", place, va="center", fontsize=SMALL, color=INK)


def wrong_models(cells: dict[str, Results], base: str = CLOSELY[0]) -> Figure:
    """Accidents and return with each wrong model, as full rollouts and as a shield, and of the base policy alone.

    Raises BootcourseError if the base policy alone, or any of the two with the exact model, was not computed.
    """
    alone, names = score(cells, Cell(base, "alone")), list(MODELS)
    _check_computed(cells, [Cell(base, form).name for form in FORMS], base)
    height, colour = 1.55 + 0.42 * len(names), style(base).colour
    figure = new_figure(height, 9.0)
    tall = 0.42 * len(names) / height
    axes = [figure.add_axes((left, 0.6 / height, 0.34, tall)) for left in (0.255, 0.635)]
    measures = (
        ("accidents in 1,000 drives", lambda one: [1000 * value for value in one.accident_rate]),
        ("return", lambda one: list(one.returns)),
    )
    words, better, scores_of = [], {}, {}
    for form, shift, fill in (("rollouts", -0.14, colour), ("shield", 0.14, "white")):
        scores = {name: one for name in names if (one := score(cells, Cell(base, form, model=name)))}
        scores_of[shift] = scores
        wrong = [one for name, one in scores.items() if name != "exact"]
        better[form] = f"{sum(one.accident_rate.value < alone.accident_rate.value for one in wrong)} of {len(wrong)}"
        for ax, (_, of) in zip(axes, measures, strict=True):
            middle, low, high = np.array([of(one) for one in scores.values()]).T
            at = [names.index(name) + shift for name in scores]
            ax.errorbar(middle, at, xerr=[middle - low, high - middle], fmt="o" if form == "rollouts" else "s",
                        color=colour, mfc=fill, mec=colour, mew=1.5, ms=6, lw=1.3, zorder=3)  # fmt: skip
        numbers = (
            f"{name} {1000 * one.accident_rate.value:.1f} and {one.returns.value:.1f}" for name, one in scores.items()
        )
        words.append(f"{FORM_NAMES[form]}: {'; '.join(numbers)}.")
    for ax, (label, of) in zip(axes, measures, strict=True):
        plain_axes(ax, "", grid="x")
        value, low, high = of(alone)
        ax.axvspan(low, high, color=QUIET, alpha=0.15, linewidth=0, zorder=0)
        ax.axvline(value, color=QUIET, linewidth=1.2, linestyle=(0, (4, 3)), zorder=1)
        ax.set_ylim(len(names) - 0.5, -0.5)
        ax.set_xlabel(label, fontsize=TEXT, color=INK)
        ax.spines["bottom"].set_color(GRID)
    _accident_axis(axes[0], "x")
    low, high = axes[1].get_xlim()
    if low < alone.returns.value - FARTHEST:  # where everything crashes: off the axis, and said in words
        axes[1].set_xlim(alone.returns.value - FARTHEST, high)
        _name_what_is_off(axes[1], scores_of, names, alone.returns.value - FARTHEST)
    axes[0].set_yticks(range(len(names)), [name.replace(", ", ",\n") for name in names], fontsize=TEXT, color=INK)
    axes[1].set_yticks([])
    axes[0].text(alone.accident_rate.value * 1000, -0.62, "alone", ha="center", fontsize=SMALL, color=QUIET)
    axes[1].text(alone.returns.value, -0.62, "alone", ha="center", fontsize=SMALL, color=QUIET)
    legend = f"● rollouts{_drives(scores_of[-0.14])}    □ shield by simulation{_drives(scores_of[0.14])}"
    figure.text(0.012, 0.1 / height, legend, fontsize=SMALL, color=INK)
    title = (
        f"With a wrong model {display_name(base)} has fewer accidents than alone: by the shield with "
        f"{better['shield']} models, by rollouts with {better['rollouts']}"
    )
    alt = (
        f"For each model, accidents in 1,000 drives and the return. Alone: {1000 * alone.accident_rate.value:.1f} and "
        f"{alone.returns.value:.1f}. {' '.join(words)}"
    )
    return finish(figure, title, alt)


def _drives(scores: dict[str, Score]) -> str:
    """ " (10 agents × 300 to 1,000 roads)", of all models."""
    agents, roads = ({getattr(one, name) for one in scores.values()} for name in ("agents", "roads"))
    agents, roads = (" to ".join(f"{n:,}" for n in sorted({min(each), max(each)})) for each in (agents, roads))
    return f" ({agents} agents × {roads} roads)"
