"""A number to drag or to type, with a symbol, a unit and a sentence of help. It refuses what the library refuses."""

import math
from collections.abc import Callable

import ipywidgets as widgets
import traitlets

from bootcourse.errors import BootcourseError
from bootcourse.markup import html


class Number(widgets.VBox):
    """`value` is always accepted by `check`; a refused number changes nothing but the sentence.

    check: the library's validation, raises BootcourseError. low, high, step: of the slider; a typed
    number may lie beyond them if `check` accepts it. logarithmic: low and high are powers of ten.
    """

    value = traitlets.Float()

    def __init__(
        self, symbol: str, value: float, low: float, high: float, step: float, help: str, unit: str = "",
        check: Callable[[float], object] = lambda value: None, logarithmic: bool = False,
    ):  # fmt: skip
        self.check, self.symbol, self.purpose, self.sentence = check, symbol, help, help
        self.refused: float | None = None  # the number entered last, if it was refused
        self._showing = False  # what `show` writes into the controls is not an entry
        make = widgets.FloatLogSlider if logarithmic else widgets.FloatSlider
        self.slider = make(value=value, min=low, max=high, step=step, readout=False, tooltip=f"{symbol}: {help}")
        self.field = widgets.FloatText(value=value, step=step, tooltip=f"{symbol}, typed: {help}")
        self.help = widgets.HTML()
        label = widgets.HTML(html("<b>{}</b>{}", symbol, f" ({unit})" if unit else ""))
        row = widgets.HBox([label, self.slider, self.field], layout={"align_items": "center"})
        super().__init__([row, self.help], value=float(value))
        for part, width in ((label, 92), (self.slider, 210), (self.field, 88), (self, 420)):
            part.layout.width = f"{width}px"
        self._write()
        self.slider.observe(lambda change: self._enter(change["new"]), "value")
        self.field.observe(lambda change: self._enter(change["new"]), "value")
        self.observe(lambda change: self.show(), "value")

    def _write(self, wrong: str = "") -> None:
        """Write below the number what is wrong, or what it is for."""
        page = '<div class="bc-quiet bc-wrong" role="alert">{}</div>' if wrong else '<div class="bc-quiet">{}</div>'
        self.help.value = html(page, wrong or self.sentence)

    def _enter(self, value: float) -> None:
        if self._showing:
            return
        value = round(float(value), 10)
        try:
            self._refuse(value)
        except BootcourseError as error:
            self.refused = value
            self._write(str(error))
        else:
            self.value = value
            self.show()

    def _refuse(self, value: float) -> None:
        """Raise BootcourseError unless the value is finite and `check` accepts it."""
        if not math.isfinite(value):
            raise BootcourseError(f"{self.symbol} = {value}: give a finite number.")
        self.check(value)

    @traitlets.validate("value")
    def _checked(self, proposal):
        self._refuse(proposal["value"])
        return proposal["value"]

    def show(self) -> None:
        """Show the value, in place of a refused number; one beyond the slider's range puts it at its end."""
        self.refused = None
        self._write()
        low, high = self.slider.min, self.slider.max
        if isinstance(self.slider, widgets.FloatLogSlider):
            low, high = self.slider.base**low, self.slider.base**high
        self._showing = True
        try:
            self.slider.value = min(max(self.value, low), high)
            self.field.value = self.value
        finally:
            self._showing = False

    def lock(self, why: str = "") -> None:
        """Switch it off and say why; without a reason, switch it on again."""
        self.slider.disabled = self.field.disabled = bool(why)
        self.sentence = why or self.purpose
        self._write()


def moment(decisions: int, rate: float, help: str, drive: str) -> Number:
    """A time in a drive of so many decisions, at `rate` a second; drive: who has them, in words."""
    last = (decisions - 1) / rate

    def check(t: float) -> None:
        if not 0 <= t <= last:
            raise BootcourseError(f"t = {t:g} s: {drive} decisions from 0 to {last:g} s.")

    return Number("t", 0, 0, max(last, 1 / rate), 1 / rate, help, "s", check)
