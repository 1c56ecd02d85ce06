"""Training curves: the share of escapes and the return, episode by episode, of one method or several."""

from collections.abc import Mapping

import numpy as np
from matplotlib.figure import Figure
from matplotlib.ticker import FuncFormatter, MaxNLocator, PercentFormatter

from bootcourse.colours import Style
from bootcourse.episodes.words import sentence
from bootcourse.errors import BootcourseError
from bootcourse.methods import display_name
from bootcourse.plots.figure import (
    INK,
    TEXT,
    finish,
    in_front,
    label_ends,
    new_figure,
    plain_axes,
    styles,
    wrapped,
)
from bootcourse.statistics import band, rolling_means

WINDOW = 50  # episodes in a rolling mean
POINTS = 200  # at most so many episodes are drawn
MEASURES = {"success": "escapes (% of the last {} episodes)", "return": "return of an episode (mean of the last {})"}


def training_curves(
    curves: Mapping[str, Mapping[str, np.ndarray]],
    title: str,
    constants: Mapping[str, Mapping[str, float]] | None = None,
    paper: Mapping[str, Mapping[str, float]] | None = None,
) -> Figure:
    """Success and return over the episodes of training.

    curves: {method: `Result.curves`}, whose "success" and "return" are (agents, episodes), NaN where
    an interrupt came first. Thin lines are agents, the thick one their interquartile mean (up to
    where every agent got), the band its 95 % bootstrap interval over agents, where there are two or more.
    constants: {"rule": {"return": 49.0}}: horizontal lines. paper: {method: {"success": 0.95}}: the
    paper's numbers, as open diamonds at the right. Raises BootcourseError if no episode was finished.
    """
    if not curves:
        raise BootcourseError("There are no curves to draw: give {method: result.curves}.")
    window = _window(curves)
    rolled = {(method, measure): _rolled(curves, method, measure, window) for method in curves for measure in MEASURES}
    episodes = max(_finished(each) for each in curves.values())
    looks = dict(zip(curves, styles(list(curves)), strict=True))
    title = wrapped(title)
    figure, height = new_figure(4.0), 0.72 - 0.05 * len(title.splitlines())
    ends: dict[str, list] = {measure: [] for measure in MEASURES}
    for i, (measure, label) in enumerate(MEASURES.items()):
        ax = figure.add_axes((0.07 + 0.41 * i, 0.13, 0.34, height))
        plain_axes(ax, label.format(window))
        ax.set_xlim(0, episodes)
        ax.set_xlabel("episode", fontsize=TEXT, color=INK)
        ax.xaxis.set_major_locator(MaxNLocator(5, integer=True))
        for method in sorted(curves, key=in_front):
            value = _draw(ax, rolled[method, measure], looks[method], in_front(method))
            ends[measure].append((value, display_name(method), looks[method].colour))
        for method, values in (constants or {}).items():
            if measure in values:
                look = styles([method])[0]
                ax.axhline(values[measure], color=look.colour, linestyle=look.line, linewidth=look.width, zorder=2)
                ends[measure].append((values[measure], display_name(method), look.colour))
        for method, values in (paper or {}).items():
            if measure in values:
                colour = styles([method])[0].colour
                ax.plot(
                    episodes,
                    values[measure],
                    marker="D",
                    markersize=5,
                    markerfacecolor="white",
                    markeredgecolor=colour,
                    linestyle="none",
                    clip_on=False,
                    zorder=6,
                )
        if measure == "success":
            ax.set_ylim(-0.03, 1.03)
            ax.yaxis.set_major_formatter(PercentFormatter(1, symbol=""))
        else:
            low, high = ax.get_ylim()
            ax.set_ylim(low - max(0, 2 - (high - low)), high + max(0, 2 - (high - low)))
            ax.yaxis.set_major_formatter(FuncFormatter(lambda value, _: f"{value:g}".replace("-", "−")))
    label_ends(figure.axes[1], ends["return"], wrap=14)
    return finish(figure, title, _alt(curves, ends))


def _window(curves: Mapping) -> int:
    """Episodes in the rolling mean: fewer where the training was short."""
    return max(1, min(WINDOW, max(_finished(each) for each in curves.values()) // 4))


def _finished(curves: Mapping) -> int:
    """Episodes of the agent that got farthest."""
    return int(np.isfinite(np.atleast_2d(curves.get("return", np.nan))).sum(1).max(initial=0))


def _rolled(curves: Mapping, method: str, measure: str, window: int) -> tuple[np.ndarray, np.ndarray]:
    """(episode numbers (points,), rolling means (agents, points)), NaN after an agent's last episode."""
    try:
        values = np.atleast_2d(np.asarray(curves[method][measure], dtype=float))
    except KeyError:
        raise BootcourseError(
            f"The curves of '{method}' have no '{measure}': give what `Result.curves` holds."
        ) from None
    values = values[np.isfinite(values).any(1)]
    if not values.size:
        raise BootcourseError(f"'{method}' has not finished an episode: let it train longer before you draw it.")
    return rolling_means(values, window, POINTS)


def _draw(ax, rolled: tuple[np.ndarray, np.ndarray], look: Style, order: float) -> float:
    """One method's lines and band; returns where its line ends."""
    at, means = rolled
    ax.plot(at, means.T, color=look.colour, linewidth=0.7, alpha=0.45, zorder=order)
    whole = np.isfinite(means).all(0)  # the points that every agent got to
    if not whole.any():
        return _end(means)
    middle, low, high = band(means[:, whole])
    width = max(2.2, look.width)
    ax.plot(at[whole], middle, color=look.colour, linestyle=look.line, linewidth=width, zorder=order + 0.2)
    if len(means) > 1:
        ax.fill_between(at[whole], low, high, color=look.colour, alpha=0.13, linewidth=0, zorder=order - 0.4)
    return float(middle[-1])


def _end(means: np.ndarray) -> float:
    """Where the curves of agents that did not all get anywhere end: the mean over those that did."""
    return float(np.nanmean(means)) if np.isfinite(means).any() else 0.0


def _alt(curves: Mapping, ends: dict[str, list]) -> str:
    told = []
    last = {(measure, called): value for measure in MEASURES for value, called, _ in ends[measure]}
    for method in curves:
        agents, called = len(np.atleast_2d(curves[method]["return"])), display_name(method)
        success, returns = 100 * last["success", called], last["return", called]
        told.append(f"{called} ({agents} agent{'s' * (agents > 1)}) ends at {success:.0f} % and {returns:.1f}")
    told = sentence("; ".join(told))
    return f"Two curves over the episodes of training, the share of escapes and the return. {told}."
