"""Explore the sweep over p, ξ and c: the result at each setting that was run, and the command to run it again.

    sweep_panel()

Nothing is trained here: `study/sweep.py` finds the agents of a setting, `sweep_view.py` draws them.
"""

from collections.abc import Callable, Sequence
from pathlib import Path

import ipywidgets as widgets

from bootcourse.errors import BootcourseError
from bootcourse.markup import html
from bootcourse.panels.panel import Panel
from bootcourse.panels.sweep_view import choices, rerun, view
from bootcourse.plots.svg import printed
from bootcourse.study.results import Results
from bootcourse.study.sweep import SHIPPED, SweepResult, load_sweep, nearest_setting


class Snap(widgets.VBox):
    """A slider over the values that were run, and a field that snaps to the nearest of them.

    snap: gives the nearest value that was run; raises BootcourseError for a value that no training can have.
    """

    def __init__(self, symbol: str, unit: str, help: str, values: Sequence[float], snap: Callable[[float], float]):
        self.snap, self.sentence, self._busy = snap, help, False
        label = widgets.HTML(html("<b>{}</b>{}", symbol, f" ({unit})" if unit else ""))
        label.layout.width = "64px"
        options = [(f"{value:g}", value) for value in values]
        self.slider = widgets.SelectionSlider(
            options=options, value=values[len(values) // 2], readout=False, tooltip=f"{symbol}: {help}"
        )
        self.slider.layout.width = "140px"
        self.field = widgets.FloatText(value=self.slider.value, tooltip=f"{symbol}, typed: {help}")
        self.field.layout.width = "76px"
        self.help = widgets.HTML()
        super().__init__([widgets.HBox([label, self.slider, self.field], layout={"align_items": "center"}), self.help])
        self.layout.width = "310px"
        self._tell()
        self.slider.observe(lambda change: self._show(), "value")
        self.field.observe(lambda change: self._typed(change["new"]), "value")

    @property
    def value(self) -> float:
        return self.slider.value

    def _typed(self, value: float) -> None:
        if self._busy:
            return
        try:
            self.slider.value = self.snap(value)
        except BootcourseError as error:
            self._tell(str(error), "bc-wrong")
            return
        self._show()
        if value != self.slider.value:
            self._tell(f"{value:g} was not run: this is the nearest that was.")

    def _show(self) -> None:
        self._busy = True
        try:
            self.field.value = self.slider.value
        finally:
            self._busy = False
        self._tell()

    def _tell(self, words: str = "", kind: str = "") -> None:
        self.help.value = html('<div class="bc-quiet {}">{}</div>', kind, words or self.sentence)


class SweepPanel(Panel):
    """`.happened` is the result that is shown, None if the sweep could not be read."""

    def __init__(self, path: Path):
        self.happened: SweepResult | None = None
        self._views: dict[tuple, str] = {}
        try:
            self.sweep: Results | None = load_sweep(path)
            ps, xis, cs = choices(self.sweep)
        except BootcourseError as error:
            self.sweep = None
            super().__init__("The sweep over p, ξ and c")
            self.say(str(error), wrong=True)
            return
        sweep = self.sweep
        self.p = Snap("p", "", "Probability that the stochastic rule gives to the rule's action.", ps,
                      lambda p: nearest_setting(sweep, p, xis[-1], cs[0]).p)  # fmt: skip
        self.xi = Snap("ξ", "× α", "Strength of the pull towards the rule.", xis,
                       lambda xi: nearest_setting(sweep, ps[0], xi, cs[0]).xi_multiplier)  # fmt: skip
        self.c = Snap("c", "", "Bonus on a demonstration's reward.", cs,
                      lambda c: nearest_setting(sweep, ps[0], xis[-1], c).c)  # fmt: skip
        self.sentence, self.chart, self.code = widgets.HTML(), widgets.HTML(), widgets.HTML()
        row = widgets.HBox([self.p, self.xi, self.c], layout={"flex_flow": "row wrap"})
        super().__init__("The sweep over p, ξ and c", row, self.sentence, self.chart, self.code)
        for control in (self.p, self.xi, self.c):
            control.slider.observe(lambda change: self._draw(), "value")
        self._draw()

    def picture(self) -> tuple[bytes, str, str]:
        if self.happened is None:
            from bootcourse.plots.svg import drawing, text

            words = "The sweep could not be read."
            return printed(drawing(600, 40, [text(10, 25, words)], words)), "image/svg+xml", words
        return printed(self._view()), "image/svg+xml", str(self.happened)

    def _draw(self) -> None:
        asked = (self.p.value, self.xi.value, self.c.value)
        self.happened = nearest_setting(self.sweep, *asked)
        missing = "" if self.happened.exact else "This setting was not run. The nearest that was: "
        self.sentence.value = html('<div class="bc-says" role="status">{}</div>', f"{missing}{self.happened}")
        self.chart.value = self._view()
        page = (
            '<div class="bc-quiet">To train these agents again:</div>'
            '<pre style="margin:2px 0 0;font-size:12px;line-height:1.4;user-select:all;overflow-x:auto">{}</pre>'
        )
        self.code.value = html(page, rerun(self.happened))

    def _view(self) -> str:
        happened = self.happened
        key = (happened.p, happened.xi_multiplier, happened.c)
        if key not in self._views:
            self._views[key] = view(self.sweep, happened)
        return self._views[key]


def sweep_panel(path: Path = SHIPPED) -> SweepPanel:
    """The results at every setting of p, ξ and c that was run; by default those that ship with the course.

    path: a file that `bootcourse sweep` wrote. If it is missing or damaged, the panel says so.
    """
    return SweepPanel(Path(path))
