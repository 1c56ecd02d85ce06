"""Two plain charts for lessons: lines over a number, and bars over the nine actions, both labelled directly."""

from collections.abc import Mapping, Sequence

import numpy as np
from matplotlib.figure import Figure

from bootcourse.methods import style
from bootcourse.plots.figure import (
    INK,
    QUIET,
    SMALL,
    TEXT,
    finish,
    label_ends,
    new_figure,
    plain_axes,
    styles,
    wrapped,
)
from bootcourse.scenario import ACTION_NAMES


def lines(
    x: Sequence[float],
    named: Mapping[str, np.ndarray],
    title: str,
    x_label: str,
    y_label: str,
    logarithmic: str = "",
    marks: Mapping[str, float] | None = None,
) -> Figure:
    """Lines over x (points,), each with its name at its end; a value (lines, points) is drawn as thin lines.

    logarithmic: "x", "y" or "xy". marks: {words: y}, thin horizontal lines. A name that begins with a
    method's ("sac", "rule") gets its colour. The alt text gives every line's first and last value.
    """
    figure = new_figure(3.6)
    ax = figure.add_axes((0.09, 0.16, 0.66, 0.66 - 0.05 * wrapped(title).count("\n")))
    ends = []
    for label, look in zip(named, styles(list(named)), strict=True):
        values = np.atleast_2d(np.asarray(named[label], dtype=float))
        ax.plot(x, values.T, color=look.colour, linestyle=look.line, linewidth=2 if len(values) == 1 else 1.1)
        ends.append((float(values[:, -1].max()), label, look.colour))
    for words, y in (marks or {}).items():
        ax.axhline(y, color=QUIET, linewidth=1, linestyle=(0, (2, 2)), zorder=1)
        ends.append((y, words, QUIET))
    for axis in logarithmic:
        getattr(ax, f"set_{axis}scale")("log")
    plain_axes(ax, y_label)
    ax.set_xlabel(x_label, fontsize=TEXT, color=INK)
    ax.set_xlim(min(x), max(x))
    if "y" in logarithmic:  # labels are placed in a linear height
        (low, high), places = ax.get_ylim(), np.log([y for y, *_ in ends])
        heights = low + (high - low) * (places - np.log(low)) / np.log(high / low)
        ends = [(height, *rest) for height, (_, *rest) in zip(heights, ends, strict=True)]
    label_ends(ax, ends)
    return finish(figure, title, f"{y_label} against {x_label}. {_told(x, named)}")


def _told(x: Sequence[float], named: Mapping[str, np.ndarray]) -> str:
    told = []
    for label, values in named.items():
        first, last = (", ".join(f"{v:.3g}" for v in np.atleast_2d(values)[:, i]) for i in (0, -1))
        told.append(f"{label}: {first} at {x[0]:.3g}, {last} at {x[-1]:.3g}.")
    return " ".join(told)


def action_bars(named: Mapping[str, Sequence[float]], title: str, y_label: str = "probability") -> Figure:
    """For each of the nine actions a bar for each name: {name: (9,)}."""
    figure = new_figure(3.3)
    ax = figure.add_axes((0.08, 0.22, 0.9, 0.5 - 0.05 * wrapped(title).count("\n")))
    width, places = 0.8 / len(named), np.arange(len(ACTION_NAMES))
    shades = _shades(list(named))
    for row, (label, values) in enumerate(named.items()):
        at = places + (row - (len(named) - 1) / 2) * width
        drawn = ax.bar(at, values, width=0.92 * width, color=shades[row], label=label)
        ax.bar_label(drawn, [_short(v) for v in values], fontsize=SMALL - 1, color=QUIET, padding=1.5)
    ax.axhline(0, color=QUIET, linewidth=0.8)
    plain_axes(ax, y_label)
    ax.margins(y=0.12)
    ax.set_xticks(places, [action.replace(" ", "\n") for action in ACTION_NAMES], fontsize=SMALL)
    ax.legend(loc="lower right", bbox_to_anchor=(1, 1), ncols=len(named), frameon=False, fontsize=TEXT)
    listed = (
        f"{label}: {', '.join(f'{a} {v:.2f}' for a, v in zip(ACTION_NAMES, values, strict=True))}"
        for label, values in named.items()
    )
    return finish(figure, title, f"Bars of the {y_label} of the nine actions. {'; '.join(listed)}.")


def _short(value: float) -> str:
    return f"{value:.2f}".removeprefix("0") if 0 <= value < 0.995 else f"{value:.2g}".replace("-", "−")


def _shades(labels: list[str]) -> list[str]:
    """A colour for each label: its method's; of two that would look alike, the second is black, the third grey."""
    found = []
    for label in labels:
        own = style(label).colour
        found.append(next(c for c in (own, INK, QUIET, "#B8BEC6") if c not in found))
    return found
