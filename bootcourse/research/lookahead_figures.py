"""The figures and the table of the experiment on looking ahead (`lookahead.py`).

Accidents are counted over all drives of a base policy's agents, with the exact (Clopper-Pearson) interval of so many
independent drives; returns are means of the agents' means, with a bootstrap interval over agents.
"""

from collections.abc import Sequence
from typing import NamedTuple

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.ticker import NullLocator

from bootcourse.episodes.lookahead import HORIZON
from bootcourse.episodes.models import MODELS
from bootcourse.methods import display_name, style
from bootcourse.plots.figure import GRID, INK, QUIET, SMALL, TEXT, finish, new_figure, plain_axes, wrapped
from bootcourse.research.lookahead import BASES, CLOSELY, FORMS, HORIZONS, Cell, Summary
from bootcourse.statistics import Estimate, interval, rate

FORM_NAMES = {"alone": "alone", "rollout": "rollouts", "shield": "shield by simulation"}
FARTHEST = 20.0  # below the base policy's return, on the axis of returns
MOST = 100  # training seeds of a base policy
LINEAR = 1.0  # accidents in 1,000 drives: the axis is linear below, logarithmic above


class Score(NamedTuple):
    """What some agents of a base policy reached, each on the same roads."""

    agents: int
    drives: int
    returns: Estimate
    accidents: int
    accident_rate: Estimate
    success: float  # share of the drives
    overruled: float  # share of the decisions
    milliseconds: float  # for each decision


def score(
    cells: dict[str, Summary], base: str, form: str, horizon: int = HORIZON, model: str = "exact", roads: int = 1000
) -> Score | None:
    """The score of the agents of a base policy; None if none of them is in `cells`, see `lookahead.summaries`."""
    wanted = (Cell(base, seed, form, horizon, model, roads).file for seed in range(MOST))
    mine = [cells[file] for file in wanted if file in cells]
    if not mine:
        return None
    drives, accidents = sum(one.roads for one in mine), sum(one.accidents for one in mine)
    decisions = sum(one.decisions for one in mine)
    return Score(
        agents=len(mine),
        drives=drives,
        returns=interval([one.returns for one in mine], np.mean),
        accidents=accidents,
        accident_rate=rate(np.arange(drives) < accidents),
        success=float(np.mean([one.success for one in mine])),
        overruled=sum(one.overruled for one in mine) / decisions,
        milliseconds=1000 * sum(one.seconds for one in mine) / decisions,
    )


def rows(cells: dict[str, Summary]) -> tuple[list[str], list[list[str]]]:
    """(headings, rows): every combination of base, form, horizon, model and roads that is there."""
    kinds = [(base, form, HORIZON, "exact") for base in BASES for form in FORMS]
    kinds += [(base, "rollout", horizon, "exact") for base in CLOSELY for horizon in HORIZONS]
    kinds += [
        (base, form, HORIZON, model) for base in CLOSELY for model in MODELS if model != "exact" for form in FORMS
    ]
    lines = []
    for roads in (1000, 10_000):
        for base, form, horizon, model in kinds:
            if one := score(cells, base, form, horizon, model, roads):
                value, low, high = one.returns
                about = f"{value:.1f}" + (f" [{low:.1f}, {high:.1f}]" if np.isfinite(low) else "")
                low, high = (1000 * limit for limit in one.accident_rate[1:])
                accidents = (
                    f"{one.accidents} in {one.drives:,}: {1000 * one.accident_rate.value:.2f} [{low:.2f}, {high:.2f}]"
                )
                lines.append(
                    [display_name(base), FORM_NAMES[form], str(horizon) if form != "alone" else "", model]
                    + [str(one.agents), about, accidents, f"{100 * one.success:.1f}", f"{1000 * one.overruled:.1f}"]
                )
    headings = ["base policy", "form", "horizon", "model", "agents", "return [95 %]", "accidents in 1,000 [95 %]"]
    return [*headings, "ahead, %", "overruled in 1,000"], lines


def _accident_axis(axis_of: Axes, axis: str) -> None:
    """Accidents in 1,000 drives: logarithmic, and linear near 0, where a bar may end."""
    getattr(axis_of, f"set_{axis}scale")("symlog", linthresh=LINEAR, linscale=0.6)
    getattr(axis_of, f"set_{axis}ticks")([0, 1, 10, 100, 1000], ["0", "1", "10", "100", "1,000"])
    getattr(axis_of, f"set_{axis}lim")(-0.04, 1100)
    getattr(axis_of, f"{axis}axis").set_minor_locator(NullLocator())


def double_line(ax: Axes, x: Sequence[float], y: Sequence[float], colour: str) -> None:
    """The line of a look-ahead: the base policy's colour, with a white line along its middle."""
    ax.plot(x, y, color=colour, linewidth=4.5, solid_capstyle="butt", zorder=2.5)
    ax.plot(x, y, color="white", linewidth=1.6, solid_capstyle="butt", zorder=2.6)


def by_horizon(cells: dict[str, Summary]) -> Figure:
    """Return and accidents against the horizon; 0 is the base policy alone."""
    figure, words = new_figure(3.9, 9.0), []
    axes = [figure.add_axes((left, 0.15, 0.4, 0.6)) for left in (0.055, 0.565)]
    for ax, label in zip(axes, ("return", "accidents in 1,000 drives"), strict=True):
        plain_axes(ax, label)
        ax.set_xlabel("decisions ahead; 0: the base policy alone", fontsize=TEXT, color=INK)
    _accident_axis(axes[1], "y")
    changes = []
    for base in CLOSELY:
        reached = {0: score(cells, base, "alone")}
        reached |= {h: score(cells, base, "rollout", h) for h in sorted((*HORIZONS, HORIZON))}
        reached = {h: one for h, one in reached.items() if one is not None}
        colour, at = style(base).colour, list(reached)
        returns = [one.returns for one in reached.values()]
        rates = [[1000 * value for value in one.accident_rate] for one in reached.values()]
        for ax, estimates in zip(axes, (returns, rates), strict=True):
            middle, low, high = np.array(estimates).T
            double_line(ax, at, middle, colour)
            ax.errorbar(at, middle, [middle - low, high - middle], fmt="o", color=colour, ms=5, lw=1.3, zorder=3)
            ax.set_xticks(at)
        last, before, after = (reached[h] for h in (at[-1], 0, HORIZON if HORIZON in reached else at[-1]))
        counts = (f"{one.accidents:,} accidents in {one.drives:,} drives" for one in (before, after))
        changes.append(f"{display_name(base)} from {' to '.join(counts)}")
        name = f"{display_name(base)}, {last.agents} agents"
        axes[0].annotate(name, (at[-1], returns[-1].value), xytext=(0, -14 if base != CLOSELY[0] else 8),
                         textcoords="offset points", ha="right", fontsize=TEXT, color=colour)  # fmt: skip
        numbers = (
            f"{h}: return {one.returns.value:.1f}, accidents {1000 * one.accident_rate.value:.1f}"
            for h, one in reached.items()
        )
        words.append(f"{name}: {'; '.join(numbers)}.")
    axes[0].margins(y=0.12)
    title = f"Rollouts of {HORIZON} decisions: {', '.join(changes)}"
    alt = "Return, and accidents in 1,000 drives, against how many decisions are imagined. " + " ".join(words)
    return finish(figure, title, alt)


def _name_what_is_off(ax: Axes, scores_of: dict[float, dict[str, Score]], names: list[str], least: float) -> None:
    """Write the returns below `least` at the left edge. scores_of: {height in its row: {model: score}}."""
    for shift, scores in scores_of.items():
        for model, one in scores.items():
            if one.returns.value < least:
                place = (least, names.index(model) + shift)
                ax.annotate(f"◂ {one.returns.value:.1f}", place, va="center", fontsize=SMALL, color=INK)


def wrong_models(cells: dict[str, Summary], base: str = CLOSELY[0]) -> Figure:
    """Accidents and return with each wrong model, as full rollouts and as a shield, and of the base policy alone."""
    alone, names = score(cells, base, "alone"), list(MODELS)
    height, colour = 1.55 + 0.42 * len(names), style(base).colour
    figure = new_figure(height, 9.0)
    tall = 0.42 * len(names) / height
    axes = [figure.add_axes((left, 0.6 / height, 0.34, tall)) for left in (0.255, 0.635)]
    measures = (
        ("accidents in 1,000 drives", lambda one: [1000 * value for value in one.accident_rate]),
        ("return", lambda one: list(one.returns)),
    )
    words, better, scores_of = [], {}, {}
    for form, shift, fill in (("rollout", -0.14, colour), ("shield", 0.14, "white")):
        scores = {name: score(cells, base, form, model=name) for name in names}
        scores = {name: one for name, one in scores.items() if one is not None}
        scores_of[shift] = scores
        wrong = [one for name, one in scores.items() if name != "exact"]
        better[form] = f"{sum(one.accidents < alone.accidents for one in wrong)} of {len(wrong)}"
        for ax, (_, of) in zip(axes, measures, strict=True):
            middle, low, high = np.array([of(one) for one in scores.values()]).T
            at = [names.index(name) + shift for name in scores]
            ax.errorbar(middle, at, xerr=[middle - low, high - middle], fmt="o" if form == "rollout" else "s",
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
    axes[0].set_yticks(range(len(names)), names, fontsize=TEXT, color=INK)
    axes[1].set_yticks([])
    axes[0].text(alone.accident_rate.value * 1000, -0.62, "alone", ha="center", fontsize=SMALL, color=QUIET)
    axes[1].text(alone.returns.value, -0.62, "alone", ha="center", fontsize=SMALL, color=QUIET)
    agents = f"{alone.agents} agent{'s' * (alone.agents > 1)}, {alone.drives // alone.agents:,} roads each"
    legend = f"● rollouts    □ shield by simulation    {agents}"
    figure.text(0.012, 0.1 / height, legend, fontsize=SMALL, color=INK)
    title = (
        f"{display_name(base)}, looking ahead with a wrong model: rollouts crash less than the base policy with "
        f"{better['rollout']} models, the shield with {better['shield']}"
    )
    alt = (
        f"For each model, accidents in 1,000 drives and the return. Alone: {1000 * alone.accident_rate.value:.1f} and "
        f"{alone.returns.value:.1f}. {' '.join(words)}"
    )
    return finish(figure, wrapped(title, 88), alt)
