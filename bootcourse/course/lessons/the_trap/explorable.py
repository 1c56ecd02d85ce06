"""To drag in this lesson: the discount γ, and how far ahead a driver looks with it."""

import numpy as np

from bootcourse.course.lessons.the_trap.figures import RIGHT_FIRST
from bootcourse.course.shipped import shipped_agents
from bootcourse.episodes.record import record
from bootcourse.episodes.words import overtaken
from bootcourse.methods import style
from bootcourse.panels.explorable import CHART, HEIGHT, WIDTH, Curve, Explorable, legend
from bootcourse.panels.number import Number
from bootcourse.plots.figure import INK
from bootcourse.plots.svg import Drawing, SvgAxes, drawing, text
from bootcourse.policies import idle_policy, plan_policy, rule_policy
from bootcourse.scenario import DEFAULT

ROAD = 10  # of the lesson's drives


def discount() -> Explorable:
    """The rewards of three ways out and of staying, weighed by γ^t and added up second by second, while γ moves."""
    plan, agent = plan_policy([*RIGHT_FIRST, ("accelerate straight", 5)]), shipped_agents("bootstrapped")[2].as_policy()
    drives = [record(policy, [ROAD])[0] for policy in (agent, plan, rule_policy(DEFAULT), idle_policy)]
    times, passes = np.arange(len(drives[0].rewards)), [overtaken(drive) for drive in drives[:3]]

    def draw(gamma: float) -> Drawing:
        agents, quick, out, behind = (np.cumsum(gamma**times * drive.rewards) for drive in drives)
        named = {
            f"agent with help: {agents[-1]:.2f}": Curve(agents, style("bootstrapped").colour),
            f"blind plan: {quick[-1]:.2f}": Curve(quick, INK),
            f"rule's way out: {out[-1]:.2f}": Curve(out, style("rule").colour),
            f"staying: {behind[-1]:.2f}": Curve(behind, style("idle").colour, "--"),
        }
        top = 1.15 * max(float(each[-1]) for each in (agents, quick, out, behind))
        chart = SvgAxes(*CHART, (0.0, times[-1]), (0.0, top))
        chart.frame("discounted rewards, added up so far", "second of the drive (dotted: passes trap 1)")
        for second, curve in zip(passes, named.values(), strict=False):
            chart.line([second, second], [0, top], curve.colour, 0.8, ":")
        for curve in named.values():
            chart.line(times, curve.values, curve.colour, 1.6, curve.dash)
        ends = {"an agent's way out": agents[-1], "the blind plan": quick[-1], "staying": behind[-1]}
        best = max(ends, key=ends.get)
        second = "staying more than the rule's" if behind[-1] > out[-1] else "the rule's more than staying"
        says = f"γ = {gamma:g}: {best} is worth most{'' if best == 'staying' else f', and {second}'}."
        return drawing(WIDTH, HEIGHT, [text(4, 20, says, size=14, bold=True), *legend(named), *chart.parts], says)

    gamma = Number("γ", 0.8, 0.5, 1, 0.01, "What a reward one second later is worth, as a share of one now.")
    return Explorable("What is a way out worth at its start?", draw, gamma=gamma)
