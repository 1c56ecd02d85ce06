"""To drag in this lesson: how often an attempt to leave ends in an accident, and how far ahead the learner looks."""

import numpy as np

from bootcourse.course.lessons.the_barrier.attempts import PLAN, ThenAccelerate, drive
from bootcourse.episodes.evaluate import held_out_seeds
from bootcourse.methods import style
from bootcourse.panels.explorable import Axes, Curve, Explorable, curves
from bootcourse.panels.number import Number
from bootcourse.plots.svg import Drawing
from bootcourse.policies import idle_policy

ROADS = held_out_seeds(7, 500)


def price() -> Explorable:
    """What attempts are worth, of which some end as a plan's accidents do and the others as its ways out."""
    out, stay = drive(ThenAccelerate(PLAN), ROADS), drive(idle_policy, ROADS)
    shares = np.linspace(0, 1, 101)

    def draw(gamma: float, accidents: float) -> Drawing:
        values, behind = out.values(gamma), stay.values(gamma).mean()
        attempts = (1 - shares) * values[out.accident == 0].mean() + shares * values[out.accident > 0].mean()
        mine = float(np.interp(accidents / 100, shares, attempts))
        pays = "pays" if mine > behind else "does not pay"
        named = {
            f"attempts: {mine:.2f}": Curve(attempts, style("soft").colour),
            f"staying: {behind:.2f}": Curve(np.full(101, behind), style("idle").colour, "--"),
        }
        says = f"γ = {gamma:g}: with {accidents:g} accidents in a hundred, an attempt {pays}."
        limits = 1.1 * min(attempts.min(), 0.0), 1.15 * max(attempts.max(), behind)
        axes = Axes("accidents of a hundred attempts", "discounted sum of the rewards, from the start", limits)
        return curves(says, axes, 100 * shares, named, mark=accidents)

    numbers = {
        "gamma": Number("γ", 0.8, 0.5, 0.98, 0.01, "What a reward one second later is worth, as a share of one now."),
        "accidents": Number("accidents", 30, 0, 100, 1, "Of a hundred attempts, so many end in an accident."),
    }
    return Explorable("When does it pay to try?", draw, **numbers)
