"""The study's figures: the paper's training panels, exploration, and final scores. One function each.

Every one takes `Results` and returns a matplotlib figure with `figure.alt`. Thin lines are seeds, the
thick one is their interquartile mean, the band its 95 % interval; open diamonds are the paper's
test results. Titles are made from the numbers, so they cannot say what the numbers do not.
"""

from collections.abc import Sequence
from typing import NamedTuple

import numpy as np
from matplotlib.figure import Figure

from bootcourse.methods import display_name, style
from bootcourse.plots.figure import GRID, QUIET, SMALL, finish, in_front, label_ends, new_figure, plain_axes
from bootcourse.statistics import ESCAPES, band, interval
from bootcourse.study.paper import COLUMNS, PRINTED, RATES
from bootcourse.study.results import Results

POINTS = 60  # at most this many points on a curve, each the mean of a block of episodes


LEGEND = (
    "Thin lines: agents. Thick: their interquartile mean, with its 95 % interval. Diamonds: the paper's test results."
)


class CurveAxes(NamedTuple):
    """One measure of a training figure."""

    curve: str  # its name in `Results.curves`
    label: str
    column: str | None = None  # the paper's column of the same measure
    scale: float = 1.0


PANELS = (
    CurveAxes("success", "success rate, %", "success", 100.0),
    CurveAxes("return", "return", "returns"),
    CurveAxes("speed", "mean speed, m/s", "speed"),
    CurveAxes("distance", "distance, m", "distance"),
)


def blocks(curves: np.ndarray, points: int = POINTS) -> tuple[np.ndarray, np.ndarray]:
    """Means of consecutive blocks of episodes: (seeds, episodes) -> middles (points,), (seeds, points)."""
    episodes = curves.shape[1]
    size = max(1, -(-episodes // points))
    edges = np.arange(0, episodes, size)
    counts = np.diff([*edges, episodes])
    return edges + counts / 2, np.add.reduceat(curves.astype(np.float64), edges, axis=1) / counts


def draw_curve(ax, label: str, curves: np.ndarray) -> float:
    """Seeds, interquartile mean and band of one method: (seeds, episodes). Returns where the curve ends."""
    curves = curves[np.isfinite(curves).all(axis=1)]  # an agent that was stopped has no curve to its end
    if not len(curves):
        return np.nan
    its, front = style(label), in_front(label)
    x, y = blocks(curves)
    middle, low, high = band(y)
    ax.plot(x, y.T, color=its.colour, linewidth=0.4, alpha=0.35, zorder=front - 1)
    ax.fill_between(x, low, high, color=its.colour, alpha=0.18, linewidth=0, zorder=front - 0.5)
    every = max(1, len(x) // 8)
    ax.plot(
        x,
        middle,
        its.line,
        color=its.colour,
        linewidth=its.width,
        marker=its.marker,
        ms=4,
        markevery=every,
        zorder=front,
    )
    return float(middle[-1])


def training_panels(
    results: Results, methods: Sequence[str], title: str, panels=PANELS, rule: Results | None = None
) -> Figure:
    """Panels of training curves, two in a row, with each method's name at its end."""
    methods = [method for method in methods if method in results.methods]
    rows = -(-len(panels) // 2)
    figure = new_figure(0.7 + 2.6 * rows, 9.0)
    axes = figure.subplots(rows, 2, squeeze=False)
    figure.subplots_adjust(
        left=0.045, right=0.865, top=1 - 0.9 / (0.7 + 2.6 * rows), bottom=0.22 / rows, hspace=0.42, wspace=0.56
    )
    figure.canvas.draw()
    for i, panel in enumerate(panels):
        ax, ends = axes.flat[i], []
        for method in methods:
            curves = results.of(method).curves[panel.curve] * panel.scale
            end = draw_curve(ax, method, curves)
            if np.isfinite(end):
                ends.append((end, display_name(method), style(method).colour))
            if panel.column and method in PRINTED:
                ax.plot(1.0, PRINTED[method][panel.column].mean, "D", mfc="white", mec=style(method).colour, ms=5,
                        transform=ax.get_yaxis_transform(), clip_on=False, zorder=4)  # fmt: skip
        if rule is not None and panel.column:
            level = float(rule.scores(panel.column)[0]) * panel.scale
            ax.axhline(level, color=style("rule").colour, linewidth=style("rule").width)
            ends.append((level, display_name("rule"), style("rule").colour))
        plain_axes(ax, panel.label)
        ax.set_xlim(0, results.curves[panel.curve].shape[1])
        ax.set_xlabel("training episode", fontsize=SMALL, color=QUIET)
        label_ends(ax, ends, size=SMALL, wrap=22, gap=0.035)
    for ax in list(axes.flat)[len(panels) :]:
        ax.set_visible(False)
    figure.text(0.012, 0.01, LEGEND, fontsize=SMALL, color=QUIET)
    return finish(figure, title, panels_in_words(results, methods, panels))


def panels_in_words(results: Results, methods: Sequence[str], panels: Sequence[CurveAxes]) -> str:
    """The last tenth of every curve, for those who cannot see it."""
    parts = []
    for panel in panels:
        ends = []
        for method in methods:
            curves = results.of(method).curves[panel.curve]
            last = np.nanmean(curves[:, -max(1, curves.shape[1] // 10) :]) * panel.scale
            ends.append(f"{display_name(method)} {last:.3g}")
        parts.append(f"{panel.label}: {', '.join(ends)}")
    return "Means over the last tenth of training. " + "; ".join(parts) + "."


def escaped(results: Results, method: str) -> str:
    """ "7 of 10": how many agents of a method escape in at least half of their held-out episodes."""
    success = results.of(method).scores("success")
    return f"{int((success >= ESCAPES).sum())} of {len(success)}"


def margin_against_bonus(results: Results, rule: Results | None = None) -> Figure:
    """The paper's first training figure (Figure 4): demonstrations by a bonus, or by a large margin."""
    title = (
        f"Agents that escape: {escaped(results, 'demos')} with the bonus, {escaped(results, 'margin')} with the margin"
    )
    return training_panels(results, ("margin", "margin_soft", "demos", "bootstrapped"), title, rule=rule)


def ablation(results: Results, rule: Results | None = None) -> Figure:
    """The paper's second training figure (Figure 5): each ingredient alone, and both."""
    methods = ("sac", "soft", "demos", "bootstrapped")
    short = {"sac": "plain", "soft": "soft constraint", "demos": "demonstrations", "bootstrapped": "both"}
    title = "Agents that escape: " + ", ".join(f"{escaped(results, method)} {short[method]}" for method in methods)
    return training_panels(results, methods, title, rule=rule)


def baselines(results: Results, rule: Results | None = None) -> Figure:
    """The paper's third training figure (Figure 6): the method against others."""
    methods = ("bc", "cql", "gail", "sac", "bootstrapped")
    short = {"bc": "BC", "cql": "CQL", "gail": "GAIL", "sac": "SAC", "bootstrapped": "bootstrapped"}
    title = "Agents that escape: " + ", ".join(f"{escaped(results, method)} {short[method]}" for method in methods)
    return training_panels(results, methods, title, rule=rule)


def exploration(results: Results, methods: Sequence[str] = ("sac", "soft", "demos", "bootstrapped")) -> Figure:
    """The paper's Figure 7: entropy, and e to the power of it, the effective actions (Equations 21 and 22)."""
    entropy = results.curves["entropy"].astype(np.float64)
    both = Results(results.agents, results.stopped, results.tested, {"entropy": entropy, "effective": np.exp(entropy)})
    panels = (CurveAxes("entropy", "policy entropy, nats"), CurveAxes("effective", "effective number of actions"))
    ends = [
        float(both.of(method).curves["effective"][:, -max(1, entropy.shape[1] // 10) :].mean())
        for method in ("sac", "bootstrapped")
    ]
    title = f"At the end SAC chooses among {ends[0]:.1f} actions, bootstrapped SAC among {ends[1]:.1f}"
    return training_panels(both, methods, title, panels)


def final_scores(results: Results, methods: Sequence[str], column: str = "returns") -> Figure:
    """Each agent's score on the held-out episodes, and their interquartile mean with its interval."""
    methods = [method for method in methods if method in results.methods]
    figure = new_figure(0.9 + 0.36 * len(methods))
    ax = figure.add_axes(
        (0.27, 0.55 / (0.9 + 0.36 * len(methods)), 0.68, 0.36 * len(methods) / (0.9 + 0.36 * len(methods)) * 0.9)
    )
    scale, words = 100 if column in RATES else 1, []
    for row, method in enumerate(methods):
        scores, its = results.of(method).scores(column) * scale, style(method)
        middle = interval(scores)
        ax.plot(
            scores, np.full(len(scores), row) + np.linspace(-0.2, 0.2, len(scores)), ".", color=its.colour, alpha=0.45
        )
        ax.plot([middle.low, middle.high], [row, row], "-", color=its.colour, linewidth=3, alpha=0.6)
        ax.plot(middle.value, row, "|", color=its.colour, ms=14, mew=2.5)
        if method in PRINTED and column in COLUMNS:
            ax.plot(PRINTED[method][column].mean, row, "D", mfc="white", mec=its.colour, ms=5, zorder=4)
        words.append(f"{display_name(method)} {middle.value:.3g} [{middle.low:.3g}, {middle.high:.3g}]")
    plain_axes(ax, "", grid="x")
    ax.set_yticks(range(len(methods)), [display_name(method) for method in methods])
    ax.set_ylim(len(methods) - 0.5, -0.5)
    ax.set_xlabel(COLUMNS.get(column, column), fontsize=SMALL, color=QUIET)
    ax.spines["bottom"].set_color(GRID)
    middles = {method: interval(results.of(method).scores(column)).value for method in methods}
    best = [display_name(method) for method in methods if middles[method] == max(middles.values())]
    title = f"Highest {COLUMNS.get(column, column).split(',')[0]}: {', '.join(best)}"
    return finish(figure, title, "Interquartile means over agents with 95 % intervals: " + "; ".join(words) + ".")
