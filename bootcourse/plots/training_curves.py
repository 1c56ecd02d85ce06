"""Training curves, over episodes or updates: how figures and panels draw them, and the figure of some methods."""

from collections.abc import Mapping, Sequence
from typing import NamedTuple

import numpy as np
from matplotlib.figure import Figure
from matplotlib.ticker import MaxNLocator

from bootcourse.colours import Style
from bootcourse.episodes.words import sentence
from bootcourse.errors import BootcourseError
from bootcourse.methods import display_name, style
from bootcourse.plots.canvas import Canvas, MplAxes
from bootcourse.plots.figure import (
    QUIET,
    SMALL,
    axes_at,
    finish,
    in_front,
    label_ends,
    new_figure,
    plain_axes,
    styles,
    wrapped,
)
from bootcourse.plots.svg import number
from bootcourse.statistics import band, iqm, rolling_means

WINDOW = 50  # episodes in a rolling mean
POINTS = 100  # at most so many episodes are drawn
FEW = 5  # fewer agents have a mean, and neither interquartile mean nor interval


class Measure(NamedTuple):
    """What can be drawn of each episode."""

    label: str  # with its unit
    factor: float = 1.0  # from what `Result.curves` holds to this unit
    least: float = 0.0  # the axis is at least so wide
    limits: tuple[float, float] | None = None  # of the axis, if they are fixed


MEASURES = {
    "success": Measure("success (% of episodes)", 100.0, limits=(0.0, 100.0)),
    "return": Measure("return of an episode", least=4.0),
    "accident": Measure("accidents (% of episodes)", 100.0, limits=(0.0, 100.0)),
    "speed": Measure("speed (m/s)", least=1.0),
    "distance": Measure("distance (m)", least=200.0),
    "alpha": Measure("α, weight of the entropy", least=0.002),
    "xi": Measure("ξ, weight of the soft constraint", least=0.2),
    "beta": Measure("β, share of demonstrations", least=0.1),
    "entropy": Measure("entropy of π (nats)", least=0.5),
    "effective": Measure("effective number of actions", least=1.0),
}


def in_unit(measure: str, values: np.ndarray) -> np.ndarray:
    """What `Result.curves` holds of a measure, in its unit. An `Accident` counts as one, whichever it is."""
    return (np.sign(values) if measure == "accident" else values) * MEASURES[measure].factor


def finished(curves: Mapping[str, np.ndarray]) -> int:
    """The number of finished episodes of the agent that has the most."""
    return int(np.isfinite(np.atleast_2d(curves.get("return", np.nan))).sum(1).max(initial=0))


def window_of(curves: Sequence[Mapping[str, np.ndarray]]) -> int:
    """Episodes in the rolling mean: fewer where the trainings were short."""
    return max(1, min(WINDOW, max(map(finished, curves), default=0) // 4))


def draw_training(canvas: Canvas, at: np.ndarray, means: np.ndarray, look: Style) -> float:
    """Thin lines for the seeds, a thick one for their interquartile mean (of a few: mean) as far as all of them got.

    at (points,), means (seeds, points): what `rolling_means` returns. Returns where the thick line ends, NaN where
    there is none.
    """
    for seed in means:
        canvas.line(at, seed, look.colour, 0.6, opacity=0.5)
    whole = np.isfinite(means).all(axis=0)
    if not whole.any():
        return float("nan")
    middle = (np.mean if len(means) < FEW else iqm)(means[:, whole], axis=0)
    canvas.line(at[whole], middle, look.colour, max(1.8, look.width), look.line)
    return float(middle[-1])


def draw_band(canvas: Canvas, at: np.ndarray, means: np.ndarray, colour: str) -> None:
    """The 95 % bootstrap interval over seeds of that interquartile mean, where there are not too few seeds."""
    whole = np.isfinite(means).all(axis=0)
    if len(means) >= FEW and whole.any():
        _, low, high = band(means[:, whole])
        canvas.fill([*at[whole], *at[whole][::-1]], [*high, *low[::-1]], colour, 0.15)


def training_curves(
    curves: Mapping[str, Mapping[str, np.ndarray]],
    title: str,
    constants: Mapping[str, Mapping[str, float]] | None = None,
    paper: Mapping[str, Mapping[str, float]] | None = None,
    measures: Sequence[str] = ("success", "return"),
    updates: np.ndarray | None = None,
) -> Figure:
    """Some measures over the episodes of training, two in a row, one alone as wide as both; each method in its look.

    curves: {method: `Result.curves`}, whose measures are (agents, episodes), NaN where an interrupt came
    first. Thin lines are agents, the thick one their interquartile mean (up to where every agent got), the
    band its 95 % bootstrap interval over agents. Of fewer than `FEW` agents the thick line is the mean, without a band.
    constants: {"rule": {"return": 49.0}}: horizontal lines. paper: {method: {"success": 0.95}}: the
    paper's numbers, as open diamonds at the right. updates (points,): the curves are (agents, points), means of the
    last episodes that were noted after these updates, and are drawn over them. Raises BootcourseError if no episode was
    finished.
    """
    if not curves:
        raise BootcourseError("There are no curves to draw: give {method: result.curves}.")
    if updates is None:
        window, last, unit = window_of(list(curves.values())), max(map(finished, curves.values())), "training episode"
    else:
        window, last, unit = WINDOW, updates[-1], "updates of each agent"
    looks = dict(zip(curves, styles(list(curves)), strict=True))
    constants, paper, rows = constants or {}, paper or {}, -(-len(measures) // 2)
    head, row = 0.5 + 0.2 * len(wrapped(title).splitlines()), 2.7  # inches
    total = head + rows * row
    across, width = (9.0, 2.88) if len(measures) > 1 else (7.0, 5.05)  # inches: lettering is as large as elsewhere
    figure = new_figure(total, across)
    ends: dict[str, dict[str, float]] = {}
    for i, measure in enumerate(measures):
        ax = axes_at(figure, 0.45 + 4.41 * (i % 2), head + (i // 2) * row, width, row - 0.85)
        plain_axes(ax, MEASURES[measure].label)
        ax.set_xlim(0, max(last, 1))
        ax.set_xlabel(unit, fontsize=SMALL, color=QUIET)
        ax.xaxis.set_major_locator(MaxNLocator(5, integer=True))
        ax.yaxis.set_major_formatter(lambda value, _: number(value))
        points = {method: _points(curves, method, measure, window, updates) for method in curves}
        ends[measure] = _draw(ax, measure, points, looks, constants, paper)
    each = "each episode" if window == 1 else f"over the last {window} episodes"
    most = max(len(np.atleast_2d(_values(curves, method, measures[0]))) for method in curves)
    thick = "mean" if most < FEW else "interquartile mean with its 95 % interval"
    words = f"Thin: agents. Thick: their {thick}. All {each}." if most > 1 else f"A line for each agent, {each}."
    words += " Diamonds: the paper's test results." * bool(paper)
    figure.text(0.012, 0.1 / total, words, fontsize=SMALL, color=QUIET)
    return finish(figure, title, _alt(curves, ends, "episodes" if updates is None else "updates"))


def _points(curves: Mapping, method: str, measure: str, window: int, updates: np.ndarray | None) -> tuple:
    """Where a method's points lie, (points,), and its agents' means there, (agents, points)."""
    values = in_unit(measure, _values(curves, method, measure))
    return rolling_means(values, window, POINTS) if updates is None else (updates, values)


def _draw(ax, name: str, points: Mapping[str, tuple], looks, constants, paper) -> dict[str, float]:
    """One measure of all methods; returns where each method's line ends."""
    measure, canvas, ends, labels = MEASURES[name], MplAxes(ax), {}, []
    for method in sorted(points, key=in_front):
        at, means = points[method]
        draw_band(canvas, at, means, looks[method].colour)
        end = draw_training(canvas, at, means, looks[method])
        ends[method] = end if np.isfinite(end) else float(np.nanmean(means))
        labels.append((ends[method], display_name(method), looks[method].colour))
    for method, values in constants.items():
        if name in values:
            look, level = style(method), values[name] * measure.factor
            ax.axhline(level, color=look.colour, linestyle=look.line, linewidth=look.width, zorder=1.5)
            labels.append((level, display_name(method), look.colour))
    for method, values in paper.items():
        if name in values:
            place, look = values[name] * measure.factor, {"mfc": "white", "mec": style(method).colour, "ms": 5}
            ax.plot(1.0, place, "D", **look, transform=ax.get_yaxis_transform(), clip_on=False, zorder=6)
    low, high = measure.limits or ax.get_ylim()
    air = 0.03 * (high - low) if measure.limits else max(0.0, measure.least - (high - low)) / 2
    ax.set_ylim(low - air, high + air)
    label_ends(ax, labels, size=SMALL, wrap=20, gap=0.035)
    return ends


def _values(curves: Mapping, method: str, measure: str) -> np.ndarray:
    """A method's curves (agents, episodes), without agents that did not finish an episode."""
    try:
        values = np.atleast_2d(np.asarray(curves[method][measure], dtype=float))
    except KeyError:
        raise BootcourseError(
            f"The curves of '{method}' have no '{measure}': give what `Result.curves` holds."
        ) from None
    values = values[np.isfinite(values).any(1)]
    if not values.size:
        raise BootcourseError(f"'{method}' has not finished an episode: let it train longer before you draw it.")
    return values


def _alt(curves: Mapping, ends: Mapping[str, Mapping[str, float]], over: str) -> str:
    ends_of_methods = []
    for method in curves:
        agents = len(next(iter(curves[method].values())))
        values = ", ".join(f"{MEASURES[measure].label} {ends[measure][method]:.3g}" for measure in ends)
        ends_of_methods.append(f"{display_name(method)} ({agents} agent{'s' * (agents > 1)}) ends at {values}")
    return f"Curves over the {over} of training. {sentence('; '.join(ends_of_methods))}."
