"""To drag in this lesson: γ, and where a target stops to change before a fall, if it knows the end and if not."""

import numpy as np

from bootcourse.colours import OTHER
from bootcourse.learn import sac
from bootcourse.methods import style
from bootcourse.panels.explorable import Axes, Curve, Explorable, curves
from bootcourse.panels.number import Number
from bootcourse.plots.svg import Drawing

LAST = 40  # pushes before the fall that are shown
AXES = Axes("pushes from the fall (−1: the last push)", "value at which the target no longer changes", (0.0, 55.0))


def the_end() -> Explorable:
    """The critic's values of the last pushes before a fall, each of which pays 1, while γ moves.

    They are where its targets stop to change; without (1 − terminated) the fallen state counts as any other.
    """

    def draw(gamma: float) -> Drawing:
        knows, following = np.empty(LAST), 0.0
        for left in range(LAST):  # the last push is the one that ends the episode
            following = knows[left] = sac.critic_target(1.0, left == 0, following, gamma)
        forgets = np.full(LAST, 1 / (1 - gamma))
        knows = knows[::-1]  # in the order of time
        named = {
            "the fall is marked": Curve(knows, style("sac").colour),
            "it is not": Curve(forgets, OTHER.colour, "--"),
        }
        says = f"γ = {gamma:g}: before the last push the two are {knows[-1]:.3g} and {forgets[-1]:.3g}."
        return curves(says, AXES, np.arange(-LAST, 0), named, mark=-1)

    gamma = Number("γ", 0.9, 0.5, 0.98, 0.01, "What a reward one push later is worth, as a share of one now.")
    return Explorable("Does the critic know that the pole will fall?", draw, gamma=gamma)
