"""What teachers are worth: each of their students as a dot, and whether they help."""

from collections.abc import Mapping

import numpy as np
from IPython.display import Markdown
from matplotlib.figure import Figure

from bootcourse.course import table
from bootcourse.course.dots import beside, dots, name_rows
from bootcourse.course.lessons.your_teacher import crashes, example_teachers, taught_agents
from bootcourse.methods import style
from bootcourse.plots.figure import QUIET, axes_at, finish, new_figure
from bootcourse.research.results import Results
from bootcourse.road.state import LANE, SPEED, X, Y
from bootcourse.statistics import ESCAPES

HEAD, FOOT = 0.75, 0.55  # inches, above and below the rows of a figure
MARKS = {"helps": "▲", "hurts": "▼"}
PARTS = {  # kind of the experiment `crashes`: the name of its row
    "all": "all",
    "no-labels": "no labels",
    "no-bonus": "no bonus",
    "cut": "no free lane",
}


def exam_of_all() -> Markdown:
    """A table of how the teachers drive themselves."""
    rows = []
    for name in taught_agents.SHOWN:
        driven = example_teachers.examine(taught_agents.TEACHERS[name]).episodes
        shares = (100 * driven.success.mean(), 100 * np.mean(driven.accident > 0))
        rows.append([name, *(f"{share:.0f}" for share in shares), f"{driven.returns.mean():.0f}"])
    below = "A drive that ends ahead of trap 1 got out, even if it ends by a crash."
    return table([f"{len(driven.success)} roads", "gets out, %", "accidents, %", "return"], rows, below)


def of_speeds() -> Markdown:
    """A table of how rules drive that look at no other car: at one speed, and last at a higher one in lane 0."""
    rows = []
    for slow, fast in ((9, 9), (11, 11), (9, 12)):
        driven = example_teachers.examine(example_teachers.two_speeds(slow, fast)).episodes
        shares = (100 * driven.success.mean(), 100 * np.mean(driven.accident > 0))
        words = f"{slow}" if slow == fast else f"{slow}, and {fast} in lane 0"
        rows.append([words, *(f"{share:.0f}" for share in shares), f"{driven.returns.mean():.0f}"])
    return table(["speed (m/s)", "gets out, %", "accidents, %", "return"], rows)


def cars_in_rows(cars: np.ndarray, shown: int = 5) -> Markdown:
    """A table of the first cars of a road, (vehicles, 10), in the four columns that a rule of the lesson reads."""
    names = ["ego", "trap 1", "trap 2", *["traffic"] * len(cars)]
    rows = [
        [name, *(f"{car[column]:.1f}" for column in (X, Y, SPEED)), f"{car[LANE]:.0f}"]
        for name, car in zip(names, cars[:shown], strict=False)
    ]
    return table(["car", "`X` (m)", "`Y` (m)", "`SPEED` (m/s)", "`LANE`"], rows)


def students(groups: Mapping[str, Mapping[str, np.ndarray]], verdicts: Mapping[str, Mapping[str, str]]) -> Figure:
    """Each student's success as a dot, a row for each group; beside it how many escape, return and accidents.

    groups: {teacher, or "alone": what `taught_agents.tested` says of its students, each (agents,)}; verdicts: as
    `taught_agents.verdicts` returns them.
    """
    title = "The racer's students get out more often than those alone, and earn less"
    row = 0.42
    figure = new_figure(HEAD + row * len(groups) + FOOT)
    ax = axes_at(figure, 1.25, HEAD, 2.8, row * len(groups))
    ax.axvline(100 * ESCAPES, color=QUIET, linewidth=1, linestyle=(0, (2, 2)), zorder=1)
    alt_parts = []
    for place, (name, group) in enumerate(groups.items()):
        colour = style("sac" if name == taught_agents.ALONE else "bootstrapped").colour
        success = np.sort(100 * group["success"])
        dots(ax, success, place, colour, success >= 100 * ESCAPES)
        escape, mean = f"{(success >= 100 * ESCAPES).sum()} of {len(success)}", round(group["returns"].mean())
        accidents, found = f"{100 * group['accident'].mean():.0f}", verdicts.get(name, {})
        marks = [MARKS.get(found.get(score), "") for score in ("success", "returns")]
        beside(ax, place, f"{escape} {marks[0]}", f"{mean} {marks[1]}", accidents)
        words = "".join(f", {score}: {word}" for score, word in found.items())
        alt_parts.append(f"{name}: {escape} escape, return {mean}, accidents in {accidents} %{words}")
    beside(ax, -0.75, "escape", "return", "accidents, %", colour=QUIET)
    name_rows(ax, list(groups), f"success of a student (%); filled: {100 * ESCAPES:.0f} % or more, it escapes")
    ax.set_xlim(-2, 102)
    return finish(figure, title, f"A dot for each student. {'; '.join(alt_parts)}.")


def without_a_part(computed: Mapping[str, Results]) -> Figure:
    """Each agent's return as a dot, a row for each kind of the experiment `crashes`.

    computed: {kind: agents}, as it ships.
    """
    title = "These crashing drives teach agents to earn; cut before the free lane, they do not"
    row, alt_parts = 0.42, []
    figure = new_figure(HEAD + row * len(PARTS) + FOOT)
    ax = axes_at(figure, 1.75, HEAD, 2.8, row * len(PARTS))
    for place, (kind, words) in enumerate(PARTS.items()):
        agents = computed[kind]
        fills = agents.scores("success") >= ESCAPES
        dots(ax, agents.scores("returns"), place, style(crashes.KINDS[kind][1]).colour, fills)
        escape, mean = f"{fills.sum()} of {len(agents)}", f"{agents.scores('returns').mean():.0f}"
        accidents = f"{100 * agents.scores('accident').mean():.0f}"
        beside(ax, place, escape, mean, accidents)
        alt_parts.append(f"{words}: {escape} escape, return {mean}, accidents in {accidents} %")
    beside(ax, -0.75, "escape", "return", "accidents, %", colour=QUIET)
    name_rows(ax, list(PARTS.values()), "return of an agent after training; filled: it escapes")
    ax.set_xlim(0, None)
    return finish(figure, title, f"A dot for each agent. {'; '.join(alt_parts)}.")
