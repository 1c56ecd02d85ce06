"""A number to drag or to type, with a symbol, a unit and a sentence of help. It refuses what the library refuses."""

import contextlib
import math
from collections.abc import Callable

import ipywidgets as widgets
import traitlets

from bootcourse.errors import BootcourseError
from bootcourse.markup import html


class Entry(widgets.VBox):
    """A slider and a field for the same number, under a symbol; below them a sentence.

    widths: of the symbol, the slider, the field and the whole, pixels.
    """

    def __init__(self, symbol: str, unit: str, help: str, slider, field: widgets.FloatText, widths, **traits):
        self.slider, self.field, self.help = slider, field, widgets.HTML()
        self.sentence, self._busy = help, False
        slider.tooltip, field.tooltip = f"{symbol}: {help}", f"{symbol}, typed: {help}"
        label = widgets.HTML(html("<b>{}</b>{}", symbol, f" ({unit})" if unit else ""))
        row = widgets.HBox([label, slider, field], layout={"align_items": "center"})
        super().__init__([row, self.help], **traits)
        for part, width in zip((label, slider, field, self), widths, strict=True):
            part.layout.width = f"{width}px"
        self._tell()

    @contextlib.contextmanager
    def _showing(self):
        """What the block writes into the controls is not an entry."""
        self._busy = True
        try:
            yield
        finally:
            self._busy = False

    def _tell(self, words: str = "", wrong: bool = False) -> None:
        page = '<div class="bc-quiet bc-wrong" role="alert">{}</div>' if wrong else '<div class="bc-quiet">{}</div>'
        self.help.value = html(page, words or self.sentence)


class Number(Entry):
    """`value` is always accepted by `check`; a refused number changes nothing but the sentence.

    check: the library's validation, raises BootcourseError. low, high, step: of the slider; a typed
    number may lie beyond them if `check` accepts it. logarithmic: low and high are powers of ten.
    """

    value = traitlets.Float()

    def __init__(
        self, symbol: str, value: float, low: float, high: float, step: float, help: str, unit: str = "",
        check: Callable[[float], object] = lambda value: None, logarithmic: bool = False,
    ):  # fmt: skip
        self.check, self.symbol, self.purpose = check, symbol, help
        self.refused: float | None = None  # the number entered last, if it was refused,
        self.wrong = ""  # and why it was
        make = widgets.FloatLogSlider if logarithmic else widgets.FloatSlider
        slider = make(value=value, min=low, max=high, step=step, readout=False)
        field = widgets.FloatText(value=value, step=step)
        super().__init__(symbol, unit, help, slider, field, (92, 210, 88, 420), value=float(value))
        self.slider.observe(lambda change: self._enter(change["new"]), "value")
        self.field.observe(lambda change: self._enter(change["new"]), "value")
        self.observe(lambda change: self.show(), "value")

    def _enter(self, value: float) -> None:
        if self._busy:
            return
        value = round(float(value), 10)
        try:
            self._refuse(value)
        except BootcourseError as error:
            self.refused, self.wrong = value, str(error)
            self._tell(self.wrong, wrong=True)
        else:
            self.value = value
            self.show()

    def retry(self) -> None:
        """Enter a refused number again, after another number has changed."""
        if self.refused is not None:
            self._enter(self.refused)

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
        self.refused, self.wrong = None, ""
        self._tell()
        with self._showing():
            low, high = self.slider.min, self.slider.max
            if isinstance(self.slider, widgets.FloatLogSlider):
                low, high = self.slider.base**low, self.slider.base**high
            self.slider.value = min(max(self.value, low), high)
            self.field.value = self.value

    def lock(self, why: str = "") -> None:
        """Switch it off and say why; without a reason, switch it on again."""
        self.slider.disabled = self.field.disabled = bool(why)
        self.sentence = why or self.purpose
        self._tell()


def moment(decisions: int, rate: float, help: str, drive: str) -> Number:
    """A time in a drive of so many decisions, at `rate` a second; drive: who has them, in words."""
    last = (decisions - 1) / rate

    def check(t: float) -> None:
        if not 0 <= t <= last:
            raise BootcourseError(f"t = {t:g} s: {drive} decisions from 0 to {last:g} s.")

    return Number("t", 0, 0, max(last, 1 / rate), 1 / rate, help, "s", check)
