"""What teachers are worth: each of their students as a dot, and whether they help."""

from collections.abc import Iterable, Mapping, Sequence

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from bootcourse.episodes.evaluate import drive_episodes, held_out_seeds
from bootcourse.learn.teachers import teacher_policy
from bootcourse.methods import display_name, style
from bootcourse.plots.figure import INK, QUIET, SMALL, TEXT, axes_at, finish, new_figure, plain_axes
from bootcourse.research.experiments.teacher_worth import TAUGHT, Cells
from bootcourse.research.jobs import HELD_OUT
from bootcourse.research.teachers import TEACHERS
from bootcourse.statistics import ESCAPES

HEAD, FOOT = 0.75, 0.55  # inches, above and below the rows of a figure
WORDS = {"rule": "the rule", "random-50": "half random", "mirrored": "mirrored"}


def students(groups: Mapping[str, Mapping[str, np.ndarray]], title: str, apart: int = 0) -> Figure:
    """Each student's success as a dot, a row for each group; beside it how many escape, return and accidents.

    groups: {teacher, or "alone": what `taught_agents.tested` says of its students, each (agents,)}; apart: how many
    of the last rows stand below a thin line.
    """
    row = 0.42
    figure = new_figure(HEAD + row * len(groups) + FOOT)
    ax = axes_at(figure, 1.6, HEAD, 3.1, row * len(groups))
    ax.axvline(100 * ESCAPES, color=QUIET, linewidth=1, linestyle=(0, (2, 2)), zorder=1)
    alt_parts = []
    for place, (name, group) in enumerate(groups.items()):
        colour = style("sac" if name == "alone" else "bootstrapped").colour
        success = np.sort(100 * group["success"])
        _dots(ax, success, place, colour, success >= 100 * ESCAPES)
        escape = f"{(success >= 100 * ESCAPES).sum()} of {len(success)}"
        numbers = (escape, f"{round(group['returns'].mean())}", f"{100 * group['accident'].mean():.0f}")
        _beside(ax, numbers, place)
        alt_parts.append(f"{name}: {escape} escape, return {numbers[1]}, accidents in {numbers[2]} %")
    _beside(ax, ("escape", "return", "accidents, %"), -0.75, QUIET)
    _finish_axes(ax, list(groups), f"success of a student (%); filled: {100 * ESCAPES:.0f} % or more, it escapes")
    ax.set_xlim(-2, 102)
    if apart:
        ax.axhline(len(groups) - apart - 0.5, color=QUIET, linewidth=0.8, zorder=1)
    return finish(figure, title, f"A dot for each student. {'; '.join(alt_parts)}.")


def verdicts(shares: Mapping[str, Sequence[float]], p: Mapping[str, Sequence[float]], title: str) -> Figure:
    """How often a taught agent beats one that learned alone: a row for each teacher, a panel for each of two scores.

    shares: {teacher: (by success, by return)}, of the pairs of agents, 0 to 1; p: the same for Holm's p values.
    """
    row, names, alt_parts = 0.34, list(shares), []
    figure = new_figure(0.95 + row * len(names) + FOOT)
    for column, score in enumerate(("success", "return")):
        ax = axes_at(figure, 1.3 + 2.9 * column, 0.95, 2.6, row * len(names))
        ax.axvline(50, color=QUIET, linewidth=1, linestyle=(0, (2, 2)), zorder=1)
        for place, name in enumerate(names):
            share, found = 100 * shares[name][column], p[name][column] < 0.05
            word = ("hurts", "helps")[int(share > 50)] if found else "not shown"
            colour = style("bootstrapped").colour
            ax.plot([50, share], [place, place], color=colour, linewidth=1.2, zorder=2)
            fill = colour if found else "white"
            ax.plot(share, place, "o", color=colour, mfc=fill, ms=6, zorder=3, clip_on=False)
            alt_parts.append(f"{name}, {score}: {word}, {share:.0f} %, p = {p[name][column]:.1g}")
        plain_axes(ax, "", grid="x")
        ax.set(xlim=(0, 100), ylim=(len(names) - 0.5, -0.5), xticks=(0, 25, 50, 75, 100))
        ax.set_yticks(range(len(names)), names if column == 0 else [])
        ax.tick_params(axis="y", labelcolor=INK, labelsize=TEXT)
        ax.text(50, -1.3, f"by {score}", ha="center", fontsize=TEXT, fontweight="bold", color=INK)
        ax.text(46, -0.75, "◂ hurts", ha="right", fontsize=SMALL, color=QUIET)
        ax.text(54, -0.75, "helps ▸", ha="left", fontsize=SMALL, color=QUIET)
    words = "pairs in which the taught agent is better than the one that learned alone (%); filled: Holm's p below 0.05"
    figure.text(0.5, 0.1 / figure.get_figheight(), words, ha="center", fontsize=SMALL, color=INK)
    return finish(figure, title, f"A dot for each teacher. {'; '.join(alt_parts)}.")


def learners(computed: Cells, title: str) -> Figure:
    """Each agent's return as a dot, a row for each learner below its teacher, whose own return is a green line.

    computed: as `shipped_teachers` returns them; what was not run has no row.
    """
    teachers = [teacher for teacher in TEACHERS if any(teacher == each for each, _ in computed)]
    row, heads, labels, place, alt_parts = 0.24, {}, {}, 0, []
    for teacher in teachers:
        heads[place] = teacher
        for method in TAUGHT:
            if (teacher, method) in computed:
                place += 1
                labels[place] = teacher, method
        place += 1
    figure, own = new_figure(HEAD + row * place + FOOT), own_returns(teachers)
    ax = axes_at(figure, 1.75, HEAD, 4.2, row * place)
    for at, (teacher, method) in labels.items():
        agents = computed[teacher, method]
        fills = agents.scores("success") >= ESCAPES
        _dots(ax, agents.scores("returns"), at, style(method).colour, fills, 0.24)
        escape = f"{agents.escapers(method)} of {len(agents)}"
        _beside(ax, (f"{escape} escape",), at)
        mean = agents.scores("returns").mean()
        alt_parts.append(f"{name_of(teacher)}, {display_name(method)}: {escape} escape, mean return {mean:.0f}")
    for at, teacher in heads.items():
        last = at + sum(each == teacher for each, _ in labels.values())
        ax.plot([own[teacher]] * 2, [at + 0.5, last + 0.5], color=style("rule").colour, linewidth=2.5, zorder=2)
        ax.text(-0.4, at, name_of(teacher), transform=ax.get_yaxis_transform(), fontsize=TEXT,
                fontweight="bold", color=INK, va="center")  # fmt: skip
    words = "return of an agent after training; filled: it escapes; green line: its teacher's own return"
    _finish_axes(ax, [display_name(method) for _, method in labels.values()], words, list(labels))
    ax.set_ylim(place - 0.5, -0.5)
    return finish(figure, title, f"A dot for each agent. {'; '.join(alt_parts)}.")


def _dots(ax: Axes, values: np.ndarray, place: float, colour: str, filled: np.ndarray, spread: float = 0.28) -> None:
    order = np.argsort(values)
    fills = [colour if each else "white" for each in np.asarray(filled)[order]]
    places = place + np.linspace(-spread, spread, len(values)) if len(values) > 1 else [place]
    look = {"edgecolors": colour, "linewidths": 1.1, "zorder": 3, "clip_on": False}
    ax.scatter(np.asarray(values)[order], places, s=18, c=fills, **look)


def _beside(ax: Axes, cells: tuple[str, ...], place: float, colour: str = INK) -> None:
    """Write cells to the right of a row, at fixed places."""
    for column, words in enumerate(cells):
        at = (1.04 + 0.2 * column, place)
        ax.annotate(words, at, xycoords=("axes fraction", "data"), va="center", fontsize=SMALL, color=colour)


def _finish_axes(ax: Axes, names: list[str], words: str, places: list[float] | None = None) -> None:
    plain_axes(ax, "", grid="x")
    ax.set_yticks(range(len(names)) if places is None else places, names)
    ax.tick_params(axis="y", labelcolor=INK, labelsize=TEXT)
    ax.set_ylim(len(names) - 0.5, -0.5)
    ax.set_xlabel(words, fontsize=SMALL, color=INK)


def name_of(teacher: str) -> str:
    """The lesson's name of a teacher, or else the report's."""
    return WORDS.get(teacher, TEACHERS[teacher].words)


def own_returns(teachers: Iterable[str]) -> dict[str, float]:
    """What each teacher earns itself on 200 of the study's held-out roads."""
    roads = held_out_seeds(HELD_OUT, 200)
    drives = {name: drive_episodes(teacher_policy(TEACHERS[name].rule), roads) for name in teachers}
    return {name: drive.returns.mean() for name, drive in drives.items()}
