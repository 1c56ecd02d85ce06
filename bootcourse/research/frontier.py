"""Fast and safe: the return of some kinds of agents against their accidents, the frontier of both, and a figure."""

from collections.abc import Mapping

import numpy as np
from matplotlib.figure import Figure

from bootcourse.colours import GRID, INK, QUIET
from bootcourse.methods import DRIVERS, style
from bootcourse.plots.figure import SMALL, finish, label_ends, one_axes, wrapped
from bootcourse.research.results import Results
from bootcourse.research.tables import bracketed
from bootcourse.statistics import Estimate, interval


def scored(results: Results) -> tuple[Estimate, Estimate]:
    """Accidents of any kind in % of the held-out episodes, and return: means over agents with 95 % intervals.

    Means, because an interquartile mean would leave out the agents with the most accidents.
    """
    return tuple(interval(scale * results.scores(of), np.mean) for of, scale in (("accident", 100), ("returns", 1)))


def frontier(varied: Mapping[str, Results]) -> list[str]:
    """The names that no other beats, with fewer accidents and as much return or the reverse, from safest to fastest."""
    middles = {name: (its.scores("accident").mean(), its.scores("returns").mean()) for name, its in varied.items()}

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
    title = f"Nothing here is both safer and faster than {best[0]}"
    if len(best) > 1:
        title = f"The {len(best)} filled dots are the frontier: nothing here is both safer and faster"
    height = max(3.8, 0.42 * len(varied)) + 0.2 * len(wrapped(title).splitlines())  # room for the labels
    where = "accidents of any kind (% of held-out drives)"
    figure, ax = one_axes(height, title, where, "return", width=0.68)
    points, told = [], []
    for name, (accidents, returns) in sorted(((n, scored(its)) for n, its in varied.items()), key=lambda one: one[1]):
        ahead = name in best
        colour, fill = (colours.colour, colours.colour) if ahead else (QUIET, "white")
        ax.plot([accidents.low, accidents.high], [returns.value] * 2, color=colour, linewidth=1.2, zorder=2)
        ax.plot([accidents.value] * 2, [returns.low, returns.high], color=colour, linewidth=1.2, zorder=2)
        ax.plot(accidents.value, returns.value, "o", ms=6, mfc=fill, mec=colour, zorder=3)
        points.append((accidents.value, returns.value, name, INK if ahead else QUIET))
        told.append(f"{name} ({len(varied[name])} agents): {bracketed(accidents)} %, return {bracketed(returns)}")
    name, line = DRIVERS["planner"]
    ax.axhline(bound, color=line.colour, linewidth=line.width, linestyle=line.line)
    ax.set_xlim(left=0)
    places = label_ends(ax, [*(point[1:] for point in points), (bound, f"{name} {bound:.1f}", INK)], SMALL, wrap=24)
    for (x, y, *_), place in zip(points, places, strict=False):
        thin = {"arrowstyle": "-", "color": GRID, "linewidth": 0.9, "shrinkA": 0, "shrinkB": 4}
        ax.annotate("", (x, y), xytext=(1.01, place), textcoords="axes fraction", arrowprops=thin, zorder=1)
    words = "Accidents and return, means over agents with 95 % intervals over training seeds"
    ends = f"On the frontier: {', '.join(best)}. A line marks the planner's return, {bound:.1f}."
    return finish(figure, title, f"{words}: {'; '.join(told)}. {ends}")
