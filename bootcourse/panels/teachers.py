"""What a teacher is worth: who escapes, earns, crashes and learns fast, for teachers from bad to perfect.

    teachers_panel()

The panel shows what `bootcourse study teachers` measured, by default the results that ship; nothing is trained here.
"""

from pathlib import Path

import ipywidgets as widgets
import numpy as np

from bootcourse.errors import check_known
from bootcourse.methods import display_name
from bootcourse.panels.panel import Panel
from bootcourse.panels.sweep_view import between, cell, empty_cell
from bootcourse.plots.svg import QUIET, Drawing, drawing, text
from bootcourse.research.plan import TAUGHT
from bootcourse.research.teacher_worth import QUANTITIES, Cells, in_words, reached, taught
from bootcourse.research.teachers import TEACHERS

LEFT, TOP, ACROSS, DOWN = 172, 58, 150, 46  # pixels: of the first cell, and from one cell to the next
WORDS = 560  # pixels that the longest line above or below the map takes


class TeachersPanel(Panel):
    """`quantity` is the control, `svg` what the panel shows."""

    def __init__(self, found: Cells, quantity: str):
        self.found = found
        self.quantity = widgets.ToggleButtons(
            options=list(QUANTITIES), value=quantity, description="show", style={"button_width": "96px"}
        )
        self.view = widgets.HTML()
        super().__init__("What is a teacher worth?", self.quantity, self.view)
        self.update_with(self.quantity)

    def update(self, change=None) -> None:
        """Draw the chosen quantity."""
        self.svg = self.view.value = surface(self.found, self.quantity.value)


def surface(found: Cells, name: str) -> Drawing:
    """The drawing of a quantity: a row for each teacher that was run, a column for each method."""
    its = QUANTITIES[name]
    estimates = {place: its.estimate(its.of_agents(results)) for place, results in found.items()}
    level = np.log if its.logarithmic else float
    finite = [level(each.value) for each in estimates.values() if np.isfinite(each.value)]
    low, high = (min(finite), max(finite)) if finite else (0.0, 0.0)
    teachers = [teacher for teacher in TEACHERS if any(teacher == each for each, _ in found)]
    methods = [method for method in TAUGHT if any(method == each for _, each in found)]
    parts, told = [text(4, 18, its.label, size=13, bold=True)], []
    for column, method in enumerate(methods):
        parts.append(text(LEFT + (column + 0.5) * ACROSS, TOP - 10, display_name(method), "middle", QUIET, 11))
    for row, teacher in enumerate(teachers):
        parts.append(text(LEFT - 8, TOP + (row + 0.5) * DOWN + 4, TEACHERS[teacher].words, "end", QUIET, 11))
        for column, method in enumerate(methods):
            here = (LEFT + column * ACROSS + 1, TOP + row * DOWN + 1, ACROSS - 2, DOWN - 2)
            if (teacher, method) not in found:
                parts += empty_cell(*here, "not run")
                continue
            estimate, by = estimates[teacher, method], reached(found[teacher, method]) if name == "decisions" else ""
            value, interval = in_words(estimate)
            words = f"{TEACHERS[teacher].words}, {display_name(method)}: {value} {interval}".strip()
            told.append(f"{words}, reached by {by}" if by else words)
            share = (level(estimate.value) - low) / (high - low) if high > low and np.isfinite(estimate.value) else 0.0
            fill = "#E3E7EB" if np.isinf(estimate.value) else between(*its.colours, share)
            parts += cell(*here, fill, value, f"{interval} {by}".strip(), share > 0.45)
    seeds = sorted({len(results) for results in found.values()})
    agents = f"{seeds[0]}" if len(seeds) == 1 else f"{seeds[0]} to {seeds[-1]}"
    foot = [f"In brackets: 95 % intervals over seeds, {agents} agents a cell."]
    foot += ["Behind them: how many agents reached it."] * (name == "decisions")
    foot += ["Rows: teachers from bad to perfect."]
    bottom = TOP + len(teachers) * DOWN
    parts += [text(4, bottom + 20 + 16 * i, line, fill=QUIET, size=11) for i, line in enumerate(foot)]
    alt = f"{its.label[0].upper()}{its.label[1:]}, with 95 % intervals. {'; '.join(told)}."
    width = max(WORDS, LEFT + len(methods) * ACROSS + 4)
    return drawing(width, bottom + 14 + 16 * len(foot), parts, alt)


def teachers_panel(quantity: str = "escape", study: Path | str = "") -> TeachersPanel:
    """See what a teacher is worth: teachers from bad to perfect, and methods that learn from them.

    quantity: "escape", "return", "accidents" or "decisions" until 95 % of the roads in training escape. study: a folder
    in which `bootcourse study teachers` has finished jobs; by default the results that ship. Raises BootcourseError for
    another quantity, and where there are no such results.
    """
    check_known("Quantity", quantity, QUANTITIES)
    return TeachersPanel(taught(study), quantity)
