"""The chain of five states, as a diagram; what its trap is worth, sweep by sweep; which learners leave it."""

from collections.abc import Mapping, Sequence

import numpy as np
from matplotlib.figure import Figure

from bootcourse.colours import OTHER
from bootcourse.course import charts
from bootcourse.course.lessons.the_barrier import figures
from bootcourse.course.lessons.values import chain
from bootcourse.plots.diagrams import Diagram, arrow, box, label, line

WIDE, STEP, TOP, HIGH = 106, 142, 60, 52  # pixels: of a box, from box to box, its top and height


def five_states() -> Diagram:
    """The states in a row: on to the next one, back to the trap, and what staying at the two ends pays."""
    left = [28 + STEP * s for s in range(chain.STATES)]
    names = ["the trap", "1", "2", "3", "the free road"]
    stay, free = chain.REWARD[0, 0], chain.REWARD[4, 0]
    parts, low = [], TOP + HIGH + 36
    for s, x in enumerate(left):
        lines = ("0", names[0]) if s == 0 else ("4", names[4]) if s == 4 else (str(s),)
        parts.append(box(x, TOP, WIDE, HIGH, lines, {0: "stored", 4: "world"}.get(s, "learned")))
        if s < 4:
            parts += [arrow(x + WIDE, TOP + HIGH / 2, left[s + 1], TOP + HIGH / 2)]
            parts += [label(x + WIDE + (STEP - WIDE) / 2, TOP + HIGH / 2 - 8, "1")]
        if s in (1, 2, 3):
            parts += [line(x + WIDE / 2, TOP + HIGH, x + WIDE / 2, low), label(x + WIDE / 2 + 9, TOP + HIGH + 22, "0")]
    parts += [line(left[3] + WIDE / 2, low, left[0] + WIDE / 2, low)]
    parts += [arrow(left[0] + WIDE / 2, low, left[0] + WIDE / 2, TOP + HIGH)]
    for x, words in ((left[0], f"action 0: +{stay:g}"), (left[4], f"action 0 or 1: +{free:g}")):
        parts += [line(x + 36, TOP, x + 36, TOP - 22), line(x + 36, TOP - 22, x + 70, TOP - 22)]
        parts += [arrow(x + 70, TOP - 22, x + 70, TOP), label(x + WIDE / 2, TOP - 32, words)]
    alt = (
        f"Five states in a row, from 0, the trap, to 4, the free road. In the trap action 0 stays and pays {stay:g}. "
        "Action 1 leads from each of the states 0 to 3 to the next one and pays 0. Action 0 leads from the states 1, 2 "
        f"and 3 back to the trap and pays 0. On the free road both actions stay and pay {free:g}."
    )
    return Diagram(left[4] + WIDE + 28, low + 12, parts, alt)


def in_the_trap(found: Sequence[np.ndarray]) -> Figure:
    """Q of staying in the trap and of leaving it, from each sweep's Q (5, 2), the zeros before the first included."""
    stay, leave = np.array(found)[:, 0].T
    title = "Sweep 5 brings the free road's value to the trap; from sweep 6 on leaving is worth more"
    named, looks = {"stay in the trap": stay, "leave it": leave}, [OTHER, charts.Style("#56B4E9")]
    return charts.lines(range(len(found)), named, title, "sweep", "Q in state 0, γ = 0.8", looks=looks)


def who_leaves(found: Mapping[str, Sequence[np.ndarray]]) -> Figure:
    """Which learners of each kind learned to leave the trap, from the Q (5, 2) that each ends with."""
    title = "Chance alone or a replayed demonstration teaches all thirty to leave, a longer view none"
    rows = {kind: figures.learners(all_q) for kind, all_q in found.items()}
    return figures.squares({"": rows}, title, figures.LEARNERS)
