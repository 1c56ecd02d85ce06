"""Return and accidents against how far a driver looks ahead."""

import numpy as np
from matplotlib.figure import Figure
from matplotlib.ticker import NullLocator

from bootcourse.episodes.lookahead import HORIZON
from bootcourse.methods import style
from bootcourse.plots.figure import INK, TEXT, axes_at, finish, new_figure, plain_axes
from bootcourse.research.lookahead import HORIZONS, Cell
from bootcourse.research.lookahead_figures import double_line, score
from bootcourse.research.results import Results


def by_horizon(cells: dict[str, Results], base: str, title: str) -> Figure:
    """Two panels over the number of decisions that a base policy's agents look ahead; 0: the agents alone."""
    figure, colour = new_figure(3.6), style(base).colour
    of = {h: score(cells, Cell(base, "rollouts" if h else "alone", horizon=h or HORIZON))
          for h in (0, *sorted((*HORIZONS, HORIZON)))}  # fmt: skip
    measures = {
        "return": [one.returns for one in of.values()],
        "accidents in 1,000 drives": [[1000 * value for value in one.accident_rate] for one in of.values()],
    }
    alt_parts = []
    for left, (words, estimates) in zip((0.45, 3.95), measures.items(), strict=True):
        ax = axes_at(figure, left, 0.95, 2.85, 2.05)
        plain_axes(ax, words)
        middle, low, high = np.array(estimates).T
        double_line(ax, list(of), middle, colour)
        ax.errorbar(list(of), middle, [middle - low, high - middle], fmt="o", color=colour, ms=5, lw=1.3, zorder=3)
        ax.set_xticks(list(of), ["alone", *map(str, list(of)[1:])])
        ax.xaxis.set_minor_locator(NullLocator())
        ax.set_xlabel("decisions ahead", fontsize=TEXT, color=INK)
        ax.set_ylim((0, 1.1 * high.max()) if words.startswith("accidents") else (low.min() - 2, high.max() + 2))
        alt_parts.append(f"{words}: {', '.join(f'{m:.1f} at {h}' for h, m in zip(of, middle, strict=True))}")
    return finish(figure, title, f"{'; '.join(alt_parts)}.")
