"""To drag in this lesson: the updates for each decision, and how fast two aids fade with them."""

import numpy as np

from bootcourse.course.shipped import shipped_experiment
from bootcourse.learn.bootstrap import demonstration_share
from bootcourse.learn.settings import Settings
from bootcourse.methods import style
from bootcourse.panels.explorable import Axes, Curve, Explorable, curves
from bootcourse.panels.number import Number
from bootcourse.plots.svg import Drawing
from bootcourse.research.experiments.clocks import choices

EPISODES = np.arange(0, 1201, 10)
AXES = Axes("training episode", "% of its start that is left", (0.0, 100.0))
MEASURED = {"1/4": 0.25, "1": 1.0, "2": 2.0, "4": 4.0}  # updates for each decision
LEAST = 1e-9  # so small a part of ξ counts as nothing


class Fading:
    """How ξ = 200 α fades, from the agents that were trained with the soft constraint alone."""

    def __init__(self):
        cells = choices(shipped_experiment("clocks"))
        xi = [cells[name, "π̃"].of("soft").curves["xi"] for name in MEASURED]
        self.logs = np.log([np.maximum(np.median(each / each[:, :1], axis=0), LEAST) for each in xi])

    def left(self, updates: float) -> np.ndarray:
        """The part of ξ that is left after each of `EPISODES`, the median agent.

        Between two measured numbers of updates log ξ lies on a line over log updates.
        """
        at, numbers = np.log(updates), np.log(list(MEASURED.values()))
        logs = np.array([np.interp(at, numbers, each) for each in self.logs.T])
        return np.exp(np.interp(EPISODES, np.arange(1, len(logs) + 1), logs))


def clocks() -> Explorable:
    """What is left of ξ = 200 α and of β over the episodes, while the updates for each decision change."""
    settings, fading = Settings(), Fading()

    def draw(updates: float) -> Drawing:
        xi = 100 * fading.left(updates)
        beta = 100 * np.array([demonstration_share(e, 1.0, settings.beta_episodes) for e in EPISODES])
        first = [EPISODES[np.argmax(left < 1)] if (left < 1).any() else None for left in (xi, beta)]
        when = f"ξ has fallen to 1 % by episode {first[0]:,}" if first[0] is not None else "ξ keeps more than 1 %"
        named = {
            "ξ, which fades by updates": Curve(xi, style("soft").colour),
            "β, which fades by episodes": Curve(beta, style("demos").colour, "--"),
        }
        return curves(f"{when}, β by episode {first[1]:,}.", AXES, EPISODES, named)

    help = "Updates of the networks for each decision. Agents were trained with ¼, 1, 2 and 4."
    updates = Number("updates", 0.25, 0.25, 4, 0.05, help, logarithmic=True)
    return Explorable("Two aids, two clocks: which one is gone first?", draw, updates=updates)
