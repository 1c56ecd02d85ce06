"""To drag in this lesson: how long a decision takes, and what five learners earn in the same time."""

from functools import cache

import numpy as np

from bootcourse.colours import INK, QUIET
from bootcourse.course.lessons.other_ways.figures import TAKES
from bootcourse.course.shipped import shipped_experiment
from bootcourse.methods import display_name, style
from bootcourse.panels.explorable import HEIGHT, WIDTH, Explorable
from bootcourse.panels.number import Number
from bootcourse.plots.svg import Drawing, SvgAxes, drawing, text
from bootcourse.research import equal_decisions
from bootcourse.research.beyond import WINDOW, lengths
from bootcourse.statistics import iqm

PACE = "bootstrapped"  # all have as long as this learner needs for as many decisions as it makes in `SECONDS`


class Learners:
    """Ten agents of one method: how they earned in training, and what a decision took of one core."""

    def __init__(self, method: str):
        results = equal_decisions.by_method(shipped_experiment("beyond"))[method]
        first = equal_decisions.BUDGETS[0]
        self.seconds = results.measured[f"seconds_{first}"] / first  # for a decision, (agents,)
        self.ends, self.means = [], []  # of each agent: decisions when an episode ended, mean return of the last ones
        for spent, returns in zip(lengths(results.curves), results.curves["return"], strict=True):
            driven = np.isfinite(spent)
            self.ends.append(np.cumsum(spent[driven], dtype=float)[WINDOW - 1 :])
            self.means.append(np.convolve(returns[driven], np.full(WINDOW, 1 / WINDOW), "valid"))

    def decisions(self, time: float, road: float) -> float:
        """How many the median agent makes in so many seconds if each takes `road` seconds beside the computing."""
        return float(np.median(time / (self.seconds + road)))

    def earned(self, time: float, road: float) -> float:
        """The agents' interquartile mean of the mean return of their last `WINDOW` training episodes by then."""
        made = time / (self.seconds + road)
        each = zip(self.ends, self.means, made, strict=True)
        return float(iqm(np.array([m[np.searchsorted(ends, by, side="right") - 1] for ends, m, by in each])))


@cache
def learners() -> dict[str, Learners]:
    """Those of the five methods."""
    return {method: Learners(method) for method in TAKES}


def time_for(road: float) -> float:
    """The seconds that all have if a decision takes `road` seconds beside the computing; 5 if it takes none."""
    return equal_decisions.SECONDS * (1 + road / float(np.median(learners()[PACE].seconds)))


def earned(road: float) -> dict[str, float]:
    """{method: return in training} in that time."""
    return {method: each.earned(time_for(road), road) for method, each in learners().items()}


def in_words(seconds: float) -> str:
    """ "5 s", "7 min", "10 h"."""
    for unit, size in (("s", 1), ("min", 60)):
        if seconds < 100 * size:
            return f"{seconds / size:.0f} {unit}"
    return f"{seconds / 3600:.0f} h"


def same_time() -> Explorable:
    """What each of the five earns in the same time, while a decision takes longer."""

    def draw(road: float) -> Drawing:
        road, returns = road / 1000, earned(road / 1000)
        best, least = max(returns, key=returns.get), min(returns, key=returns.get)
        says = f"In {in_words(time_for(road))} {display_name(best)} earns the most, {display_name(least)} the least."
        chart = SvgAxes(52, 60, 690, 180, (0.0, float(len(returns))), (0.0, 140.0))
        chart.scale(f"return in the last {WINDOW} training episodes (jump-start RL's may begin with the rule)")
        words = []
        for place, (method, value) in enumerate(returns.items()):
            sides = [place + 0.2, place + 0.8]
            chart.fill([*sides, *sides[::-1]], [0, 0, max(value, 0), max(value, 0)], style(method).colour)
            (x, top), (_, foot) = chart.at(place + 0.5, max(value, 0)), chart.at(0, 0)
            made = float(f"{learners()[method].decisions(time_for(road), road):.2g}")
            below = {18: (display_name(method), INK), 34: (f"{made:,.0f} decisions", QUIET)}
            words += [text(x, top - 5, f"{value:.0f}", "middle", bold=True)]
            words += [text(x, foot + down, said, "middle", colour) for down, (said, colour) in below.items()]
        return drawing(WIDTH, HEIGHT, [text(4, 20, says, size=14, bold=True), *chart.parts, *words], says)

    help = "What a decision takes beside the computing. On a road: 1,000 ms."
    road = Number("drive", 0.001, 0.001, 1000, 0.25, help, unit="ms", logarithmic=True)
    return Explorable("What does a decision cost?", draw, road=road)
