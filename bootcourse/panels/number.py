"""A number to drag or to type, with a symbol, a unit and a sentence of help. It refuses what the library refuses."""

import math
from collections.abc import Callable

import ipywidgets as widgets
import traitlets

from bootcourse.errors import BootcourseError
from bootcourse.markup import html


class Number(widgets.VBox):
    """A slider and a field. `value` is always accepted by `check`; a refused number changes nothing but the sentence.

    check: the library's validation, raises BootcourseError. low, high, step: of the slider; a typed
    number may lie beyond them if `check` accepts it. logarithmic: low and high are powers of ten.
    """

    value = traitlets.Float()

    def __init__(
        self,
        symbol: str,
        value: float,
        low: float,
        high: float,
        step: float,
        help: str,
        unit: str = "",
        check: Callable[[float], object] = lambda value: None,
        logarithmic: bool = False,
    ):
        self.check, self.symbol, self.sentence, self._busy = check, symbol, help, False
        self._why_locked = ""
        self.refused: float | None = None  # the number entered last, if it was refused,
        self.wrong = ""  # and why it was
        label = widgets.HTML(html("<b>{}</b>{}", symbol, f" ({unit})" if unit else ""))
        label.layout.width = "92px"
        make = widgets.FloatLogSlider if logarithmic else widgets.FloatSlider
        self.slider = make(value=value, min=low, max=high, step=step, readout=False, tooltip=f"{symbol}: {help}")
        self.slider.layout.width = "210px"
        self.field = widgets.FloatText(value=value, step=step, tooltip=f"{symbol}, typed: {help}")
        self.field.layout.width = "88px"
        self.help = widgets.HTML()
        super().__init__(
            [widgets.HBox([label, self.slider, self.field], layout={"align_items": "center"}), self.help],
            value=float(value),
        )
        self.layout.width = "420px"
        self._tell()
        self.slider.observe(lambda change: self._enter(change["new"]), "value")
        self.field.observe(lambda change: self._enter(change["new"]), "value")
        self.observe(lambda change: self._show(), "value")

    def _enter(self, value: float) -> None:
        if self._busy:
            return
        value = round(float(value), 10)
        try:
            self._refuse(value)
        except BootcourseError as error:
            self.refused, self.wrong = value, str(error)
            self._tell(self.wrong)
        else:
            self.value = value
            self._show()

    def retry(self) -> None:
        """Enter a refused number again, after another number has changed."""
        if self.refused is not None:
            self._enter(self.refused)

    def clear(self) -> None:
        """Show the value again in place of a refused number."""
        self._show()

    def _refuse(self, value: float) -> None:
        """Raise BootcourseError unless the value is finite and `check` accepts it."""
        if not math.isfinite(value):
            raise BootcourseError(f"{self.symbol} = {value}: give a finite number.")
        self.check(value)

    @traitlets.validate("value")
    def _checked(self, proposal):
        self._refuse(proposal["value"])
        return proposal["value"]

    def _show(self) -> None:
        """Show the value in both controls; a value beyond the slider's range puts it at its end."""
        self.refused, self.wrong = None, ""
        self._tell()
        self._busy = True
        try:
            low, high = self.slider.min, self.slider.max
            if isinstance(self.slider, widgets.FloatLogSlider):
                low, high = self.slider.base**low, self.slider.base**high
            self.slider.value = min(max(self.value, low), high)
            self.field.value = self.value
        finally:
            self._busy = False

    def lock(self, why: str = "") -> None:
        """Switch it off and say why; without a reason, switch it on again."""
        self.slider.disabled = self.field.disabled = bool(why)
        self._why_locked = why
        self._tell()

    def _tell(self, wrong: str = "") -> None:
        page = '<div class="bc-quiet bc-wrong" role="alert">{}</div>' if wrong else '<div class="bc-quiet">{}</div>'
        self.help.value = html(page, wrong or self._why_locked or self.sentence)
