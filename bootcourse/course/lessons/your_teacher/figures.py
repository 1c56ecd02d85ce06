"""What teachers are worth: each of their students as a dot, and whether they help."""

from collections.abc import Mapping, Sequence

import numpy as np
from IPython.display import Markdown
from matplotlib.figure import Figure

from bootcourse.course import table
from bootcourse.course.dots import beside, dots, name_rows
from bootcourse.course.lessons.your_teacher import example_teachers, taught_agents
from bootcourse.episodes.rollout import Rollout
from bootcourse.learn.teachers import course_rule, teacher_of
from bootcourse.methods import display_name, style
from bootcourse.plots.figure import INK, QUIET, TEXT, axes_at, finish, new_figure
from bootcourse.research.experiments.teacher_worth import TAUGHT, Cells
from bootcourse.road.state import LANE, SPEED, X, Y
from bootcourse.statistics import ESCAPES

HEAD, FOOT = 0.75, 0.55  # inches, above and below the rows of a figure
MARKS = {"helps": "▲", "hurts": "▼"}
WORDS = {"random-50": "half random", "rule": "the rule"}


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


def like_the_rule(drives: Sequence[Rollout]) -> float:
    """In which share of the states of a teacher's drives its action is the rule's."""
    cars, actions = (np.concatenate([getattr(drive, name) for drive in drives]) for name in ("cars", "actions"))
    return float(np.mean(teacher_of(course_rule)(cars) == actions))


def records() -> Markdown:
    """A table of two teachers' demonstrations: how many of their labels are the rule's, and how they end."""
    rows = []
    for name, words in WORDS.items():
        drives = taught_agents.demonstrated(name)
        ends = [sum(bool(drive.success) for drive in drives), sum(drive.accident > 0 for drive in drives)]
        rows.append([words, f"{100 * like_the_rule(drives):.0f}", *ends])
    return table([f"{len(drives)} drives", "labels like the rule's, %", "end ahead of trap 1", "end by accident"], rows)


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


def learners(computed: Cells) -> Figure:
    """Each agent's return as a dot, a row for each learner below its teacher, whose own return is a green line.

    computed: as `taught_agents.of_two_learners` returns them.
    """
    title = "All ten bootstrapped students of the half-random teacher escape; with labels alone, one"
    row, heads, labels, place, alt_parts = 0.32, {}, {}, 0, []
    for teacher in WORDS:
        heads[place] = teacher
        for method in (method for method in TAUGHT if (teacher, method) in computed):
            place += 1
            labels[place] = teacher, method
        place += 1
    figure = new_figure(HEAD + row * place + FOOT)
    ax = axes_at(figure, 1.75, HEAD, 3.2, row * place)
    for at, (teacher, method) in labels.items():
        agents = computed[teacher, method]
        fills = agents.scores("success") >= ESCAPES
        dots(ax, agents.scores("returns"), at, style(method).colour, fills, spread=0.42)
        escape = f"{agents.escapers(method)} of {len(agents)}"
        mean, accidents = agents.scores("returns").mean(), f"{100 * agents.scores('accident').mean():.0f}"
        beside(ax, at, escape, accidents)
        alt_parts.append(f"{WORDS[teacher]}, {display_name(method)}: {escape} escape, mean return {mean:.0f}, "
                         f"accidents in {accidents} %")  # fmt: skip
    beside(ax, -0.75, "escape", "accidents, %", colour=QUIET)
    for at, teacher in heads.items():
        last = at + sum(each == teacher for each, _ in labels.values())
        ax.plot([own_return(teacher)] * 2, [at + 0.5, last + 0.5], color=style("rule").colour, linewidth=2.5, zorder=2)
        ax.text(-0.4, at, WORDS[teacher], transform=ax.get_yaxis_transform(), fontsize=TEXT,
                fontweight="bold", color=INK, va="center")  # fmt: skip
    words = "return of an agent after training; filled: it escapes; green line: its teacher's own"
    name_rows(ax, [display_name(method) for _, method in labels.values()], words, list(labels))
    ax.set_ylim(place - 0.5, -0.5)
    return finish(figure, title, f"A dot for each agent. {'; '.join(alt_parts)}.")


def own_return(teacher: str) -> float:
    """What a teacher earns in its demonstrations, the mean."""
    return float(np.mean([drive.rewards.sum() for drive in taught_agents.demonstrated(teacher)]))
