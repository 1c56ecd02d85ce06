"""What a teacher is worth, as a drawing: a heat map of teachers and methods. A pure function of the agents' results."""

import numpy as np

from bootcourse.methods import display_name
from bootcourse.panels.sweep_view import between, cell, empty_cell
from bootcourse.plots.svg import QUIET, Drawing, drawing, text
from bootcourse.study.plan import TAUGHT
from bootcourse.study.teacher_worth import QUANTITIES, Cells, in_words, reached
from bootcourse.study.teachers import TEACHERS

LEFT, TOP, ACROSS, DOWN = 172, 58, 150, 46  # pixels: of the first cell, and from one cell to the next
WORDS = 560  # pixels that the longest line above or below the map takes


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
            value, interval = in_words(estimates[teacher, method])
            below = interval if name != "decisions" else f"{interval} {reached(found[teacher, method])}".strip()
            by = f", reached by {reached(found[teacher, method])}" if name == "decisions" else ""
            told.append(f"{TEACHERS[teacher].words}, {display_name(method)}: {value} {interval}".strip() + by)
            if np.isinf(estimates[teacher, method].value):
                parts += cell(*here, "#E3E7EB", value, below, dark=False)
                continue
            share = (level(estimates[teacher, method].value) - low) / (high - low) if high > low else 0.0
            parts += cell(*here, between(*its.colours, share), value, below, share > 0.45)
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
