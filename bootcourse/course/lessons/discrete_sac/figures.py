"""What the lesson's own parts did: where an actor ends with and without a stop; what α does in the chain's trap."""

from collections.abc import Mapping, Sequence

import numpy as np
from matplotlib.figure import Figure

from bootcourse.colours import INK, PALE, TRAP
from bootcourse.course import table
from bootcourse.course.dots import name_rows
from bootcourse.course.lessons.discrete_sac.explorable import ACTIONS, ALPHA, START
from bootcourse.course.lessons.discrete_sac.own_parts import STEPS, SURE, Descent, Walked
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


def constant_alpha(alphas: Sequence[float], walked: Walked) -> Figure:
    """How many learners find the chain's way out at each constant temperature, and how sure these are of taking it."""
    title = f"Sure of leaving: at most {(walked.leaves > SURE).sum(axis=1).max()} at these constant α"
    return _how_far([f"α = {alpha:g}" for alpha in alphas], walked.leaves, walked.found, title)


def found_by_pay(walked: Mapping[str, Walked]):
    """A table of how many learners of one constant temperature find the free road, by the pay in their target."""
    return table(
        ["pay in the target", "find the free road"], [[pay, int(of.found.sum())] for pay, of in walked.items()]
    )


def falling_alpha(start: float, walked: Mapping[str, Walked]) -> Figure:
    """The same of learners whose temperature falls from `start`, by the pay in their target: first α H, last none."""
    leaves, found = (np.vstack([getattr(of, part) for of in walked.values()]) for part in ("leaves", "found"))
    paid, *_, unpaid = (leaves > SURE).sum(axis=1)
    title = f"If α falls from {start:g}, {paid} end sure of leaving with the pay α H, and {unpaid} without pay"
    return _how_far([f"pay: {pay}" for pay in walked], leaves, found, title)


def _how_far(names: Sequence[str], leaves: np.ndarray, found: np.ndarray, title: str) -> Figure:
    """A bar for each kind of learner, by how far each got. leaves, found: (kinds, learners)."""
    parts = {
        "found it, sure of leaving": (found & (leaves > SURE), style("sac").colour, "white"),
        "found it, undecided": (found & (leaves <= SURE) & (leaves >= 1 - SURE), PALE, INK),
        "found it, sure of staying": (found & (leaves < 1 - SURE), TRAP, "white"),
        "never found it": (~found, "white", INK),
    }
    row, before, alt_parts = 0.33, np.zeros(len(names)), []
    figure = new_figure(0.95 + row * len(names) + 0.6)
    ax = axes_at(figure, 1.75, 0.95, 4.9, row * len(names))
    for words, (of, colour, letters) in parts.items():
        look = {"color": colour, "edgecolor": INK, "linewidth": 0.7, "clip_on": False}
        ax.barh(names, of.sum(axis=1), 0.72, left=before, label=words, **look)
        for place, count in enumerate(of.sum(axis=1)):
            if count > 4:  # there is room for the number
                at = {"fontsize": TEXT, "color": letters, "ha": "center", "va": "center"}
                ax.text(before[place] + count / 2, place, str(count), **at)
        before += of.sum(axis=1)
        alt_parts.append(f"{words}: {', '.join(map(str, of.sum(axis=1)))}")
    name_rows(ax, names, f"of {leaves.shape[1]} learners")
    ax.legend(loc="lower left", bbox_to_anchor=(-0.02, 1.02), ncols=2, fontsize=SMALL, frameon=False, columnspacing=1.2)
    alt = f"A bar for each kind of learner: {', '.join(names)}. Of each kind, in this order, {'; '.join(alt_parts)}. "
    return finish(figure, title, alt)
