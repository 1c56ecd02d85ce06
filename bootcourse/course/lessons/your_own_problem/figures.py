"""Drives of MountainCar and DoorKey, and what ships of other problems (research/elsewhere.py)."""

from collections.abc import Mapping, Sequence
from functools import cache

import numpy as np
from matplotlib.figure import Figure
from matplotlib.patches import Arc, Rectangle

from bootcourse.colours import ALARM, QUIET, Style
from bootcourse.course import charts
from bootcourse.course.dots import dots
from bootcourse.course.lessons.your_own_problem import loops, unpaid
from bootcourse.course.lessons.your_own_problem.cells import BONUSES, TWO, cells
from bootcourse.course.shipped import shipped_experiment
from bootcourse.learn.agent import Agent
from bootcourse.methods import style
from bootcourse.plots.figure import INK, SMALL, TEXT, axes_at, finish, new_figure, plain_axes
from bootcourse.research.problems import PROBLEMS


def climbs() -> Figure:
    """Two drives of MountainCar: always pushed to the right, and by the course's teacher."""
    title = "A rule of one line swings the car up to the flag"
    drives = loops.first_drives()
    longest = max(map(len, drives.values()))
    shown = {name: np.r_[x, np.full(longest - len(x), np.nan)] for name, x in drives.items()}
    figure = charts.lines(np.arange(longest), shown, title, "decision", "position")
    ax = figure.axes[0]
    ax.axhline(0.5, color=QUIET, linewidth=1, linestyle=(0, (2, 2)), zorder=1)
    ax.text(2, 0.515, "the flag", va="bottom", fontsize=TEXT, color=QUIET)
    return figure


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


CLONES = {  # a row of `clones`: whose clones, and which measure of them (see `elsewhere_claims.Cells.scores`)
    "random\nteacher": ("random", "returns"),
    "the same,\ndrawn": ("random", "drawn_returns"),
    "systematic\nteacher": ("systematic", "returns"),
}


def clones() -> Figure:
    """What clones earn, a dot each, beside their teacher and the good one; a column for each of two problems."""
    title = "By their most probable actions clones far outdo the random teachers, by drawn ones not"
    figure, alt, good_colour = new_figure(3.6), [], style("rule").colour
    step = 5.85 / len(TWO)
    for column, problem in enumerate(TWO):
        ax = axes_at(figure, 1.15 + step * column, 1.05, step - 0.2, 1.8)
        plain_axes(ax, PROBLEMS[problem].name, grid="x")
        good = cells().mean(problem, "good", "the teacher")
        ax.axvline(good, color=good_colour, linewidth=2, zorder=2)
        alt.append(f"{PROBLEMS[problem].name}, good teacher {good:.3g}.")
        for place, (name, (teacher, measure)) in enumerate(CLONES.items()):
            own = cells().mean(problem, teacher, "the teacher")
            scores = cells().scores(problem, teacher, "cloning", measure)
            ax.plot([own] * 2, [place - 0.36, place + 0.36], color=ALARM, linewidth=3, zorder=2)
            dots(ax, scores, place, style("bc").colour, size=13)
            alt.append(f"{name.replace(chr(10), ' ').capitalize()}: clones {scores.mean():.3g}, teacher {own:.3g}.")
        ax.set_xlim(around(problem))
        ax.set_yticks(range(len(CLONES)), CLONES if column == 0 else [""] * len(CLONES))
        ax.tick_params(axis="y", labelcolor=INK, labelsize=TEXT)
        ax.set_ylim(len(CLONES) - 0.5, -0.5)
    keys = {"this teacher": ALARM, "its ten clones": style("bc").colour, "the good teacher": good_colour}
    for x, (words, colour) in zip((0.165, 0.34, 0.53), keys.items(), strict=True):
        figure.text(x, 0.8, words, fontsize=TEXT, color=colour, fontweight="bold")
    figure.text(0.58, 0.1, "return, on a scale of its own for each", ha="center", fontsize=TEXT, color=INK)
    figure.text(0.012, 0.03, "A dot's height only keeps the dots apart.", fontsize=SMALL, color=INK)
    return finish(figure, title, " ".join(alt))


@cache
def around(problem: str) -> tuple[float, float]:
    """The limits of returns on a problem, the same in all figures of its teachers and clones."""
    kinds = [("random", "returns"), ("random", "drawn_returns"), ("systematic", "returns")]
    every = [cells().scores(problem, teacher, "cloning", measure) for teacher, measure in kinds]
    every += [[cells().mean(problem, teacher, "the teacher")] for teacher in ("good", "random", "systematic")]
    low, high = np.min(np.concatenate(every)), np.max(np.concatenate(every))
    return low - 0.06 * (high - low), high + 0.06 * (high - low)


def two_bonuses() -> tuple[list[str], list[list[str]]]:
    """A table, (headings, rows): how often agents reach the goal of DoorKey without a bonus, and with the paper's."""
    ends = {name: BONUSES[name] for name in ("c = 0", "c = 2")}
    rows = []
    for teacher in ("good", "random", "systematic"):
        shares = [100 * cells().mean("doorkey", teacher, method, "drawn_success") for method in ends.values()]
        rows.append([f"{teacher} teacher", *(f"{share:.0f}" for share in shares)])
    alone = 100 * cells().mean("doorkey", "none", "SAC", "drawn_success")
    return ["goals in 100 drives (drawn actions)", *ends], [*rows, ["plain SAC, without a bonus", f"{alone:.0f}", "–"]]


def bonuses(threshold: float) -> Figure:
    """How often agents with both aids reach the goal of DoorKey, over the bonus, for each teacher; drawn actions.

    threshold: the bonus above which a loop is worth more than the goal, which is marked.
    """
    title = "With a flawed teacher, the larger the bonus the rarer the goal"
    at, named = np.arange(len(BONUSES)), {}
    for teacher in ("good", "random", "systematic"):
        scores = [cells().mean("doorkey", teacher, method, "drawn_success") for method in BONUSES.values()]
        named[f"{teacher} teacher"] = 100 * np.array(scores)
    looks = [look._replace(marker="o") for look in (style("rule"), style("bootstrapped"), Style(ALARM, "--"))]
    marks = {"plain SAC": 100 * cells().mean("doorkey", "none", "SAC", "drawn_success")}
    over = "bonus c for each decision of a demonstration (not to scale)"
    of = "drives that reach the goal, %: agents with both aids, which draw their actions"
    ends = (f"{name}: {line[0]:.0f} at c = 0, {line[-1]:.0f} at {list(BONUSES)[-1]}" for name, line in named.items())
    look = {"marks": marks, "limits": (0, 103), "looks": looks, "alt": f"{'; '.join(ends)}."}
    figure = charts.lines(at, named, title, over, of, **look)
    ax, values = figure.axes[0], [float(name.removeprefix("c = ")) for name in BONUSES]
    ax.set_xticks(at, [f"{value:g}" for value in values])
    for line in ax.lines:
        line.set_clip_on(False)  # the dots at the ends are whole
    x = np.interp(threshold, values, at)
    ax.axvline(x, color=INK, linewidth=1.1)
    ax.text(x + 0.06, 4, f"c > {threshold:.3f}: a loop is worth more", fontsize=SMALL, color=INK)
    return figure


def edges(tested: Mapping[int, tuple[Sequence[Agent], np.ndarray]]) -> Figure:
    """Where agents on CartPole change from left to right, by angle and speed of the pole, after so many decisions each.

    tested: by decisions in training, the agents and what each earns. The cart rests in the middle.
    """
    title = "After 3,000 decisions the lines still lean, but the return has fallen"
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
        ax.set_xticks([-0.2, 0, 0.2], ["−0.2", "0", "0.2"])
        ax.set_yticks([-1, 0, 1], ["−1", "0", "1"])
        ax.set_xlabel("angle of the pole (rad)", fontsize=TEXT, color=INK)
        falls = f"{min(slopes):.1f} to {max(slopes):.1f}, mean return {earned.mean():.0f}"
        alt.append(f"after {decisions:,} decisions by {falls}")
        ax.text(-0.19, -1.4, "push left", fontsize=TEXT, color=INK)
        ax.text(0.19, 1.2, "push right", ha="right", fontsize=TEXT, color=INK)
    for x, (words, colour) in zip((0.072, 0.23), {"five agents": soft, "the teacher": rule}.items(), strict=True):
        figure.text(x, 0.8, words, fontsize=TEXT, color=colour)
    figure.text(0.012, 0.5, "speed of the pole (rad/s)", rotation=90, va="center", fontsize=TEXT, color=INK)
    figure.text(
        0.012,
        0.03,
        "the cart rests in the middle; return: mean over the agents",
        fontsize=SMALL,
        color=INK,
    )
    return finish(figure, title, f"Edges fall, in rad/s a rad: {'; '.join(alt)}. The teacher's is upright.")


def hidden() -> Figure:
    """What ten agents without reward earn after each budget, as they are and with the cart hidden; see unpaid.py."""
    title = "With the cart hidden the same agents go on balancing"
    notes, at = shipped_experiment(unpaid.NAME)["without reward"].notes, np.arange(len(unpaid.BUDGETS))
    named = {"the cart hidden": notes["hidden"].mean(0), "as they are": notes["returns"].mean(0)}
    looks = [look._replace(marker="o") for look in (Style(INK, "-"), style("soft"))]
    said = (f"{name}: {', '.join(f'{mean:.0f}' for mean in means)}" for name, means in named.items())
    look = {"limits": (0, 515), "looks": looks, "alt": f"{'; '.join(said)}."}
    figure = charts.lines(at, named, title, "decisions in training", "return, mean of ten agents", **look)
    ax = figure.axes[0]
    ax.set_xticks(at, [f"{budget:,}" for budget in unpaid.BUDGETS])
    for line in ax.lines:
        line.set_clip_on(False)  # the dots at the ends are whole
    return figure
