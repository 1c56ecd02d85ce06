"""To drag in this lesson: the updates for each decision, and how fast two aids fade with them."""

import numpy as np

from bootcourse.learn.bootstrap import demonstration_share
from bootcourse.learn.settings import Settings
from bootcourse.methods import style
from bootcourse.panels.explorable import Axes, Curve, Explorable, curves
from bootcourse.panels.number import Number
from bootcourse.plots.svg import Drawing
from bootcourse.scenario import DEFAULT

EPISODES = np.arange(0, 1501, 10)
AXES = Axes("training episode", "% of its start that is left", (0.0, 100.0))


def clocks() -> Explorable:
    """What is left of ξ = 200 α and of β over the episodes, while the updates for each decision change.

    An update lowers log α by its learning rate at most; drawn as if each did, in episodes of full length.
    """
    settings = Settings()

    def draw(updates: float) -> Drawing:
        done = EPISODES * DEFAULT.clock.decisions * updates
        xi = 100 * np.exp(-settings.alpha_lr * done)
        beta = 100 * np.array([demonstration_share(e, 1.0, settings.beta_episodes) for e in EPISODES])
        gone = EPISODES[np.argmax(xi < 1)] if (xi < 1).any() else None
        when = f"ξ has lost 99 % by episode {gone:,}" if gone is not None else "ξ keeps more than 1 % all the time"
        named = {
            "ξ, which fades by updates": Curve(xi, style("soft").colour),
            "β, which fades by episodes": Curve(beta, style("demos").colour, "--"),
        }
        return curves(f"{when}, β by episode {settings.beta_episodes:,}.", AXES, EPISODES, named)

    help = "Updates of the networks for each second that is driven."
    updates = Number("updates", 0.25, 0.02, 4, 0.05, help, logarithmic=True)
    return Explorable("Two aids, two clocks: which one is gone first?", draw, updates=updates)
