"""To drag in this lesson: what it is worth to go on with lesson 1's plan, second by second: the barrier."""

from collections.abc import Callable
from functools import cache

import numpy as np

from bootcourse.course import own_code
from bootcourse.course.lessons.the_barrier.attempts import PLAN, Outcome, drive
from bootcourse.course.lessons.the_barrier.exercises import going_on
from bootcourse.episodes.evaluate import held_out_seeds
from bootcourse.methods import style
from bootcourse.panels.explorable import Axes, Curve, Explorable, curves
from bootcourse.panels.number import Number
from bootcourse.plots.svg import Drawing
from bootcourse.policies import PlanPolicy, idle_policy

SECONDS = 14  # of the plan, from its start until it is past the traps


@cache
def by_plan() -> Outcome:
    """What comes of lesson 1's plan on the study's 1,000 held-out roads."""
    return drive(PlanPolicy(PLAN), held_out_seeds(1, 1000))


@cache
def by_staying() -> Outcome:
    """What comes of doing nothing, on one road: it earns the same on each."""
    return drive(idle_policy, held_out_seeds(1, 1))


def hill(price: float, gamma: float, worth_after: Callable[..., float] = going_on.solution) -> np.ndarray:
    """What it is worth to go on with the plan after 0 to 14 s of it, as a multiple of staying at its start.

    worth_after: the exercise `going_on`.
    """
    rewards, lasted = by_plan().priced(price), by_plan().lasted
    rest = [worth_after(rewards, lasted, gamma, t) for t in range(SECONDS + 1)]
    return np.array(rest, dtype=float) / by_staying().values(gamma)[0]


def barrier() -> Explorable:
    """What it is worth to go on with the plan, by how many of its seconds are driven, beside staying.

    The student's `going_on` draws it if it passed its check.
    """
    worth_after = own_code.yours_or_ours("going_on", doing="Drawing")

    def draw(price: float, gamma: float) -> Drawing:
        worth = hill(price, gamma, worth_after)
        lowest = int(worth.argmin())
        dip = f"after {lowest} s {worth[lowest]:.1f}" if lowest else "no dip"
        says = f"Price {price:g}, γ = {gamma:g}: the plan is worth {worth[0]:.1f} times staying, {dip}, "
        says = f"{says}after {SECONDS} s {worth[-1]:.1f}.".replace("-", "−")
        axes = Axes("seconds of the plan that are driven", "worth of the plan's rest (staying: 1)", (-2.0, 7.0))
        named = {
            "going on with the plan": Curve(worth, style("sac").colour),
            "staying": Curve(np.ones(SECONDS + 1), style("idle").colour, "--"),
        }
        return curves(says, axes, np.arange(SECONDS + 1), named, mark=lowest)

    numbers = {
        "price": Number("price", 10, 0, 15, 1, "What an accident costs."),
        "gamma": Number("γ", 0.8, 0.8, 0.95, 0.05, "What a reward one second later is worth, as a share of one now."),
    }
    return Explorable("When does an attempt pay?", draw, **numbers)
