"""The study's figures: the paper's training panels, exploration, final scores.

Every one takes `Results` and returns a matplotlib figure with `figure.alt`. Titles are made from the
numbers, so they cannot say what the numbers do not.
"""

from collections.abc import Sequence

import numpy as np
from matplotlib.figure import Figure

from bootcourse.methods import display_name, style
from bootcourse.plots.figure import GRID, INK, SMALL, TEXT, finish, new_figure, plain_axes
from bootcourse.plots.training_curves import MEASURES, training_curves
from bootcourse.research.paper import COLUMNS, PRINTED, RATES
from bootcourse.research.results import Results
from bootcourse.research.tables import escaped
from bootcourse.statistics import interval

TRAINING = {"success": "success", "return": "returns", "speed": "speed", "distance": "distance"}  # curve: column
TRAINING_FIGURES = {  # the paper's Figures 4 to 6: the methods, and those whose agents the title counts, by name
    "margin-against-bonus": (
        ("margin", "margin_soft", "demos", "bootstrapped"),
        {"demos": "with the bonus", "margin": "with the margin"},
    ),
    "ablation": (
        ("sac", "soft", "demos", "bootstrapped"),
        {"sac": "plain", "soft": "soft constraint", "demos": "demonstrations", "bootstrapped": "both"},
    ),
    "baselines": (
        ("bc", "cql", "gail", "sac", "bootstrapped"),
        {"bc": "BC", "cql": "CQL", "gail": "GAIL", "sac": "SAC", "bootstrapped": "bootstrapped"},
    ),
}


def of_methods(results: Results, methods: Sequence[str]) -> dict[str, dict[str, np.ndarray]]:
    """{method: {curve: (agents, episodes)}}, without agents that were stopped: they have no curve to their end."""
    of_method = {}
    for method in methods:
        if method in results.methods:
            curves = results.of(method).curves
            whole = np.logical_and.reduce([np.isfinite(values).all(axis=1) for values in curves.values()])
            if whole.any():
                of_method[method] = {name: values[whole] for name, values in curves.items()}
    return of_method


def training_panels(results: Results, name: str, rule: Results | None = None) -> Figure:
    """One of `TRAINING_FIGURES`: success, return, speed and distance, the rule's level and the paper's test results."""
    methods, named = TRAINING_FIGURES[name]
    printed = {
        method: {curve: PRINTED[method][column].mean / MEASURES[curve].factor for curve, column in TRAINING.items()}
        for method in methods
        if method in PRINTED and method in results.methods
    }
    levels = {curve: float(rule.scores(column)[0]) for curve, column in TRAINING.items()} if rule is not None else {}
    counts = ", ".join(f"{escaped(results, method)} {words}" for method, words in named.items())
    curves, title = of_methods(results, methods), f"Agents that escape: {counts}"
    return training_curves(curves, title, {"rule": levels}, printed, tuple(TRAINING))


def exploration(results: Results) -> Figure:
    """The paper's Figure 7: entropy, and e to the power of it, the effective actions (Equations 21 and 22)."""
    curves = of_methods(results, ("sac", "soft", "demos", "bootstrapped"))
    last = {}
    for method, of_method in curves.items():
        effective = of_method["effective"] = np.exp(of_method["entropy"].astype(np.float64))
        last[method] = effective[:, -max(1, effective.shape[1] // 10) :]
    title = (
        f"In the last tenth of training plain SAC has {last['sac'].mean():.2f} effective actions on average, "
        f"bootstrapped SAC {last['bootstrapped'].mean():.2f}"
    )
    return training_curves(curves, title, measures=("entropy", "effective"))


def final_scores(results: Results, methods: Sequence[str], column: str = "returns", title: str = "") -> Figure:
    """Each agent's score on the held-out episodes, and their interquartile mean with its interval.

    title: "" for one that names the methods with the highest scores.
    """
    methods = [method for method in methods if method in results.methods]
    height = 1.4 + 0.42 * len(methods)
    figure = new_figure(height)
    ax = figure.add_axes((0.27, 0.8 / height, 0.68, 0.42 * len(methods) / height))
    scale, words, label = 100 if column in RATES else 1, [], (COLUMNS | {"returns": "return"}).get(column, column)
    middles = {}
    for row, method in enumerate(methods):
        scores, look = results.of(method).scores(column) * scale, style(method)
        middles[method] = middle = interval(scores)
        ax.plot(scores, row - 0.08 + np.linspace(-0.24, 0.24, len(scores)), "o", color=look.colour, ms=4)
        below = row + 0.34  # the interval is no place of agents: it stands below them
        ax.plot([middle.low, middle.high], [below, below], "-", color=look.colour, linewidth=1.5, zorder=1)
        ax.plot([middle.low, middle.value, middle.high], [below] * 3, "|", color=look.colour, ms=7, mew=1.5)
        if method in PRINTED and column in COLUMNS:
            ax.plot(PRINTED[method][column].mean, row - 0.08, "D", mfc="white", mec=look.colour, ms=5, zorder=4)
        words.append(f"{display_name(method)} {middle.value:.3g} [{middle.low:.3g}, {middle.high:.3g}]")
    plain_axes(ax, "", grid="x")
    ax.set_yticks(range(len(methods)), [display_name(method) for method in methods])
    ax.set_ylim(len(methods) - 0.5, -0.5)
    ax.set_xlabel(label, fontsize=TEXT, color=INK)
    key = "Dots: agents. Lines: their interquartile mean (middle tick) and its 95 % interval. Diamonds: the paper."
    figure.text(0.012, 0.12 / height, key, fontsize=SMALL, color=INK)
    ax.spines["bottom"].set_color(GRID)
    best = max(middles.values(), key=lambda middle: middle.value)
    ahead = [display_name(m) for m, middle in middles.items() if middle is best or middle.high >= best.low]
    within = ", as far as the intervals tell" * (len(ahead) > 1)
    title = title or f"Highest {label.split(',')[0]}{within}: {', '.join(ahead)}"
    return finish(figure, title, "Interquartile means over agents with 95 % intervals: " + "; ".join(words) + ".")
