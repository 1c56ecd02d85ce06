"""What the lesson's own parts did: where an actor ends with and without a stop; what α does in the chain's trap."""

from collections.abc import Mapping, Sequence

import numpy as np
from matplotlib.figure import Figure

from bootcourse.colours import INK, PALE, TRAP
from bootcourse.course import table
from bootcourse.course.dots import name_rows
from bootcourse.course.lessons.discrete_sac.explorable import ACTIONS, ALPHA, START
from bootcourse.course.lessons.discrete_sac.own_parts import GAMMA, STEPS, SURE, Descent, Fit, Walked
from bootcourse.methods import style
from bootcourse.plots.figure import SMALL, TEXT, axes_at, finish, new_figure


def descents(ends: Mapping[str, Descent]):
    """A table of the best policy of Round 1's Q, and of where actors end: {which loss: its end}."""
    best = np.exp(np.array(START) / ALPHA)
    straight = ACTIONS.index("straight")
    rows = [["softmax(Q / α)", f"{best[straight] / best.sum():.2f}", f"{START[straight]:.2f}", ""]]
    for name, end in ends.items():
        numbers = end.pi[straight], end.q[straight], end.loss
        rows.append([name, *(f"{number:.2f}".replace("-", "−") for number in numbers)])
    return table([f"after {STEPS} steps", "π(straight)", "Q(straight)", "loss"], rows)


def fits(ends: Mapping[str, Fit]):
    """A table of where the critics end on one transition: {which loss: its end}."""
    rows = [["at first", "0", "1", f"{2 * GAMMA**2:.2f}"]]
    rows += [[name, *(f"{number:.2f}" for number in end)] for name, end in ends.items()]
    return table([f"r = 0, γ = {GAMMA}; after {STEPS} steps", "Q(s, a)", "V(s′)", "loss"], rows)


def two_jobs(alphas: Sequence[float], start: float, walked: Walked, others: Mapping[str, Walked]) -> Figure:
    """What α does in the chain's trap: how many learners find the way out, and how sure these then are of taking it.

    walked: the learners at each temperature, and last those whose temperature falls from `start`;
    others: the same with other targets, by what these are.
    """
    names = [*(f"α = {alpha:g}" for alpha in alphas), f"α falls from {start:g}", *others]
    leaves, found = (
        np.vstack([getattr(of, part) for of in (walked, *others.values())]) for part in ("leaves", "found")
    )
    parts = {
        "found it, sure of leaving": (found & (leaves > SURE), style("sac").colour, "white"),
        "found it, undecided": (found & (leaves <= SURE) & (leaves >= 1 - SURE), PALE, INK),
        "found it, sure of staying": (found & (leaves < 1 - SURE), TRAP, "white"),
        "never found it": (~found, "white", INK),
    }
    counts = (found & (leaves > SURE)).sum(axis=1)
    most = counts[: len(alphas)].max()
    title = f"Sure of leaving: at most {most} at these constant α, {counts[len(alphas)]} if it falls"
    row, before, alt_parts = 0.33, np.zeros(len(names)), []
    figure = new_figure(0.95 + row * len(names) + 0.6)
    ax = axes_at(figure, 1.75, 0.95, 4.9, row * len(names))
    for words, (of, colour, letters) in parts.items():
        look = {"color": colour, "edgecolor": INK, "linewidth": 0.7, "clip_on": False}
        ax.barh(names, of.sum(axis=1), 0.72, left=before, label=words, **look)
        for place, count in enumerate(of.sum(axis=1)):
            if count > 8:  # there is room for the number
                at = {"fontsize": TEXT, "color": letters, "ha": "center", "va": "center"}
                ax.text(before[place] + count / 2, place, str(count), **at)
        before += of.sum(axis=1)
        alt_parts.append(f"{words}: {', '.join(map(str, of.sum(axis=1)))}")
    name_rows(ax, names, f"of {walked.leaves.shape[1]} learners")
    ax.legend(loc="lower left", bbox_to_anchor=(-0.02, 1.06), ncols=2, fontsize=SMALL, frameon=False, columnspacing=1.2)
    alt = f"A bar for each kind of learner: {', '.join(names)}. Of each kind, in this order, {'; '.join(alt_parts)}. "
    return finish(figure, title, alt)
