"""What a teacher is worth, each agent as a dot."""

from collections.abc import Iterable, Mapping, Sequence

import numpy as np
from matplotlib.figure import Figure
from matplotlib.ticker import FuncFormatter, LogLocator, NullLocator

from bootcourse.course.shipped import shipped_bound
from bootcourse.episodes.evaluate import drive_episodes, held_out_seeds
from bootcourse.errors import check_known
from bootcourse.learn.teachers import teacher_policy
from bootcourse.methods import display_name, style
from bootcourse.plots.figure import (
    INK,
    QUIET,
    SMALL,
    TEXT,
    finish,
    new_figure,
    plain_axes,
)
from bootcourse.research.beyond import at_budget
from bootcourse.research.jobs import HELD_OUT
from bootcourse.research.teacher_worth import QUANTITIES, TAUGHT, Cells, in_words
from bootcourse.research.teachers import PLANNER, TEACHERS

ROW, HEAD, FOOT, NAMES = 0.42, 0.85, 0.6, 1.75  # inches


def teacher_value(computed: Cells, quantity: str, own: Mapping[str, float] | None = None, title: str = "") -> Figure:
    """A dot for each agent; the bar is the estimate of `QUANTITIES`, the line its 95 % interval over seeds.

    computed: what `shipped_teachers` returns; quantity: one of `QUANTITIES`; own: of the teachers themselves, a green
    line in each row; title: by default the lowest and the highest cell. An agent that does not reach a number of
    decisions is an open dot at the right edge. Raises BootcourseError for another quantity.
    """
    check_known("Quantity", quantity, QUANTITIES)
    shown = QUANTITIES[quantity]
    values = {place: shown.of_agents(results) for place, results in computed.items()}
    estimates = {place: shown.estimate(each) for place, each in values.items()}
    rows = [teacher for teacher in TEACHERS if any(teacher == each for each, _ in computed)]
    methods = [method for method in TAUGHT if any(method == each for _, each in computed)]
    height, (low, high) = HEAD + ROW * len(rows) + FOOT, _limits(values.values(), shown.logarithmic)
    figure, across = new_figure(height, 9.0), (8.9 - NAMES) / len(methods)
    for column, method in enumerate(methods):
        place = ((NAMES + column * across) / 9, FOOT / height, (across - 0.2) / 9, ROW * len(rows) / height)
        ax, colour = figure.add_axes(place), style(method).colour
        plain_axes(ax, display_name(method), grid="x")
        for row, teacher in enumerate(rows):
            if (teacher, method) in computed:
                _draw(ax, row, values[teacher, method], estimates[teacher, method], colour, high)
                if own is not None:
                    green = style("rule").colour
                    ax.plot([own[teacher]] * 2, [row - 0.45, row + 0.45], color=green, linewidth=2.5, zorder=2)
            else:
                ax.text(0.5, row, "not run", transform=ax.get_yaxis_transform(), ha="center", va="center",
                        fontsize=SMALL, color=QUIET)  # fmt: skip
        if shown.logarithmic:
            ax.set_xscale("log")
            ax.xaxis.set_major_locator(LogLocator(subs=(1,) if high > 50 * low else (1, 2, 5)))
            ax.xaxis.set_minor_locator(NullLocator())
            ax.xaxis.set_major_formatter(FuncFormatter(lambda value, _: f"{value:g}"))
        ax.set(xlim=(low, high), ylim=(len(rows) - 0.5, -0.5))
        ax.set_yticks(range(len(rows)), [TEACHERS[row].words if column == 0 else "" for row in rows])
        ax.tick_params(axis="y", labelcolor=INK, labelsize=TEXT)
    words = f"{shown.label}. Dots: agents; bar and line: their estimate and its 95 % interval"
    words += "; open dots at the right: not reached." * (quantity == "decisions") or "."
    figure.text(0.012, 0.12 / height, words[0].upper() + words[1:], fontsize=SMALL, color=QUIET)
    words += " Green line: the teacher itself." * (own is not None)
    alt_parts = [f"{_named(place)}: {' '.join(in_words(each)).strip()}" for place, each in estimates.items()]
    return finish(figure, title or _title(shown.label, estimates), f"{words} {'; '.join(alt_parts)}.")


def _draw(ax, row: int, values: np.ndarray, estimate, colour: str, edge: float) -> None:
    """The agents of a cell, their estimate and its interval; what is infinite stands at the edge."""
    places = row + np.linspace(-0.28, 0.28, len(values)) if len(values) > 1 else [row]
    fills = np.where(np.isfinite(values), colour, "white")
    shown = np.minimum(values, edge)
    ax.scatter(shown, places, s=14, c=fills, edgecolors=colour, linewidths=0.9, alpha=0.8, zorder=3, clip_on=False)
    value, low, high = np.minimum(estimate, edge)
    ax.plot([low, high], [row, row], color=INK, linewidth=1, zorder=4)
    ax.plot([value, value], [row - 0.32, row + 0.32], color=INK, linewidth=2, zorder=4)


def _limits(values, logarithmic: bool) -> tuple[float, float]:
    """The range of the axes: all finite values and a little air, from 0 where none is negative."""
    each = np.concatenate(list(values))
    each = each[np.isfinite(each)] if np.isfinite(each).any() else np.ones(1)
    if logarithmic:
        return each.min() / 1.5, each.max() * 2
    air = 0.06 * (np.ptp(each) or 1.0)
    return (each.min() - air if each.min() < 0 else -air), each.max() + air


def _named(place: tuple[str, str]) -> str:
    return f"{TEACHERS[place[0]].words}, {display_name(place[1])}"


def _title(label: str, estimates: dict) -> str:
    """The lowest and the highest cell, as a sentence."""
    finite = {place: each.value for place, each in estimates.items() if np.isfinite(each.value)}
    name = label[0].upper() + label[1:]
    if not finite:
        return f"{name}: not reached in half of the agents of any cell"
    ends = [min(finite, key=finite.get), max(finite, key=finite.get)]
    low, high = (f"{in_words(estimates[place])[0]} ({_named(place)})" for place in ends)
    return f"{name}: from {low} to {high}"


def equal_table(computed: Cells, budgets: Sequence[tuple[str, int]]) -> tuple[list[str], list[list[str]]]:
    """(headings, rows): how often each teacher's agents were ahead in training, in %, at equal numbers of decisions.

    budgets: (method, decisions) of each column. A cell is a mean over agents, see `at_budget`; "–" where an agent's
    training was shorter.
    """
    rows = []
    for teacher in dict.fromkeys(teacher for teacher, _ in computed):
        row = [TEACHERS[teacher].words]
        for method, decisions in budgets:
            results = computed.get((teacher, method))
            ahead = np.nan if results is None else 100 * at_budget(results.curves, decisions, "success").mean()
            row.append("–" if np.isnan(ahead) else f"{ahead:.0f}")
        rows.append(row)
    columns = [f"{display_name(method)}, {decisions / 1000:g} thousand" for method, decisions in budgets]
    return ["ahead in training, %, after so many decisions", *columns], rows


def own_returns(teachers: Iterable[str]) -> dict[str, float]:
    """What each teacher earns itself on 200 of the study's held-out roads; the planner: its bound on all of them."""
    roads = held_out_seeds(HELD_OUT, 200)
    drives = {name: drive_episodes(teacher_policy(TEACHERS[name].rule), roads) for name in teachers if name != PLANNER}
    return {name: drive.returns.mean() for name, drive in drives.items()} | {PLANNER: shipped_bound().mean()}
