"""Fast and safe: the return of some kinds of agents against their accidents, the frontier of both, and a figure."""

from collections.abc import Mapping

import numpy as np
from matplotlib.figure import Figure

from bootcourse.colours import INK, QUIET
from bootcourse.methods import DRIVERS, style
from bootcourse.plots.figure import SMALL, TEXT, finish, one_axes, wrapped
from bootcourse.statistics import Estimate, interval
from bootcourse.study.results import Results
from bootcourse.study.tables import bracketed


def scored(results: Results) -> tuple[Estimate, Estimate]:
    """Accidents of any kind in % of the held-out episodes, and return: means over agents with 95 % intervals.

    Means, because an interquartile mean would leave out the agents with the most accidents.
    """
    return tuple(interval(scale * results.scores(of), np.mean) for of, scale in (("accident", 100), ("returns", 1)))


def frontier(varied: Mapping[str, Results]) -> list[str]:
    """The names that no other beats, with fewer accidents and as much return or the reverse, from safest to fastest."""
    middles = {name: (its[0].value, its[1].value) for name, its in ((n, scored(r)) for n, r in varied.items())}

    def beaten(name: str) -> bool:
        accidents, returns = middles[name]
        others = (its for its in middles.values() if its != middles[name])
        return any(a <= accidents and r >= returns for a, r in others)

    return sorted((name for name in middles if not beaten(name)), key=middles.get)


def safe_and_fast(varied: Mapping[str, Results], bound: float) -> Figure:
    """Return against accidents of every kind of agent, with their intervals, and the planner's return as a line.

    varied: {what the agents have: their results}; bound: the planner's mean return.
    """
    best, colours = frontier(varied), style("ppo_safe")
    count = {name: len(results) for name, results in varied.items()}
    title = f"Nothing here is both safer and faster than {', '.join(best)}"
    height = 3.8 + 0.2 * len(wrapped(title).splitlines())
    where = "accidents of any kind (% of held-out drives)"
    figure, ax = one_axes(height, title, where, "return", width=0.75)
    told = []
    for place, name in enumerate(sorted(varied, key=lambda name: scored(varied[name])[0].value)):
        accidents, returns = scored(varied[name])
        ahead = name in best
        colour, fill = (colours.colour, colours.colour) if ahead else (QUIET, "white")
        ax.plot([accidents.low, accidents.high], [returns.value] * 2, color=colour, linewidth=1.2, zorder=2)
        ax.plot([accidents.value] * 2, [returns.low, returns.high], color=colour, linewidth=1.2, zorder=2)
        ax.plot(accidents.value, returns.value, "o", ms=6, mfc=fill, mec=colour, zorder=3)
        ax.annotate(name, (accidents.value, returns.value), xytext=(6, -12 if place % 2 else 5), fontsize=SMALL,
                    textcoords="offset points", color=INK if ahead else QUIET)  # fmt: skip
        told.append(f"{name} ({count[name]} agents): {bracketed(accidents)} %, return {bracketed(returns)}")
    name, line = DRIVERS["planner"]
    ax.axhline(bound, color=line.colour, linewidth=line.width, linestyle=line.line)
    ax.annotate(f"{name}\n{bound:.1f}", (1.02, bound), xycoords=("axes fraction", "data"), va="center", fontsize=TEXT)
    ax.set_xlim(left=0)
    words = "Accidents and return, means over agents with 95 % intervals over training seeds"
    return finish(figure, title, f"{words}: {'; '.join(told)}. A line marks the planner's return, {bound:.1f}.")
