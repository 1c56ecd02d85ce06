"""Figures of the lesson on SAC's update and loop: what small worlds teach, tests, and what critics expect."""

from collections.abc import Mapping, Sequence

import numpy as np
from IPython.display import Markdown
from matplotlib.figure import Figure

from bootcourse.colours import OTHER, QUIET, STRANGERS
from bootcourse.course import charts, table
from bootcourse.course.lessons.update_and_loop import by_hand, numbers, worlds


def small_worlds(*learned: Mapping[str, worlds.Learned]) -> Markdown:
    """A table of what Q should be in each small world, and of what agents learned: one, and one with a bug."""
    rows = []
    for words, world in worlds.WORLDS.items():
        alike = len(set(world.pays[0])) == 1  # both pushes pay the same
        found = (each[words].q for each in learned)
        shown = (f"{q.mean():.1f}" if alike else f"{abs(q[0]):.1f} and {q[1]:.1f}" for q in found)
        rows.append([words, world.right, *shown])
    headings = ["world", "right Q", "your agent's Q", "its Q if `terminated` is lost"]
    return table(headings[: 2 + len(learned)], rows)


def tests_in_training(tests: Sequence[float], block: int) -> Figure:
    """The tests of an agent, one before its training and one after each `block` of pushes, over five of ours."""
    pushes, falls = np.arange(len(tests)) * block, int((np.diff(tests) < 0).sum())
    ended = "Solved after" if min(tests[-2:]) >= 475 else "Not solved in"
    worse = "test is" if falls == 1 else "tests are"
    title = f"{ended} {pushes[-1]:,} pushes; {falls} {worse} worse than the one before"
    figure = charts.lines(pushes, {"your agent": np.array(tests)}, title, "pushes in training",
                          "pushes balanced (thin: five of ours)", looks=[OTHER._replace(marker="o")])  # fmt: skip
    (ax,) = figure.axes
    for each in numbers.tests():
        ax.plot(numbers.BLOCK * np.arange(len(each)), each, color=QUIET, linewidth=0.8, zorder=1)
    ax.set_xlim(0, max(pushes[-1], *numbers.pushes()))
    return figure


def along_falls(marked: by_hand.SAC, unmarked: by_hand.SAC) -> Figure:
    """What two agents' critics expect along a fall, see `worlds.along_falls`, and the most that Q can be."""
    lost, yours, most = worlds.along_falls(unmarked), worlds.along_falls(marked), worlds.most_possible(unmarked)
    title = "Without marks, Q is above all that is possible" if lost.min() > most else "What critics expect in a fall"
    named = {"terminated is lost": lost, "your agent": yours}
    marks, looks = {"nothing above this is possible": most}, [STRANGERS[1], OTHER]
    pushes, x_label = np.arange(-worlds.BEFORE, 1), "pushes from the fall (0: the pole has fallen)"
    return charts.lines(pushes, named, title, x_label, "Q, mean of 40 falls", marks=marks, looks=looks)
