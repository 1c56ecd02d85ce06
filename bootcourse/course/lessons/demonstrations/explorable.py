"""To drag in this lesson: how often a copy errs, and how long it stays where its teacher has been."""

import numpy as np

from bootcourse.methods import style
from bootcourse.panels.explorable import Axes, Curve, Explorable, curves
from bootcourse.panels.number import Number
from bootcourse.plots.svg import Drawing
from bootcourse.scenario import DEFAULT

AXES = Axes("second of the drive", "% of drives that have followed the teacher in every second", (0.0, 100.0))


def compounding() -> Explorable:
    """The share of drives without a single error, (1 − ε)^t, while ε moves."""
    times = np.arange(DEFAULT.clock.decisions + 1)

    def draw(errors: float) -> Drawing:
        kept = 100 * (1 - errors / 100) ** times
        named = {f"a copy that errs in {errors:g} of 100 decisions": Curve(kept, style("bc").colour)}
        says = f"After 30 s {kept[30]:.0f} % are where the teacher would be, at the end {kept[-1]:.0f} %."
        return curves(says, AXES, times, named, mark=30)

    errors = Number("errors", 20, 0, 25, 0.1, "Of a hundred decisions, so many differ from the teacher's.")
    return Explorable("The copy agrees with its teacher on 80 of 100 decisions. Is that much?", draw, errors=errors)
