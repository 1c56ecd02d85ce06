"""Two drives of MountainCar, one of DoorKey, and what ships of the study on other problems (research/elsewhere.py)."""

from collections.abc import Mapping, Sequence

import numpy as np
from matplotlib.figure import Figure
from matplotlib.patches import Arc, Rectangle

from bootcourse.colours import ALARM, Style
from bootcourse.course import charts
from bootcourse.course.dots import dots
from bootcourse.course.lessons.your_own_problem import loops
from bootcourse.course.lessons.your_own_problem.cells import BONUSES, THREE, TWO, cells
from bootcourse.learn.agent import Agent
from bootcourse.methods import style
from bootcourse.plots.figure import INK, TEXT, axes_at, finish, new_figure, plain_axes
from bootcourse.research.problems import PROBLEMS

LOOKS = {"cloning": "bc", "soft": "soft"}
NAMES = {"cloning": "clone", "soft": "soft constraint"}


def climbs() -> Figure:
    """Two drives of MountainCar: always pushed to the right, and by the course's teacher."""
    title = "A rule of one line swings the car up to the flag"
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


def returns() -> Figure:
    """The mean return of each agent with a flawed teacher, a dot: a column for each problem, a row for each method."""
    title = "Clones outdo these random teachers, not the systematic ones"
    figure, alt = new_figure(3.5), []
    for row, teacher in enumerate(("random", "systematic")):
        for column, problem in enumerate(THREE):
            ax = axes_at(figure, 1.15 + 1.95 * column, 0.95 + 1.35 * row, 1.75, 0.75)
            plain_axes(ax, PROBLEMS[problem].name, grid="x")
            lines = {"good teacher": style("rule").colour, "this teacher": ALARM, "plain SAC": style("sac").colour}
            good, this = (cells().mean(problem, kind, "the teacher") for kind in ("good", teacher))
            alone = cells().mean(problem, teacher, "SAC")
            for value, colour, line in zip((good, this, alone), lines.values(), ("-", "--", ":"), strict=True):
                ax.axvline(value, color=colour, linestyle=line, linewidth=1.6, zorder=2)
            means = []
            for place, method in enumerate(TWO):
                scores = cells().scores(problem, teacher, method)
                dots(ax, scores, place, style(LOOKS[method]).colour, size=11)
                means.append(f"{NAMES[method]} {scores.mean():.0f}")
            ax.set_yticks(range(len(TWO)), NAMES.values() if column == 0 else [""] * len(TWO))
            ax.set_ylim(len(TWO) - 0.5, -0.5)
            what = f"good teacher {good:.0f}, this teacher {this:.0f}, plain SAC {alone:.0f}"
            alt.append(f"{PROBLEMS[problem].name}, {teacher}: {what}, {', '.join(means)}.")
        above = 1 - (0.75 + 1.35 * row) / 3.5
        figure.text(0.012, above, f"a {teacher}\nteacher", va="top", fontsize=TEXT, fontweight="bold", color=INK)
    x = 1.15
    for (words, colour), line in zip(lines.items(), ("-", "--", ":"), strict=True):
        key = axes_at(figure, x, 0.56, 1.3, 0.12)
        key.plot([0, 0.2], [0.5, 0.5], color=colour, linestyle=line, linewidth=1.6)
        key.text(0.25, 0.45, words, va="center", fontsize=TEXT, color=INK)
        key.set(xlim=(0, 1), ylim=(0, 1))
        key.set_axis_off()
        x += 1.3
    figure.text(0.58, 0.02, "return; a dot for each of ten agents", ha="center", fontsize=TEXT, color=INK)
    return finish(figure, title, " ".join(alt))


def bonuses() -> Figure:
    """How often agents with both aids reach the goal of DoorKey, over the bonus, for each teacher; drawn actions."""
    title = "With a flawed teacher, the larger the bonus the rarer the goal"
    at, named = np.arange(len(BONUSES)), {}
    for teacher in ("good", "random", "systematic"):
        scores = [cells().mean("doorkey", teacher, method, "drawn_success") for method in BONUSES.values()]
        named[f"{teacher} teacher"] = 100 * np.array(scores)
    looks = [style("rule"), style("bootstrapped"), Style(ALARM, "--")]
    marks = {"plain SAC": 100 * cells().mean("doorkey", "none", "SAC", "drawn_success")}
    over = "bonus c for each decision of a demonstration"
    of = "drives that reach the goal, %: agents with both aids, which draw their actions"
    figure = charts.lines(at, named, title, over, of, marks=marks, limits=(0, 103), looks=looks)
    figure.axes[0].set_xticks(at, [name.removeprefix("c = ") for name in BONUSES])
    return figure


def edges(tested: Mapping[int, tuple[Sequence[Agent], np.ndarray]]) -> Figure:
    """Where agents on CartPole change from left to right, by angle and speed of the pole, after so many decisions each.

    tested: by decisions in training, the agents and what each earns. The cart rests in the middle.
    """
    title = "On their way to the teacher's rule they pass a better one"
    figure, alt = new_figure(3.4), []
    angle, speed = np.linspace(-0.2, 0.2, 81), np.linspace(-1.5, 1.5, 81)
    at = np.zeros((81, 81, 4), dtype=np.float32)
    at[..., 2], at[..., 3] = np.meshgrid(angle, speed)
    rule, soft = style("rule").colour, style("soft").colour
    for column, (decisions, (agents, earned)) in enumerate(tested.items()):
        ax = axes_at(figure, 0.5 + 2.2 * column, 1.05, 1.85, 1.6)
        plain_axes(ax, f"{decisions:,} decisions: return {earned.mean():.0f}")
        slopes = []
        for agent in agents:
            right = np.asarray(agent.probabilities(at.reshape(-1, 4)))[:, 1].reshape(81, 81)
            ax.contour(angle, speed, right, levels=[0.5], colors=[soft], linewidths=1.6)
            low, high = (speed[(right[:, x] >= 0.5).argmax()] for x in (30, 50))
            slopes.append((low - high) / (angle[50] - angle[30]))
        ax.axvline(0, color=rule, linewidth=2.5, zorder=1)
        ax.plot(angle, -angle, color=INK, linewidth=1.2, linestyle="--")
        ax.set_xticks([-0.2, 0, 0.2], ["−0.2", "0", "0.2"])
        falls = f"edges fall by {min(slopes):.1f} to {max(slopes):.1f} rad/s a rad"
        alt.append(f"after {decisions:,} decisions {falls}, mean return {earned.mean():.0f}")
        if column == 0:
            ax.text(-0.19, -1.4, "push left", fontsize=TEXT, color=INK)
            ax.text(0.19, 1.2, "push right", ha="right", fontsize=TEXT, color=INK)
    keys = {"five agents": soft, "the teacher": rule, "dashes: angle + speed = 0": INK}
    for x, (words, colour) in zip((0.072, 0.23, 0.39), keys.items(), strict=True):
        figure.text(x, 0.8, words, fontsize=TEXT, color=colour)
    below = "across: angle of the pole, rad; up: its speed, rad/s; return: mean over the agents"
    figure.text(0.5, 0.06, below, ha="center", fontsize=TEXT, color=INK)
    return finish(figure, title, f"Edges between left and right: {'; '.join(alt)}. The teacher's edge is upright.")
