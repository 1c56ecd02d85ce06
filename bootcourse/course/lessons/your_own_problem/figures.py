"""How five agents of each method did, what each method closes of the gap on some problems, and a drive of DoorKey."""

from collections.abc import Mapping, Sequence

import numpy as np
from matplotlib.figure import Figure
from matplotlib.patches import Arc, Rectangle

from bootcourse.colours import ALARM, Style
from bootcourse.methods import style
from bootcourse.plots.figure import INK, QUIET, SMALL, TEXT, axes_at, finish, new_figure, plain_axes
from bootcourse.research.elsewhere_claims import TEACHER, Cells
from bootcourse.research.problems import PROBLEMS

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


def decisions_of(cells: Cells, problem: str, teacher: str, method: str) -> np.ndarray:
    """How many decisions each agent made in training, (agents,), where each pays 1 or −1: MountainCar and CartPole."""
    return np.abs(np.nansum(cells.get(problem, teacher, method).curves["return"], axis=1, dtype=float))


def gap(cells: Cells, problems: Sequence[str], title: str) -> Figure:
    """For each problem and teacher, what four methods close of the gap in return from plain SAC to the problem's best.

    A green line: the teacher itself. What earns less than plain SAC stands at the left edge.
    """
    rows = [row for row in cells.rows() if row[0] in problems]
    rows.sort(key=lambda row: problems.index(row[0]))
    figure = new_figure(HEAD + ROW * len(rows) + 0.12 * len(problems) + FOOT)
    ax = axes_at(figure, 2.15, HEAD, 4.55, ROW * len(rows) + 0.12 * len(problems))
    places, alt_parts = [], []
    for row, (problem, teacher) in enumerate(rows):
        place = row + 0.45 * problems.index(problem)
        places.append(place)
        if not row or rows[row - 1][0] != problem:
            ax.axhline(place - 0.72, color=QUIET, linewidth=0.5)
            ax.text(-0.46, place, PROBLEMS[problem].name, transform=ax.get_yaxis_transform(), fontsize=TEXT,
                    fontweight="bold", color=INK, va="center")  # fmt: skip
        shares = {name: 100 * cells.share(problem, teacher, name) for name in NAMES}
        own = 100 * cells.share(problem, teacher, TEACHER)
        ax.plot([np.clip(own, -4, 100)] * 2, [place - 0.42, place + 0.42], color=style("rule").colour, linewidth=3,
                solid_capstyle="butt", zorder=2)  # fmt: skip
        for shift, (name, share) in zip((-0.27, -0.09, 0.09, 0.27), shares.items(), strict=True):
            at = np.clip(share, -4, 100)
            ax.scatter(at, place + shift, s=20, color=look(name).colour, marker=MARKS[name], zorder=3, clip_on=False)
        if (full := sum(share > 99.5 for share in shares.values())) > 1:
            ax.text(97, place, f"{full} at 100 %", fontsize=SMALL, color=QUIET, ha="right", va="center")
        words = ", ".join(f"{NAMES[name]} {share:.0f} %" for name, share in shares.items() if np.isfinite(share))
        alt_parts.append(f"{PROBLEMS[problem].name}, {teacher} teacher ({own:.0f} %): {words}")
    plain_axes(ax, "", grid="x")
    ax.set_yticks(places, [teacher for _, teacher in rows])
    ax.tick_params(axis="y", labelcolor=INK, labelsize=TEXT)
    ax.set(xlim=(-6, 103), ylim=(places[-1] + 0.7, -0.8))
    ax.set_xticks([0, 25, 50, 75, 100], ["plain SAC", "25", "50", "75", "the best"])
    ax.set_xlabel("share of the gap in return that is closed (%); green line: the teacher", fontsize=TEXT, color=INK)
    for x, (name, words) in zip((0.31, 0.43, 0.63, 0.81), NAMES.items(), strict=True):
        y = 1 - 0.7 / figure.get_figheight()
        ax.scatter([x - 0.017], [y], s=34, color=look(name).colour, marker=MARKS[name], clip_on=False,
                   transform=figure.transFigure)  # fmt: skip
        figure.text(x, y, words, fontsize=SMALL, color=INK, va="center")
    return finish(figure, title, f"{'; '.join(alt_parts)}.")


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
