"""To drag in this lesson: what the trap pays, and what each state of the chain is worth with it."""

import numpy as np

from bootcourse.course.lessons.values import chain
from bootcourse.methods import style
from bootcourse.panels.explorable import Axes, Curve, Explorable, bars
from bootcourse.panels.number import Number
from bootcourse.plots.svg import Drawing

STATES = ("0 trap", "1", "2", "3", "4 free")
GAMMA = 0.8  # fixed here: from which γ on leaving pays is the lesson's first prediction
AXES = Axes("", "what a walker gets from this state on, discounted", (0.0, 5.0))


def worths() -> Explorable:
    """Of each state, what a walker gets who goes to the trap and stays, and one who goes on, by what the trap pays."""
    on = chain.REWARD[4, 1] / (1 - GAMMA) * GAMMA ** np.arange(4, -1, -1)

    def draw(pay: float) -> Drawing:
        stay = pay / (1 - GAMMA)
        back = np.array([stay, *[GAMMA * stay] * 3, 0.0])  # nobody comes back from the free road
        named = {
            "goes to the trap, and stays": Curve(back, style("idle").colour),
            "goes on to the free road": Curve(on, style("soft").colour),
        }
        better = "it pays to leave" if on[0] > back[0] else "it does not pay to leave"
        says = f"If the trap pays {pay:.2f}: from there {back[0]:.2f} against {on[0]:.2f}, {better}."
        return bars(says, AXES, STATES, named)

    pay = Number("pay", float(chain.REWARD[0, 0]), 0, 1, 0.01, "What each decision to stay in the trap pays.")
    return Explorable("What is each state worth?", draw, pay=pay)
