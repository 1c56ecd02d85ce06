"""The figures of the lesson on seeds: each agent's success after training, and the power of a comparison."""

from collections.abc import Sequence

import numpy as np
from matplotlib.figure import Figure

from bootcourse.methods import display_name, style
from bootcourse.plots.figure import INK, QUIET, SMALL, TEXT, finish, label_ends, new_figure, one_axes, plain_axes
from bootcourse.research.results import Results
from bootcourse.research.tables import escaped
from bootcourse.statistics import ESCAPES, power


def who_escapes(results: Results, methods: Sequence[str]) -> Figure:
    """Each agent's success on the held-out roads as a dot, one row for each method; filled if it escapes."""
    height = 1.15 + 0.75 * len(methods)
    figure, alt_parts = new_figure(height), []
    ax = figure.add_axes((0.24, 0.5 / height, 0.57, 1 - 1.1 / height))
    ax.axvline(100 * ESCAPES, color=QUIET, linewidth=1, linestyle=(0, (2, 2)), zorder=1)
    for row, method in enumerate(methods):
        success, colour = np.sort(100 * results.of(method).scores("success")), style(method).colour
        places = row + np.linspace(-0.38, 0.38, len(success))
        fills = [colour if each >= 100 * ESCAPES else "white" for each in success]
        ax.scatter(success, places, s=18, c=fills, edgecolors=colour, linewidths=1.2, zorder=3, clip_on=False)
        one = (success >= 100 * ESCAPES).sum() == 1
        words = f"{escaped(results, method)} escape{'s' if one else ''}"
        ax.annotate(words, (1.04, row), xycoords=("axes fraction", "data"), va="center", fontsize=TEXT, color=INK)
        alt_parts.append(f"{display_name(method)}: {', '.join(f'{each:.0f}' for each in success)} %")
    plain_axes(ax, "", grid="x")
    ax.set_yticks(range(len(methods)), [display_name(method) for method in methods])
    ax.tick_params(axis="y", labelcolor=INK, labelsize=TEXT)
    ax.set(xlim=(-2, 102), ylim=(len(methods) - 0.5, -0.5))
    words = f"success of an agent on the held-out roads (%); filled: {100 * ESCAPES:.0f} % or more, it escapes"
    ax.set_xlabel(words, fontsize=SMALL, color=INK)
    everyone = np.concatenate([results.of(method).scores("success") for method in methods])
    split = int(((everyone > 0.9) | (everyone < 0.1)).sum())
    who = f"each of {split} agents succeeds" if split == len(everyone) else f"{split} of {len(everyone)} agents succeed"
    title = f"Training works or fails: {who} on over 90 % of the roads or on under 10 %"
    return finish(figure, title, f"A dot for each agent. {'; '.join(alt_parts)}.")


def powers(rates: Sequence[tuple[float, float]], agents: Sequence[int], marked: int = 10) -> Figure:
    """The power of Fisher's test against the agents of each method, a line for each pair of true rates.

    marked: the number of agents whose power is written at a dot.
    """
    found = [[100 * power(*pair, n) for n in agents] for pair in rates]
    first, second = (round(100 * rate) for rate in rates[0])
    share = found[0][list(agents).index(marked)]
    title = f"With {marked} agents of each, {share:.0f} % of the studies tell {first} from {second} %"
    figure, ax = one_axes(3.5, title, "agents of each method", "power (%)", width=0.7)
    ends, alt_parts = [], []
    for pair, line, look in zip(rates, found, ("-", "--"), strict=True):
        ax.plot(agents, line, color=INK, linestyle=look, linewidth=2)
        at_mark = line[list(agents).index(marked)]
        ax.plot(marked, at_mark, "o", color=INK, ms=6)
        ax.annotate(f"{at_mark:.0f} %", (marked, at_mark), (-4, 6), textcoords="offset points", ha="right",
                    fontsize=TEXT, color=INK)  # fmt: skip
        words = f"{100 * pair[0]:.0f} against {100 * pair[1]:.0f} %"
        ends.append((line[-1], words, INK))
        alt_parts.append(f"{words}: " + ", ".join(f"{p:.0f} % with {n}" for n, p in zip(agents, line, strict=True)))
    ax.axhline(80, color=QUIET, linewidth=1, linestyle=(0, (2, 2)), zorder=1)
    ends.append((80, "80 %: the usual aim", QUIET))
    ax.set(xlim=(min(agents), max(agents)), ylim=(0, 100))
    label_ends(ax, ends)
    return finish(figure, title, f"Power against the number of agents. {'; '.join(alt_parts)}.")
