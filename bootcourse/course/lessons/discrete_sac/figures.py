"""What the lesson's own parts did: where an actor ends with and without a stop; what α does in the chain's trap."""

from collections.abc import Mapping, Sequence

import numpy as np
from matplotlib.figure import Figure

from bootcourse.colours import INK, PALE
from bootcourse.course import table
from bootcourse.course.dots import beside, name_rows
from bootcourse.course.lessons.discrete_sac.explorable import ACTIONS, ALPHA, START
from bootcourse.course.lessons.discrete_sac.own_parts import STEPS, SURE, Descent, Walked
from bootcourse.methods import style
from bootcourse.plots.figure import QUIET, SMALL, axes_at, finish, new_figure


def descents(ends: Mapping[str, Descent]):
    """A table of the best policy of Round 1's Q, and of where actors end: {which loss: its end}."""
    best = np.exp(np.array(START) / ALPHA)
    straight = ACTIONS.index("straight")
    rows = [["softmax(Q / α)", f"{best[straight] / best.sum():.2f}", f"{START[straight]:.2f}", ""]]
    for name, end in ends.items():
        numbers = end.pi[straight], end.q[straight], end.loss
        rows.append([name, *(f"{number:.2f}".replace("-", "−") for number in numbers)])
    return table([f"after {STEPS} steps", "π(straight)", "Q(straight)", "loss"], rows)


def two_jobs(alphas: Sequence[float], knows: Sequence[float], walked: Walked) -> Figure:
    """What α does in the chain's trap: how many learners find the way out, and how many then surely take it.

    knows: π(leave | trap) of an agent that knows the whole chain; walked: the learners at each temperature, and last
    those whose temperature falls.
    """
    names = [*(f"α = {alpha:g}" for alpha in alphas), f"α falls, {max(alphas):g} to {min(alphas):g}"]
    parts = {
        "sure of leaving": (walked.leaves > SURE, style("sac").colour),
        "found the free road": (walked.found & (walked.leaves <= SURE), PALE),
        "never found it": (~walked.found, "white"),
    }
    row, before, alt_parts = 0.36, np.zeros(len(names)), []
    figure = new_figure(1.15 + row * len(names) + 0.8)
    ax = axes_at(figure, 1.35, 1.15, 3.6, row * len(names))
    for words, (of, colour) in parts.items():
        ax.barh(names, of.sum(axis=1), 0.72, left=before, color=colour, edgecolor=INK, linewidth=0.7, label=words)
        before += of.sum(axis=1)
        alt_parts.append(f"{words}: {', '.join(map(str, of.sum(axis=1)))}")
    beside(ax, -0.75, "takes it, with the map", colour=QUIET)
    for place, known in enumerate([*knows, knows[0]]):  # a falling α ends at the first
        beside(ax, place, f"{known:.2f}")
    name_rows(ax, names, f"of {walked.leaves.shape[1]} learners")
    ax.legend(loc="lower left", bbox_to_anchor=(-0.02, 1.08), ncols=3, fontsize=SMALL, frameon=False, columnspacing=1.2)
    words = "With the map: how probably an agent that knows the chain leaves (falling: in the end)."
    figure.text(0.012, 0.1 / figure.get_figheight(), words, fontsize=SMALL, color=QUIET)
    alt = f"{'; '.join(alt_parts)}. With the map: {', '.join(f'{each:.2f}' for each in knows)}."
    title = "A small α rarely finds the road, a large one takes it by chance; falling often does both"
    return finish(figure, title, f"Learners with {', '.join(names)}. {alt}")
