"""Two drives of MountainCar, and one of DoorKey."""

from collections.abc import Sequence

import numpy as np
from matplotlib.figure import Figure
from matplotlib.patches import Arc, Rectangle

from bootcourse.colours import ALARM
from bootcourse.course import charts
from bootcourse.course.lessons.your_own_problem import loops
from bootcourse.methods import style
from bootcourse.plots.figure import INK, TEXT, axes_at, finish, new_figure


def climbs(title: str) -> Figure:
    """Two drives of MountainCar: always pushed to the right, and by the course's teacher."""
    drives = loops.first_drives()
    longest = max(map(len, drives.values()))
    shown = {name: np.r_[x, np.full(longest - len(x), np.nan)] for name, x in drives.items()}
    return charts.lines(np.arange(longest), shown, title, "decision", "position", marks={"flag": 0.5})


def room(states: Sequence[tuple[int, ...]], title: str) -> Figure:
    """DoorKey from above, with the way of a drive that ends in a state which it does not leave.

    states: as `loops.rooms` returns them.
    """
    figure, colour = new_figure(3.4), style("idle").colour
    ax = axes_at(figure, 1.6, 0.6, 4.5, 2.7)
    x, y, _, key, door, _ = states[0]
    for column in range(5):
        for row in range(5):
            inside = 1 <= row <= 3 and column in (1, 3)
            if not inside and (column, row) != (2, door):
                ax.add_patch(Rectangle((column - 0.5, row - 0.5), 1, 1, color="#DFE3E8"))
    ax.add_patch(Rectangle((1.5, door - 0.5), 1, 1, fill=False, edgecolor=INK, linewidth=2))
    way, stays = np.array([state[:2] for state in states]), states.count(states[-1])
    ax.plot(*way.T, color=colour, linewidth=4, alpha=0.5)
    ax.scatter(*way[0], color=colour, s=40, zorder=3)
    end_x, end_y = way[-1]
    ax.add_patch(Arc((end_x, end_y), 0.62, 0.62, theta1=-60, theta2=240, color=ALARM, linewidth=2.2, zorder=4))
    ax.plot(end_x + 0.155, end_y - 0.268, marker=(3, 0, 75), color=ALARM, markersize=8, zorder=4)
    words = f"the loop: {stays} decisions\nthat change nothing"
    ax.text(4.7, end_y, words, ha="left", va="center", fontsize=TEXT, color=ALARM)
    for at, words in (((0, y), "start"), ((1, key - 0.3), "key"), ((2, door - 1), "door"), ((3, 3), "goal")):
        ax.text(*at, words, ha="center", va="center", fontsize=TEXT, color=INK)
    ax.set(xlim=(-0.5, 7.8), ylim=(4.5, -0.5), aspect="equal")
    ax.set_axis_off()
    cells = len(set(map(tuple, way.tolist())))
    alt = f"Two columns with a door between them. The drive visits {cells} cells in {len(states)} decisions"
    return finish(figure, title, f"{alt}; the last {stays} change nothing.")
