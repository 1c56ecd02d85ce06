"""How five agents of each method did, and a drive of DoorKey."""

from collections.abc import Mapping, Sequence

import numpy as np
from matplotlib.figure import Figure
from matplotlib.patches import Arc, Rectangle

from bootcourse.colours import ALARM, Style
from bootcourse.methods import style
from bootcourse.plots.figure import INK, TEXT, axes_at, finish, new_figure, plain_axes

NAMES = {
    "cloning": "cloning",
    "soft": "the soft constraint",
    "demonstrations": "demonstrations",
    "both": "both aids",
}
MARKS = {"cloning": "s", "soft": "o", "demonstrations": "^", "both": "D"}
METHODS = {"cloning": "bc", "soft": "soft", "demonstrations": "demos", "both": "bootstrapped"}
ROW, HEAD, FOOT = 0.4, 0.95, 0.55  # inches


def look(name: str) -> Style:
    """The style of one of `NAMES`."""
    return style(METHODS[name])


def agents(success: Mapping[str, np.ndarray], title: str) -> Figure:
    """Each agent's success in its test episodes as a dot, a row for each of `NAMES`: {name: (agents,)}."""
    figure = new_figure(0.75 + 0.45 * len(success) + FOOT)
    ax = axes_at(figure, 1.55, 0.75, 5.1, 0.45 * len(success))
    for row, (name, values) in enumerate(success.items()):
        shown, places = np.sort(100 * values), row + np.linspace(-0.25, 0.25, len(values))
        ax.scatter(shown, places, s=30, color=look(name).colour, marker=MARKS[name], zorder=3, clip_on=False)
    plain_axes(ax, "", grid="x")
    ax.set_yticks(range(len(success)), [NAMES[name] for name in success])
    ax.tick_params(axis="y", labelcolor=INK, labelsize=TEXT)
    ax.set(xlim=(-2, 102), ylim=(len(success) - 0.5, -0.5))
    ax.set_xlabel("success of an agent in its test episodes (%)", fontsize=TEXT, color=INK)
    alt_parts = (
        f"{NAMES[name]}: {', '.join(f'{100 * v:.0f}' for v in np.sort(each))}" for name, each in success.items()
    )
    return finish(figure, title, f"A dot for each agent. {'; '.join(alt_parts)}.")


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
