"""To drag in this lesson: the discount γ, and how far ahead a driver looks with it."""

import numpy as np

from bootcourse.course.lessons.the_trap.figures import RIGHT_FIRST
from bootcourse.course.shipped import shipped_agents
from bootcourse.episodes.record import record
from bootcourse.methods import style
from bootcourse.panels.explorable import Axes, Curve, Explorable, curves
from bootcourse.panels.number import Number
from bootcourse.plots.figure import INK
from bootcourse.plots.svg import Drawing
from bootcourse.policies import idle_policy, plan_policy, rule_policy
from bootcourse.scenario import DEFAULT

ROAD, SECONDS = 10, 60  # the road of the lesson's drives, and how much of them is shown


def discount() -> Explorable:
    """The rewards of three ways out and of staying, weighed by γ^t and added up second by second, while γ moves."""
    by_rule = record(rule_policy(DEFAULT), [ROAD], DEFAULT, "rule")[0].rewards
    sooner = record(plan_policy([*RIGHT_FIRST, ("accelerate straight", 5)]), [ROAD], DEFAULT, "plan")[0].rewards
    helped = record(shipped_agents("bootstrapped")[2].as_policy(), [ROAD], DEFAULT, "helped")[0].rewards
    stay = record(idle_policy, [ROAD], DEFAULT, "idle")[0].rewards
    times = np.arange(len(by_rule))

    def draw(gamma: float) -> Drawing:
        agents, quick, out, behind = (np.cumsum(gamma**times * each) for each in (helped, sooner, by_rule, stay))
        named = {
            f"agent with help: {agents[-1]:.2f}": Curve(agents[:SECONDS], style("bootstrapped").colour),
            f"blind plan: {quick[-1]:.2f}": Curve(quick[:SECONDS], INK),
            f"rule's way out: {out[-1]:.2f}": Curve(out[:SECONDS], style("rule").colour),
            f"staying: {behind[-1]:.2f}": Curve(behind[:SECONDS], style("idle").colour, "--"),
        }
        what = "sum of the rewards until then, each × γ to the power of its second"
        top = 1.15 * max(float(each[SECONDS]) for each in (agents, quick, out, behind))
        axes = Axes("second of the drive, the first 60 of 150", what, (0.0, top))
        ends = {"an agent's way out": agents[-1], "the blind plan": quick[-1], "staying": behind[-1]}
        best = max(ends, key=ends.get)
        second = "staying more than the rule's" if behind[-1] > out[-1] else "the rule's more than staying"
        says = f"γ = {gamma:g}: {best} is worth most{'' if best == 'staying' else f', and {second}'}."
        return curves(says, axes, times[:SECONDS], named)

    gamma = Number("γ", 0.8, 0.5, 1, 0.01, "What a reward one second later is worth, as a share of one now.")
    return Explorable("What is a way out worth at its start?", draw, gamma=gamma)
