"""What a teacher is worth: who escapes, earns, crashes and learns fast, for teachers from bad to perfect.

    teachers_panel()

The panel shows what `bootcourse study teachers` measured, by default the results that ship; nothing is trained here.
"""

from pathlib import Path

import ipywidgets as widgets

from bootcourse.errors import BootcourseError, did_you_mean
from bootcourse.panels.panel import Panel
from bootcourse.panels.teachers_view import surface
from bootcourse.study.teacher_worth import QUANTITIES, Cells, taught


class TeachersPanel(Panel):
    """`quantity` is the control, `svg` what the panel shows."""

    def __init__(self, found: Cells, quantity: str):
        self.found = found
        self.quantity = widgets.ToggleButtons(
            options=list(QUANTITIES), value=quantity, description="show", style={"button_width": "96px"}
        )
        self.view = widgets.HTML()
        super().__init__("What is a teacher worth?", self.quantity, self.view)
        self.quantity.observe(self.update, "value")
        self.update()

    def update(self, change=None) -> None:
        """Draw the chosen quantity."""
        self.svg = self.view.value = surface(self.found, self.quantity.value)


def teachers_panel(quantity: str = "escape", study: Path | str = "") -> TeachersPanel:
    """See what a teacher is worth: teachers from bad to perfect, and methods that learn from them.

    quantity: "escape", "return", "accidents" or "decisions" until 95 % of the roads in training escape. study: a folder
    in which `bootcourse study teachers` has finished jobs; by default the results that ship. Raises BootcourseError for
    another quantity, and where there are no such results.
    """
    if quantity not in QUANTITIES:
        raise BootcourseError(f"Quantity {did_you_mean(quantity, QUANTITIES)}.")
    return TeachersPanel(taught(study), quantity)
