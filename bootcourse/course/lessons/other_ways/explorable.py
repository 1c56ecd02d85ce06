"""To drag in this lesson: when the rule's action is taken, and how learners earn, by two counts."""

from collections.abc import Mapping

import ipywidgets as widgets
import numpy as np
import torch

from bootcourse.colours import QUIET
from bootcourse.course.lessons.other_ways.figures import TAKES
from bootcourse.learn.ibrl import better_of_two
from bootcourse.methods import display_name, style
from bootcourse.panels.explorable import HEIGHT, WIDTH, Axes, Curve, Explorable, bars, legend
from bootcourse.panels.number import Number
from bootcourse.panels.panel import Panel
from bootcourse.plots.svg import Drawing, SvgAxes, drawing, over, text
from bootcourse.research import equal_decisions
from bootcourse.research.beyond import WINDOW, at_budget
from bootcourse.research.results import Results
from bootcourse.scenario import DEFAULT
from bootcourse.statistics import iqm

EARLY, LATER = 36_000, equal_decisions.BUDGETS[0]  # decisions that the picture marks
DECISIONS, SECONDS = "decisions", "seconds of computing"
LONGEST = {SECONDS: 15, DECISIONS: 150_000}  # the ends of the picture's axis
MARKED = {DECISIONS: (EARLY, LATER), SECONDS: (equal_decisions.SECONDS,)}
POINTS = 60  # of each curve
NAMED = {  # words beside a curve: at which share of the axis, and how many pixels from there
    "sac": ("plain SAC, no teacher", {DECISIONS: (0.5, 0, -6)}),
    "ppo": ("PPO, no teacher", {DECISIONS: (0.5, 0, 16), SECONDS: (0.25, 18, 16)}),
    "rlpd": ("RLPD", {DECISIONS: (0.1, -22, 0), SECONDS: (0.5, 14, 16)}),
}


def which_of_two() -> Explorable:
    """How the better of two actions is distributed, while Q of the rule's action rises."""
    pi, rule, axes = torch.tensor([0.5, 0.3, 0.2]), torch.tensor(1), Axes("", "probability", (0.0, 1.0))

    def draw(q_rule: float) -> Drawing:
        chosen = better_of_two(pi, torch.tensor([1.0, q_rule, 3.0]), rule)
        labels = ["brake Q=1", f"hold Q={q_rule:g} (rule's)", "accelerate Q=3"]
        named = {"π, the agent's own": Curve(pi, QUIET), "the better of two": Curve(chosen, style("ibrl").colour)}
        return bars(f"The rule's action is taken with probability {chosen[rule]:.1f}.", axes, labels, named)

    help = "Q of the rule's action. The other actions keep theirs."
    return Explorable("Which of the two is taken?", draw, q_rule=Number("Q", 2.0, 0.0, 4.0, 0.1, help))


def seconds_per_decision(results: Results) -> np.ndarray:
    """Of one core, in the training of each agent up to the first budget: (agents,)."""
    return results.measured[f"seconds_{LATER}"] / LATER


def in_training(results: Results, spent: float, count: str) -> np.ndarray:
    """The mean return of each agent's last `WINDOW` training episodes after so many decisions or seconds."""
    return at_budget(results.curves, spent if count == DECISIONS else spent / seconds_per_decision(results))


def learning_curve(results: Results, count: str) -> np.ndarray:
    """The interquartile mean of the agents at `POINTS` places of the axis, NaN where one of them has no value."""
    each = [in_training(results, spent, count) for spent in np.linspace(0, LONGEST[count], POINTS + 1)[1:]]
    return np.array([iqm(of) if np.isfinite(of).all() else np.nan for of in each])


class TwoCounts(Panel):
    """The learning curves of several methods over the decisions, or over the seconds that they took; a switch."""

    def __init__(self, compared: Mapping[str, Results], rule: float):
        """compared: see `equal_decisions.by_method`; rule: what the rule earns, a line."""
        self.drawings = {count: _curves(compared, rule, count) for count in LONGEST}
        self.count = widgets.RadioButtons(options=list(LONGEST), tooltip="What is counted", layout={"width": "auto"})
        self.view = widgets.HTML()
        super().__init__("What do you count?", self.count, self.view)
        self.update_with(self.count)

    def update(self, change=None) -> None:
        """Show the picture of the present count."""
        self.svg = self.view.value = self.drawings[self.count.value]


def _curves(compared: Mapping[str, Results], rule: float, count: str) -> Drawing:
    end, spent, by_decisions = LONGEST[count], MARKED[count][-1], count == DECISIONS
    unit = 1000 if by_decisions else 1
    chart = SvgAxes(52, 84, 690, 170, (0.0, end / unit), (-20.0, 140.0))
    title = f"return in the last {WINDOW} training episodes (interquartile mean of ten agents)"
    chart.frame(title, "thousand decisions" if by_decisions else count)
    chart.line(chart.x, [rule, rule], style("rule").colour, 1.2)
    words = [over(text(738, chart.at(0, rule)[1] - 4, "the rule", "end", style("rule").colour))]
    for mark in MARKED[count]:
        chart.line([mark / unit] * 2, chart.y, QUIET, 0.8, "--")
        says = f"{mark:,}: {mark / DEFAULT.clock.decision_rate / 3600:.0f} h on a road" if by_decisions else f"{mark} s"
        words.append(over(text(chart.at(mark / unit, 0)[0] + 5, chart.at(0, -17)[1], says, fill=QUIET)))
    x, earned = np.linspace(0, end / unit, POINTS + 1)[1:], {}
    for method in reversed([m for m in compared if by_decisions or m not in equal_decisions.UNTIMED]):
        look, values = style(method), learning_curve(compared[method], count)
        chart.line(x, values, look.colour, look.width, look.line)
        if method in TAKES:
            earned[display_name(method)] = iqm(in_training(compared[method], spent, count))
        if method in NAMED:
            says, (share, right, below) = NAMED[method][0], NAMED[method][1][count]
            across, down = chart.at(x[round(share * POINTS) - 1], values[round(share * POINTS) - 1])
            words.append(over(text(across + right, down + below, says, "middle", look.colour)))
    best, least = max(earned, key=earned.get), min(earned, key=earned.get)
    says = f"After {spent:,} decisions {least} earns the least of the five."
    if not by_decisions:
        says = f"After {spent} seconds of computing {best} earns the most of the five, {least} the least."
    named = {display_name(m): Curve((), style(m).colour, style(m).line) for m in TAKES}
    return drawing(WIDTH, HEIGHT, [text(4, 20, says, size=14, bold=True), *legend(named), *chart.parts, *words], says)
