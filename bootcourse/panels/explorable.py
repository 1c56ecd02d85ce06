"""Something to drag before a formula stands: numbers with sliders, and a picture that follows them.

A lesson gives the numbers and the function that draws; they stand in `explorable.py` in its folder.
"""

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass

import ipywidgets as widgets
import numpy as np

from bootcourse.colours import INK, QUIET
from bootcourse.errors import BootcourseError
from bootcourse.panels.number import Number
from bootcourse.panels.panel import Panel, beside
from bootcourse.plots.svg import Drawing, SvgAxes, drawing, line, text

WIDTH, HEIGHT = 760, 300  # pixels of the picture
CHART = (52, 74, 690, 180)  # left, top, width and height of the axes in it
LETTER = 7.0  # pixels that a letter of the legend takes


class Explorable(Panel):
    """A picture that `draw` makes of its numbers, anew with each move. `svg` is the picture."""

    def __init__(self, title: str, draw: Callable[..., Drawing], **numbers: Number):
        """draw: takes the values of `numbers` by their names, each from its slider's low to its high end."""
        self.draw, self.numbers, self.view = draw, numbers, widgets.HTML()
        for number in numbers.values():
            number.check = within(number, number.check)
        super().__init__(title, beside(*numbers.values()), self.view)
        self.update_with(*numbers.values())

    def update(self, change=None) -> None:
        """Draw the present numbers."""
        self.svg = self.view.value = self.draw(**{name: number.value for name, number in self.numbers.items()})


def within(number: Number, also: Callable[[float], object]) -> Callable[[float], None]:
    """A check that refuses what lies beyond the number's slider, where a picture need not have a meaning."""

    def check(value: float) -> None:
        if not number.low <= value <= number.high:
            raise BootcourseError(f"{number.symbol} = {value:g}: give a number from {number.low:g} to {number.high:g}.")
        also(value)

    return check


@dataclass(frozen=True)
class Curve:
    """One line of a picture: its values, one for each x, and how it looks."""

    values: Sequence[float] | np.ndarray
    colour: str = INK
    dash: str = "-"


@dataclass(frozen=True)
class Axes:
    """What a picture's two axes show: their names with units, and the ranges, which stay while one drags."""

    x_name: str
    y_name: str
    y: tuple[float, float]


def curves(
    says: str, axes: Axes, x: Sequence[float] | np.ndarray, named: Mapping[str, Curve], mark: float | None = None
) -> Drawing:
    """Lines over x under a sentence that says what they show. mark: an x at which a vertical line and dots stand."""
    chart = SvgAxes(*CHART, (float(x[0]), float(x[-1])), axes.y)
    chart.frame(axes.y_name, axes.x_name)
    for curve in named.values():
        chart.line(x, curve.values, curve.colour, 1.6, curve.dash)
    if mark is not None:
        chart.line([mark, mark], axes.y, QUIET, 0.8, "--")
        for curve in named.values():
            chart.dot(mark, float(np.interp(mark, x, curve.values)), curve.colour)
    return drawing(WIDTH, HEIGHT, [text(4, 20, says, size=14, bold=True), *legend(named), *chart.parts], says)


def bars(says: str, axes: Axes, labels: Sequence[str], named: Mapping[str, Curve]) -> Drawing:
    """For each label a bar of each of the named values, under a sentence that says what they show."""
    chart = SvgAxes(*CHART, (0.0, float(len(labels))), axes.y)
    chart.scale(axes.y_name)
    width, floor = 0.8 / len(named), max(axes.y[0], 0.0)
    for row, curve in enumerate(named.values()):
        for place, value in enumerate(np.clip(np.asarray(curve.values), *axes.y)):
            left = place + 0.1 + row * width
            corners = [left, left + 0.92 * width, left + 0.92 * width, left]
            chart.fill(corners, [floor, floor, value, value], curve.colour)
    under = [
        text(chart.at(place + 0.5, 0)[0], CHART[1] + CHART[3] + 16 + 13 * row, word, "middle", QUIET, 11)
        for place, label in enumerate(labels)
        for row, word in enumerate(label.split())
    ]
    return drawing(WIDTH, HEIGHT, [text(4, 20, says, size=14, bold=True), *legend(named), *chart.parts, *under], says)


def legend(named: Mapping[str, Curve]) -> list[str]:
    """A row of the names, each behind a piece of its line."""
    parts, x = [], 4.0
    for name, curve in named.items():
        dashes = 'stroke-dasharray="6 4"' if curve.dash != "-" else ""
        parts += [line(x, 42, x + 24, 42, curve.colour, 3, dashes), text(x + 30, 46, name)]
        x += 54 + LETTER * len(name)
    return parts
