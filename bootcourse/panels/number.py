"""A number to drag or to type, with a symbol, a unit and a sentence of help. It refuses what the library refuses."""

import math
from collections.abc import Callable

import ipywidgets as widgets
import numpy as np
import traitlets

from bootcourse.errors import BootcourseError
from bootcourse.markup import html


class Number(widgets.VBox):
    """`value` has been accepted by `check`; a refused number changes nothing but the sentence below it.

    check: raises BootcourseError for a number that the library refuses. low, high, step: of the slider; a typed number
    may lie beyond them if `check` accepts it. logarithmic: of a slider whose step is that of the number's exponent.
    """

    value = traitlets.Float()

    def __init__(
        self, symbol: str, value: float, low: float, high: float, step: float, help: str, unit: str = "",
        check: Callable[[float], object] = lambda value: None, logarithmic: bool = False,
    ):  # fmt: skip
        self.check, self.symbol, self.unit, self.sentence = check, symbol, unit, help
        self._showing = False  # what `show` writes into the controls is not an entry
        self._dragged = False  # while the slider is moved nobody else moves it: it would stop short of the hand
        self.low, self.high, self.step, self.logarithmic = low, high, step, logarithmic
        kind = widgets.FloatLogSlider if logarithmic else widgets.FloatSlider
        least, most = map(float, np.log10([low, high])) if logarithmic else (low, high)
        shown = min(max(value, low), high)
        words = f"{symbol}: {help}"
        self.slider = kind(value=shown, min=least, max=most, step=step, readout=False, tooltip=words)
        self.field = widgets.FloatText(value=value, step=step, tooltip=f"{symbol}, typed: {help}")
        self.help = widgets.HTML()
        label = widgets.HTML(html("<b>{}</b>{}", symbol, f" ({unit})" if unit else ""))
        row = widgets.HBox([label, self.slider, self.field], layout={"align_items": "center"})
        super().__init__([row, self.help], value=float(value))
        for part, width in ((label, 92), (self.slider, 210), (self.field, 88), (self, 420)):
            part.layout.width = f"{width}px"
        self.show()
        self.slider.observe(lambda change: self._drag(change["new"]), "value")
        self.field.observe(lambda change: self._enter(change["new"]), "value")
        self.observe(lambda change: self.show(), "value")

    def _drag(self, place: float) -> None:
        if not self._is_shown_at(place):
            value = float(f"{place:.2g}") if self.logarithmic else float(place)  # 180, and not 177.8279
            self._enter(value, by_slider=True)

    def _enter(self, value: float, by_slider: bool = False) -> None:
        if self._showing:
            return
        value, self._dragged = round(float(value), 10), by_slider
        try:
            if not math.isfinite(value):
                raise BootcourseError(f"{self.symbol} = {value}: give a finite number.")
            self.check(value)
        except BootcourseError as error:
            self.help.value = html('<div class="bc-quiet bc-wrong" role="alert">{}</div>', str(error))
        else:
            self.value = value
            self.show()
        finally:
            self._dragged = False

    def _is_shown_at(self, place: float) -> bool:
        """Does a page show the present value there? It moves a slider to its nearest step, and reports that."""
        far = abs(math.log10(place / self.value)) if self.logarithmic and self.value > 0 else abs(place - self.value)
        return 0 < far < 0.51 * self.step and self.low <= self.value <= self.high

    def show(self) -> None:
        """Show the value, in place of a refused number; one beyond the slider's range puts the slider at its end."""
        self.help.value = html('<div class="bc-quiet">{}</div>', self.sentence)
        self._showing = True
        if not self._dragged:
            self.slider.value = min(max(self.value, self.low), self.high)
        self.field.value = self.value
        self._showing = False


def whole_number(name: str, low: int, high: int) -> Callable[[float], None]:
    """A check of a number: is it a whole number from low to high?"""

    def check(value: float) -> None:
        if not low <= value <= high or value != int(value):
            raise BootcourseError(f"{name} = {value:g}: give a whole number from {low} to {high}.")

    return check
