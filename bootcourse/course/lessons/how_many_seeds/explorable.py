"""To drag in this lesson: how many agents were trained, and what is known about all others."""

import numpy as np

from bootcourse.methods import style
from bootcourse.panels.explorable import Axes, Curve, Explorable, curves
from bootcourse.panels.number import Number, whole_number
from bootcourse.plots.svg import Drawing
from bootcourse.statistics import rate

MOST = 60  # agents
DRAWN = {*range(1, 11), 12, 15, 20, 25, 30, 40, 50, MOST}  # the numbers of agents whose interval is drawn
SAMPLE = "agents that were trained (how many of them escape is rounded)"
AXES = Axes(SAMPLE, "rate of escape (%), 95 % interval", (0.0, 100.0))


def certainty() -> Explorable:
    """The exact interval of a rate over the number of agents, for a share of them that escapes, while both move."""

    def draw(agents: float, share: float) -> Drawing:
        counts = np.array(sorted(DRAWN | {int(agents)}))
        hits = np.round(counts * share / 100).astype(int)
        ends = 100 * np.array([rate(np.arange(n) < k)[1:] for n, k in zip(counts, hits, strict=True)])
        own, colour = int(np.searchsorted(counts, agents)), style("soft").colour
        named = {"the upper end": Curve(ends[:, 1], colour), "the lower end": Curve(ends[:, 0], colour, "--")}
        low, high = ends[own]
        says = f"{hits[own]} of {agents:g} escape: the 95 % interval of the rate is {low:.0f} to {high:.0f} %."
        return curves(says, AXES, counts, named, mark=agents)

    numbers = {
        "agents": Number("agents", 10, 1, MOST, 1, "So many were trained, each with its own seed.",
                         check=whole_number("agents", 1, MOST)),
        "share": Number("share", 80, 0, 100, 5, "So many of a hundred of them escape.", "%"),
    }  # fmt: skip
    return Explorable("What do these agents say about the next one?", draw, **numbers)
