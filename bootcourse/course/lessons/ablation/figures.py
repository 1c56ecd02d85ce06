"""Figures of the ablation: each agent's success after training and while it trains, and the two clocks."""

from collections.abc import Sequence

import numpy as np
from matplotlib.figure import Figure

from bootcourse.methods import display_name, style
from bootcourse.plots.figure import INK, QUIET, SMALL, TEXT, finish, new_figure, plain_axes
from bootcourse.plots.training_curves import WINDOW, training_curves
from bootcourse.research.clocks import faded
from bootcourse.research.figures import of_methods
from bootcourse.research.results import Results
from bootcourse.research.tables import escaped
from bootcourse.statistics import ESCAPES, rolling_means

PANEL, GAP = 1.15, 0.5  # inches: the height of a panel, and between two


def who_escapes(results: Results, methods: Sequence[str]) -> Figure:
    """Each agent's success on the held-out roads as a dot, one row for each method; filled if it escapes."""
    height = 1.15 + 0.5 * len(methods)
    figure, told = new_figure(height), []
    ax = figure.add_axes((0.24, 0.5 / height, 0.6, 1 - 1.1 / height))
    ax.axvline(100 * ESCAPES, color=QUIET, linewidth=1, linestyle=(0, (2, 2)), zorder=1)
    for row, method in enumerate(methods):
        success, colour = np.sort(100 * results.of(method).scores("success")), style(method).colour
        places = row + np.linspace(-0.3, 0.3, len(success))
        fills = [colour if each >= 100 * ESCAPES else "white" for each in success]
        ax.scatter(success, places, s=26, c=fills, edgecolors=colour, linewidths=1.2, zorder=3, clip_on=False)
        words = f"{escaped(results, method)} escape"
        ax.annotate(words, (1.04, row), xycoords=("axes fraction", "data"), va="center", fontsize=TEXT, color=INK)
        told.append(f"{display_name(method)}: {', '.join(f'{each:.0f}' for each in success)} %")
    plain_axes(ax, "", grid="x")
    ax.set_yticks(range(len(methods)), [display_name(method) for method in methods])
    ax.tick_params(axis="y", labelcolor=INK, labelsize=TEXT)
    ax.set(xlim=(-2, 102), ylim=(len(methods) - 0.5, -0.5))
    words = f"success of an agent on the held-out roads (%); filled: {100 * ESCAPES:.0f} % or more, it escapes"
    ax.set_xlabel(words, fontsize=SMALL, color=INK)
    everyone = np.concatenate([results.of(method).scores("success") for method in methods])
    split = int(((everyone > 0.9) | (everyone < 0.1)).sum())
    title = (
        f"Training works or fails: {split} of {len(everyone)} agents succeed on over 90 % of the roads or under 10 %"
    )
    return finish(figure, title, f"A dot for each agent. {'; '.join(told)}.")


def seed_by_seed(results: Results, methods: Sequence[str], title: str, mark: int, words: str) -> Figure:
    """Success in training, a panel for each method: a thin line for each agent, a thick one for their mean.

    mark: the episode of a vertical line, and the words at it.
    """
    height = 1.15 + len(methods) * (PANEL + GAP)
    figure, told = new_figure(height), []
    for row, method in enumerate(methods):
        bottom = height - 0.8 - row * (PANEL + GAP) - PANEL
        ax = figure.add_axes((0.06, bottom / height, 0.9, PANEL / height))
        at, success = rolling_means(100 * results.of(method).curves["success"], WINDOW)
        mean, colour = success.mean(axis=0), style(method).colour
        ax.plot(at, success.T, color=colour, linewidth=0.8, alpha=0.55)
        ax.plot(at, mean, color=colour, linewidth=2.6)
        ax.axvline(mark, color=QUIET, linewidth=1, linestyle=(0, (2, 2)), zorder=1)
        if row == 0:
            ax.annotate(words, (mark, 1.02), xycoords=("data", "axes fraction"), xytext=(5, 0), va="bottom",
                        textcoords="offset points", fontsize=SMALL, color=QUIET)  # fmt: skip
        plain_axes(ax, display_name(method))
        ax.set(xlim=(0, at[-1]), ylim=(-4, 104), yticks=(0, 50, 100))
        ax.tick_params(labelbottom=row == len(methods) - 1)
        near = np.searchsorted(at, [mark - 200, mark, at[-1]])
        told.append(f"{display_name(method)}: " + ", ".join(f"{mean[i]:.0f} % at episode {at[i]}" for i in near))
    ax.set_xlabel("training episode", fontsize=TEXT, color=INK)
    each = f"Success in the last {WINDOW} episodes (%). Thin: agents. Thick: their mean"
    figure.text(0.012, 0.1 / height, f"{each}.", fontsize=SMALL, color=QUIET)
    return finish(figure, title, f"{each}: {'; '.join(told)}.")


def two_clocks(results: Results, updates: str) -> Figure:
    """ξ, which fades with the updates, and success, of four methods with so many updates per decision.

    results: a cell of `clocks.cells`. The title says when ξ is down to a tenth and when β is 0.
    """
    xi, beta = faded(results.of("soft").curves["xi"]), results.of("demos").agents[0]["beta_episodes"]
    title = f"{updates} updates per decision: ξ is down to a tenth after {xi:.0f} episodes, β is 0 after {beta:,}"
    curves = of_methods(results, ("sac", "soft", "demos", "bootstrapped"))
    return training_curves(curves, title, measures=("xi", "success"))
