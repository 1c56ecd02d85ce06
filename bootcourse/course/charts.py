"""Plain charts for lessons: lines over a number, and many small panels."""

import math
from collections.abc import Mapping, Sequence

import numpy as np
from matplotlib.figure import Figure
from matplotlib.ticker import LogLocator, MaxNLocator, NullLocator

from bootcourse.colours import OTHER, Style
from bootcourse.methods import display_name
from bootcourse.plots.figure import (
    INK,
    QUIET,
    SMALL,
    TEXT,
    WIDTH,
    finish,
    label_ends,
    new_figure,
    one_axes,
    plain_axes,
    styles,
    wrapped,
)

HEIGHT, GAP, LEFT, FOOT = 1.15, 0.42, 0.5, 0.5  # inches, of the panels of `many`
COLUMNS = 3


def lines(
    x: Sequence[float],
    named: Mapping[str, np.ndarray],
    title: str,
    x_label: str,
    y_label: str,
    logarithmic: str = "",
    marks: Mapping[str, float] | None = None,
    limits: tuple[float, float] | None = None,
    looks: Sequence[Style] | None = None,
    alt: str = "",
) -> Figure:
    """Lines over x (points,), each with its name at its end; a value (lines, points) is drawn as thin lines.

    logarithmic: "x", "y" or "xy". marks: {words: y}, thin horizontal lines. limits: of the values' axis. looks: of
    the lines, one by one; without them a name that begins with a method's ("sac", "rule") gets its colour. alt: what
    the alt text says of the lines; without it, every line's first, highest and last value.
    """
    figure, ax = one_axes(3.6, title, x_label, y_label, width=0.66)
    ends = []
    for label, look in zip(named, looks or styles(list(named)), strict=False):
        values = np.atleast_2d(np.asarray(named[label], dtype=float))
        look_of = {"color": look.colour, "linestyle": look.line, "marker": look.marker if len(x) <= 30 else None}
        ax.plot(x, values.T, **look_of, ms=4, linewidth=2 if len(values) == 1 else 0.8)
        last = values[:, np.isfinite(values).any(axis=0)][:, -1].max()
        end = float(last if limits is None else np.clip(last, *limits))
        ends.append((end, display_name(label), look.colour))
    for words, y in (marks or {}).items():
        ax.axhline(y, color=QUIET, linewidth=1, linestyle=(0, (2, 2)), zorder=1)
        ends.append((y, words, QUIET))
    for axis in logarithmic:
        getattr(ax, f"set_{axis}scale")("log")
        numbered = getattr(ax, f"{axis}axis")
        numbered.set_major_formatter("{x:g}")
        numbered.set_minor_formatter("")
        if np.ptp(np.log10(getattr(ax, f"get_{axis}lim")())) < 3:
            numbered.set_minor_locator(LogLocator(subs=(2, 5)))
            numbered.set_minor_formatter("{x:g}")
        ax.tick_params(axis=axis, which="minor", length=0, labelsize=SMALL, labelcolor=QUIET)
    ax.set_xlim(min(x), max(x))
    ax.set_ylim(limits)
    if "y" in logarithmic:  # labels are placed in a linear height
        (low, high), places = ax.get_ylim(), np.log([y for y, *_ in ends])
        heights = low + (high - low) * (places - np.log(low)) / np.log(high / low)
        ends = [(height, *rest) for height, (_, *rest) in zip(heights, ends, strict=True)]
    label_ends(ax, [end for end in ends if end[1]])
    return finish(figure, title, f"{y_label} against {x_label}. {alt or _in_words(x, named)}")


def _in_words(x: Sequence[float], named: Mapping[str, np.ndarray]) -> str:
    sentences = []
    for label, values in named.items():
        shown = np.atleast_2d(np.asarray(values, dtype=float))
        first, last, highest = (
            ", ".join(f"{v:.3g}" for v in each) for each in (shown[:, 0], shown[:, -1], np.nanmax(shown, axis=1))
        )
        sentences.append(f"{display_name(label)}: {first} at {x[0]:,g}, {last} at {x[-1]:,g}; at most {highest}.")
    return " ".join(sentences)


def many(
    named: Mapping[str, tuple[Sequence[float], np.ndarray]],
    title: str,
    x_label: str,
    y_label: str,
    reference: str,
    limits: tuple[float, float] | None = None,
    x_scale: str = "linear",
    level: float | None = None,
) -> Figure:
    """A panel for each name, {name: (x (points,), values (seeds, points))}: a line for each seed.

    reference: the name of one that has no panel of its own and is drawn in grey in every other panel. All panels
    share their axes; limits cuts the values' axis; x_scale: "linear" or "log"; level: a dotted line in each panel. The
    alt text gives where every line ends.
    """
    own = [name for name in named if name != reference]
    rows, below_title = math.ceil(len(own) / COLUMNS), 0.36 + 0.2 * wrapped(title).count("\n")
    head = 0.46 + below_title
    total = head + rows * HEIGHT + (rows - 1) * GAP + FOOT
    width = (WIDTH - LEFT - 0.15 - 0.25 * (COLUMNS - 1)) / COLUMNS
    figure = new_figure(total)
    low, high = limits or _limits(named)
    last_x = max(x[-1] for x, _ in named.values())
    for k, label in enumerate(own):
        row, column = divmod(k, COLUMNS)
        left, bottom = LEFT + column * (width + 0.25), total - head - (row + 1) * HEIGHT - row * GAP
        ax = figure.add_axes((left / WIDTH, bottom / total, width / WIDTH, HEIGHT / total))
        x, values = named[reference]
        ax.plot(x, values.T, color="#9AA5B1", linewidth=1.0, zorder=2)
        if level is not None:
            ax.axhline(level, color=INK, linewidth=1, linestyle=(0, (1, 2)), zorder=1)
        x, values = named[label]
        ax.plot(x, values.T, color=OTHER.colour, linewidth=1.3, zorder=3)
        plain_axes(ax, "")
        ax.text(0, 1.05, label, transform=ax.transAxes, fontsize=TEXT, color=INK, fontweight="bold", va="bottom")
        ax.set(xscale=x_scale, xlim=(0 if x_scale == "linear" else x[0], last_x), ylim=(low, high))
        if x_scale == "linear":
            ax.xaxis.set_major_locator(MaxNLocator(3))
        else:
            ax.xaxis.set_minor_locator(NullLocator())
        ax.xaxis.set_major_formatter("{x:,g}")
        if column:
            ax.tick_params(labelleft=False)
        if k + COLUMNS < len(own):
            ax.tick_params(axis="x", labelbottom=False, length=0)
        else:
            ax.set_xlabel(x_label, fontsize=SMALL, color=QUIET)
    words = f"{y_label}, a line for each seed; grey: {reference}"
    figure.text(0.012, 1 - below_title / total, words, fontsize=TEXT, color=QUIET, va="top")
    return finish(figure, title, f"Small panels of {y_label} against {x_label}. {_ends(named)}")


def _limits(named: Mapping) -> tuple[float, float]:
    everything = np.concatenate([np.ravel(values) for _, values in named.values()])
    low, high = np.nanmin(everything), np.nanmax(everything)
    room = 0.06 * (high - low) or 1.0
    return float(low - room), float(high + room)


def _ends(named: Mapping) -> str:
    def last(row: np.ndarray) -> str:
        known = row[np.isfinite(row)]
        return f"{known[-1]:.3g}" if known.size else "unknown"

    return " ".join(f"{name} ends at {', '.join(map(last, values))}." for name, (_, values) in named.items())
