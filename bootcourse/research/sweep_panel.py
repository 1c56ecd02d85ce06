"""Explore the sweep over p, ξ and c: the result at each setting that was run, and the command to run it again.

    sweep_panel()

Nothing is trained here: `sweep.py` finds the agents of a setting, `sweep_view.py` draws them.
"""

from collections.abc import Callable, Sequence
from pathlib import Path

import ipywidgets as widgets

from bootcourse.errors import BootcourseError
from bootcourse.markup import html
from bootcourse.panels.number import Entry
from bootcourse.panels.panel import Panel
from bootcourse.plots.svg import Drawing, drawing, text
from bootcourse.research.results import Results
from bootcourse.research.sweep import SHIPPED, SweepResult, load_sweep, nearest_setting
from bootcourse.research.sweep_view import choices, rerun, view


class Snap(Entry):
    """A slider over the values that were run, and a field that snaps to the nearest of them.

    snap: gives the nearest value that was run; raises BootcourseError for a value that no training can have.
    """

    def __init__(self, symbol: str, unit: str, help: str, values: Sequence[float], snap: Callable[[float], float]):
        self.snap, options = snap, [(f"{value:g}", value) for value in values]
        slider = widgets.SelectionSlider(options=options, value=values[len(values) // 2], readout=False)
        super().__init__(symbol, unit, help, slider, widgets.FloatText(value=slider.value), (64, 140, 76, 310))
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
            self._tell(str(error), wrong=True)
            return
        self._show()
        if value != self.slider.value:
            self._tell(f"{value:g} was not run: this is the nearest that was.")

    def _show(self) -> None:
        with self._showing():
            self.field.value = self.slider.value
        self._tell()


class SweepPanel(Panel):
    """`.happened` is the result that is shown, None if the sweep could not be read."""

    def __init__(self, path: Path):
        self.happened: SweepResult | None = None
        self._views: dict[tuple, Drawing] = {}
        try:
            self.sweep: Results | None = load_sweep(path)
            ps, xis, cs = choices(self.sweep)
        except BootcourseError as error:
            self.sweep = None
            super().__init__("The sweep over p, ξ and c")
            self.say(str(error), wrong=True)
            words = "The sweep could not be read."
            self.svg = drawing(600, 40, [text(10, 25, words)], words)
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

    def _draw(self) -> None:
        asked = (self.p.value, self.xi.value, self.c.value)
        self.happened = nearest_setting(self.sweep, *asked)
        missing = "" if self.happened.exact else "This setting was not run. The nearest that was: "
        self.sentence.value = html('<div class="bc-says" role="status">{}</div>', f"{missing}{self.happened}")
        key = (self.happened.p, self.happened.xi_multiplier, self.happened.c)
        if key not in self._views:
            self._views[key] = view(self.sweep, self.happened)
        self.svg = self.chart.value = self._views[key]
        page = (
            '<div class="bc-quiet">To train these agents again:</div>'
            '<pre style="margin:2px 0 0;font-size:12px;line-height:1.4;user-select:all;overflow-x:auto">{}</pre>'
        )
        self.code.value = html(page, rerun(self.happened))


def sweep_panel(path: Path = SHIPPED) -> SweepPanel:
    """The results at every setting of p, ξ and c that was run; by default those that ship with the course.

    path: a file that `bootcourse sweep` wrote. If it is missing or damaged, the panel says so.
    """
    return SweepPanel(Path(path))
