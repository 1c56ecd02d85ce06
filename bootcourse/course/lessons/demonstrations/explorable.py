"""To drag in this lesson: how many decisions are wrong if errors lead to errors, and if they do not."""

import numpy as np

from bootcourse.methods import style
from bootcourse.panels.explorable import Axes, Curve, Explorable, curves
from bootcourse.panels.number import Number
from bootcourse.plots.svg import Drawing
from bootcourse.scenario import DEFAULT

WHOLE = DEFAULT.clock.decisions
AXES = Axes("seconds of the drive, a decision in each", "expected errors so far", (0.0, float(WHOLE)))


def compounding() -> Explorable:
    """The worst case, Σ min(1, ε t), and errors that stay alone, ε t, while ε moves."""
    times = np.arange(WHOLE + 1)

    def draw(errors: float) -> Drawing:
        worst = np.cumsum(np.minimum(1, errors / 100 * times))
        half, whole = worst[WHOLE // 2], worst[WHOLE]
        says = (
            f"At most {half:.1f} errors in {WHOLE // 2} s, {whole:.1f} in {WHOLE} s: {whole / half:.1f} times as many."
        )
        named = {
            "at most, if each decision after the first error is one": Curve(worst, style("bc").colour),
            "errors stay alone": Curve(errors / 100 * times, style("rule").colour, "--"),
        }
        return curves(says, AXES, times, named, mark=WHOLE // 2)

    help = "Of a hundred decisions in the teacher's states, so many are errors."
    errors = Number("ε", 0.5, 0.1, 2, 0.1, help, unit="%")
    return Explorable("A clone errs seldom in its teacher's states. What can that cost?", draw, errors=errors)
