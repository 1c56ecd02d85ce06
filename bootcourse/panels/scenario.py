"""Move the numbers of the scenario and see the road change. A number that does not fit is refused with a sentence.

`scenario_fields.py` lists the numbers and makes the scenario, `scenario_view.py` draws it.
"""

import ipywidgets as widgets

from bootcourse.errors import whole
from bootcourse.markup import html
from bootcourse.panels.arguments import LAST_ROAD, an_instance, check_road
from bootcourse.panels.number import Number
from bootcourse.panels.panel import Panel, beside
from bootcourse.panels.scenario_fields import FIELDS, GROUPS, Field, as_code, changed
from bootcourse.panels.scenario_view import start_of, top_view
from bootcourse.scenario import DEFAULT, Scenario


class ScenarioPanel(Panel):
    """`.scenario` is always valid: a number that does not fit the others is refused, and tried again when they move."""

    def __init__(self, start: Scenario, seed: int):
        self.start, self.scenario, self._retrying = start, start, False
        self.numbers = {field: self._number(field) for field in FIELDS}
        self.road = Number("road", seed, 0, 99, 1, "Which road is drawn: its seed.", check=check_road)
        self.groups = widgets.ToggleButtons(options=list(GROUPS), tooltips=[f"Numbers of: {name}" for name in GROUPS])
        self.groups.style.button_width = "132px"
        self.back = widgets.Button(
            description="Start again", icon="undo", tooltip="Set every number back to its first value."
        )
        self.back.layout.margin = "0 0 0 24px"
        self.shown = beside(*self.numbers.values())
        self.shown.layout.min_height = "176px"
        self.view, self.code = widgets.HTML(), widgets.HTML()
        head = widgets.HBox([self.groups, self.back])
        super().__init__("The numbers of the scenario", head, self.shown, self.road, self.view, self.code)
        self.groups.observe(self._choose, "value")
        self.back.on_click(self._reset)
        for number in self.numbers.values():
            number.observe(self._moved, "value")
            number.help.observe(self._tell, "value")
        self._choose()
        self.update_with(self.road)

    def _number(self, field: Field) -> Number:
        return Number(
            field.symbol, field.of(self.start), field.low, field.high, field.step, field.help, field.unit,
            check=lambda value: self._with(field, value),
        )  # fmt: skip

    def _with(self, field: Field, value: float) -> Scenario:
        """The present scenario with one number changed. Raises BootcourseError if the numbers do not fit together."""
        return changed(self.start, {each: each.of(self.scenario) for each in FIELDS} | {field: value})

    def _moved(self, change) -> None:
        """A number was accepted: put it into the scenario, and try again the numbers that were refused."""
        field = next(field for field, number in self.numbers.items() if number is change["owner"])
        self.scenario = self._with(field, change["new"])
        if not self._retrying:
            self._retrying = True
            try:
                for number in self.numbers.values():
                    number.retry()
            finally:
                self._retrying = False
            self.update()

    def _choose(self, change=None) -> None:
        self.shown.children = [self.numbers[field] for field in GROUPS[self.groups.value]]

    def _reset(self, button) -> None:
        """Set back the scenario first, then each number, so that each is checked against the first values."""
        self.scenario, self._retrying = self.start, True
        try:
            for field, number in self.numbers.items():
                number.value = field.of(self.start)
                number.show()
        finally:
            self._retrying = False
        self.update()

    def update(self, change=None) -> None:
        """Draw the road that the present numbers make."""
        self.svg = self.view.value = top_view(self.scenario, start_of(self.scenario, int(self.road.value)))
        page = '<div class="bc-quiet">In Python: <code style="user-select: all">{}</code></div>'
        self.code.value = html(page, as_code(self.scenario, self.start))
        self._tell()

    def _tell(self, change=None) -> None:
        """Name below the road the numbers that were refused, also those of the groups that are not shown."""
        refused = [number for number in self.numbers.values() if number.refused is not None]
        names = ", ".join(f"{number.symbol} = {number.refused:g}" for number in refused)
        words = (
            f"Does not fit yet: {names}. {refused[0].wrong} The road above is the last that fits." if refused else ""
        )
        self.say(words, wrong=True)


def scenario_panel(scenario: Scenario = DEFAULT, seed: int = 0) -> ScenarioPanel:
    """Move the numbers of a scenario and see the road change; `.scenario` is the present scenario.

    scenario: where to start. seed: of the road that is drawn. Raises BootcourseError if either is of another type,
    or the seed is out of range.
    """
    an_instance(scenario, Scenario, "scenario")
    return ScenarioPanel(scenario, whole(seed, "seed", LAST_ROAD))
