"""To drag in this lesson: the discount, and what each state of the chain is worth with it."""

import numpy as np

from bootcourse.course.lessons.values import chain
from bootcourse.methods import style
from bootcourse.panels.explorable import Axes, Curve, Explorable, bars
from bootcourse.panels.number import Number
from bootcourse.plots.svg import Drawing

STATES = ("0 trap", "1", "2", "3", "4 free")
AXES = Axes("", "what a walker gets from this state on, discounted", (0.0, 5.0))


def worths() -> Explorable:
    """Of each state, what a walker gets who goes to the trap and stays, and one who goes on, while γ moves."""

    def draw(gamma: float) -> Drawing:
        stay, go = chain.REWARD[0, 0] / (1 - gamma), chain.REWARD[4, 1] / (1 - gamma)
        back = np.array([stay, *[gamma * stay] * 3, np.nan])  # nobody comes back from the free road
        on = go * gamma ** np.arange(4, -1, -1)
        better = "it pays to leave the trap" if on[0] > back[0] else "it does not pay to leave the trap"
        named = {
            "goes to the trap, and stays": Curve(np.nan_to_num(back), style("idle").colour),
            "goes on to the free road": Curve(on, style("soft").colour),
        }
        says = f"γ = {gamma:.2f}: from the trap {back[0]:.2f} against {on[0]:.2f}, {better}."
        return bars(says, AXES, STATES, named)

    help = "What a reward one decision later is worth, as a share of one now."
    gamma = Number("γ", 0.5, 0, 0.8, 0.01, help)
    return Explorable("What is each state worth?", draw, gamma=gamma)
