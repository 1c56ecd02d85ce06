"""What the lesson's own parts did: where an actor ends with and without a stop; what α does in the chain's trap."""

from collections.abc import Mapping, Sequence

import numpy as np
from matplotlib.figure import Figure

from bootcourse.colours import INK, OTHER, Style
from bootcourse.course import charts, table
from bootcourse.course.lessons.discrete_sac.explorable import ACTIONS, ALPHA, START
from bootcourse.course.lessons.discrete_sac.own_parts import STEPS, Descent, Walked
from bootcourse.methods import style


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
    """What α does in the chain's trap: how many learners find the way out, and how probably they take it.

    knows: π(leave | trap) of an agent that knows the whole chain; walked: the learners at each temperature.
    """
    title = "A small α rarely finds the road, a large one takes it by chance"
    named = {
        "takes: leaves, knowing the map": np.array(knows),
        "tries: finds the free road": walked.found.mean(axis=1),
        "the thirty leave, on average": walked.leaves.mean(axis=1),
    }
    looks = [Style(INK, "--"), Style(OTHER.colour, "--"), style("sac")]
    ends = (f"{name}: {line[0]:.2f} at {alphas[0]:g}, {line[-1]:.2f} at {alphas[-1]:g}" for name, line in named.items())
    axes = "temperature α", "probability, or share of 30", "x", {"a coin": 0.5}, (-0.02, 1.05), looks
    return charts.lines(alphas, named, title, *axes, f"{'; '.join(ends)}.")
