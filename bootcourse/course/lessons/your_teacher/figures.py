"""What teachers are worth: each of their students as a dot, and whether they help."""

from collections.abc import Callable, Mapping, Sequence

import numpy as np
from IPython.display import Markdown
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.patches import Rectangle

from bootcourse.colours import ALARM
from bootcourse.course import table
from bootcourse.course.dots import beside, dots, name_rows
from bootcourse.course.lessons import number
from bootcourse.course.lessons.the_barrier import easier as barrier
from bootcourse.course.lessons.your_teacher import crashes, example_teachers, free_lane, taught_agents
from bootcourse.learn.teachers import Rule
from bootcourse.methods import style
from bootcourse.plots.figure import INK, QUIET, SMALL, TEXT, axes_at, finish, new_figure, plain_axes
from bootcourse.research.experiments.teacher_worth import Cells
from bootcourse.research.results import Results
from bootcourse.research.teachers import TEACHERS as STUDIED
from bootcourse.road.state import LANE, SPEED, X, Y
from bootcourse.statistics import ESCAPES

HEAD, FOOT = 0.75, 0.55  # inches, above and below the rows of a figure
MARKS = {"helps": "▲", "hurts": "▼"}
SIX = {  # teacher of the experiment `teachers`: the name of its row
    "rule": "the rule",
    "late": "late",
    "random-25": "quarter random",
    "random-50": "half random",
    "timid": "timid",
    "mirrored": "mirrored",
}
PARTS = {  # as the lesson lists them: what they learn from, of a drive's three parts
    "all": ("all", "■■■"),
    "lane": ("without the accident", "■■□"),
    "accident": ("without the free lane", "■□■"),
    "cut": ("without both", "■□□"),
}


def exam_of_all() -> Markdown:
    """A table of how the teachers drive themselves."""
    rules = {name: taught_agents.TEACHERS[name] for name in taught_agents.SHOWN}
    return exams(rules | {"half random": STUDIED["random-50"].rule})


def exams(rules: Mapping[str, Rule]) -> Markdown:
    """A table of how rules drive on the exam's roads, {name: rule}; in place of it what is wrong with one."""
    rows = []
    for name, rule in rules.items():
        exam = example_teachers.examine(rule)
        if exam.episodes is None:
            return Markdown(f"{name}: {exam}")
        driven = exam.episodes
        shares = (100 * driven.success.mean(), 100 * np.mean(driven.accident > 0))
        rows.append([name, *(f"{share:.0f}" for share in shares), f"{driven.returns.mean():.0f}"])
    return table([f"{len(driven.success)} roads", "gets out, %", "accidents, %", "return"], rows)


def cars_in_rows(cars: np.ndarray, shown: int = 3) -> Markdown:
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
    methods = ["sac" if name == taught_agents.ALONE else "bootstrapped" for name in groups]
    return in_rows(title, groups, methods, "success", verdicts=verdicts)


def one_number() -> Figure:
    """The return of each agent alone, of each of the racer's students, and of those of the racer at 15 m/s: dots."""
    named = {"alone": taught_agents.ALONE, "racer, 20 m/s": "racer", "racer, 15 m/s": taught_agents.SLOWER}
    groups = {words: taught_agents.shipped(teacher) for words, teacher in named.items()}
    title = "With 15 m/s in place of 20, each of the racer's students earns more"
    return in_rows(title, groups, ["sac", "bootstrapped", "bootstrapped"], "returns")


def of_six_teachers(computed: Cells) -> Figure:
    """The students' success in the experiment `teachers`; left of it what their teachers' drives show."""
    title = "All students of half random escape, though all its drives crash"
    groups = {words: scores(computed[name, "bootstrapped"]) for name, words in SIX.items()}
    shown = {words: free_lane.shown(name) for name, words in SIX.items()}
    cells = {words: (f"{100 * crash:.3g}", f"{100 * reach:.3g}") for words, (reach, crash) in shown.items()}
    headings = "crash, %", "reach lane 0, %"
    methods = ["bootstrapped"] * len(SIX)
    return in_rows(title, groups, methods, "success", left=2.75, width=2.2, of_drives=(headings, cells))


def all_parts(computed: Mapping[str, Results]) -> Figure:
    """Each agent's success as a dot, by the part of the crashing drives that it learned from, as the lesson lists them.

    computed: {kind of the experiment `crashes`: agents}, as it ships.
    """
    title = "Most students get out if their drives show the free lane, few if not"
    groups = {f"{name}  {marks}": scores(computed[kind]) for kind, (name, marks) in PARTS.items()}
    return in_rows(title, groups, [crashes.KINDS[kind][1] for kind in PARTS], "success", left=2.15, width=2.5)


def two_aids(computed: Mapping[str, Results]) -> Figure:
    """The same for the agents that learn from all, with both aids, and without the one or the other."""
    title = "Fewer escape without the bonus; without labels this is not shown"
    named = {"all": "all", "without the bonus c": "no-bonus", "without the labels": "no-labels"}
    groups = {words: scores(computed[kind]) for words, kind in named.items()}
    return in_rows(title, groups, [crashes.KINDS[kind][1] for kind in named.values()], "success", left=1.55)


def two_keys(easier: Mapping[str, Results], computed: Mapping[str, Results]) -> Figure:
    """How many agents escape, by what they are shown or begin with and by what accidents cost: two squares of counts.

    easier, computed: the experiments `easier` of the lesson on the barrier, and `crashes`, as they ship.
    """
    title = "With both keys most escape, with one alone fewer than half"
    squares = {  # columns: accidents dear, cheap; rows: without the free lane, with it
        f"plain SAC (lesson {number('the_barrier')})": (
            ("a crash costs 10", "a crash costs 1"),
            {
                "start in the trap": ["as it is", barrier.CHEAP],
                "start in the free lane": [barrier.MIDDLE, barrier.BOTH],
            },
            easier,
            "sac",
        ),
        "students of half random": (
            ("no bonus", "bonus c = 2"),
            {"no free lane": [None, "accident"], "the free lane": ["no-bonus", "all"]},
            computed,
            "bootstrapped",
        ),
    }
    figure, alt = new_figure(2.75), []
    for left, (name, (prices, ways, agents, method)) in zip((1.3, 4.75), squares.items(), strict=True):
        ax = axes_at(figure, left, 0.95, 2.1, 1.6)
        for place, (way, kinds) in enumerate(ways.items()):
            for column, kind in enumerate(kinds):
                escape, of = (agents[kind].escapers(method), len(agents[kind])) if kind else (0, 1)
                words = f"{escape} of {of}" if kind else "not trained"
                look = {"facecolor": style(method).colour, "alpha": escape / of, "edgecolor": "none"}
                look |= {} if kind else {"facecolor": QUIET, "alpha": 0.25}
                ax.add_patch(Rectangle((column, place), 1, 1, **look))
                ax.add_patch(Rectangle((column, place), 1, 1, facecolor="none", edgecolor=QUIET, clip_on=False))
                at = {"ha": "center", "va": "center", "fontsize": TEXT + 1 if kind else SMALL}
                ax.text(column + 0.5, place + 0.5, words, color="white" if escape > of / 2 else INK, **at)
                alt.append(f"{name}, {way}, {prices[column]}: {words}")
        ax.set(xlim=(0, 2), ylim=(2, 0), xticks=(0.5, 1.5), yticks=(0.5, 1.5))
        ax.set_xticklabels(prices, fontsize=SMALL, color=INK)
        ax.set_yticklabels([way.replace(" in ", "\nin ") for way in ways])
        ax.tick_params(length=0, labelsize=SMALL, labeltop=True, labelbottom=False)
        ax.set_title(name, fontsize=TEXT, color=INK, pad=22)
        ax.set_frame_on(False)
    return finish(figure, title, f"How many agents escape. {'; '.join(alt)}.")


def three_parts() -> Figure:
    """A drive that crashes after it has reached the free lane: its lane over time; below, what a group gets of it."""
    title = "Three parts of a drive, and what each group learns from"
    lanes = shown_lanes()
    first, end, row = int(np.argmax(lanes == 0)), len(lanes), 0.34
    figure = new_figure(3.5)
    ax = axes_at(figure, 1.6, 0.65, 5.0, 0.75)
    plain_axes(ax, "")
    ax.step(range(end), lanes, where="post", color=INK, linewidth=1.8)
    ax.plot(end - 1, lanes[-1], "x", color=ALARM, ms=9, markeredgewidth=2.2, zorder=3)
    ax.set(xlim=(0, end), ylim=(2.4, -0.4), yticks=(0, 1, 2), yticklabels=("free lane, 0", "1", "2"), xticks=())
    parts = {"before the free lane": (0, first), "from the free lane on": (first, end - 1), "accident": (end - 1, end)}
    below = axes_at(figure, 1.6, 1.62, 5.0, row * len(PARTS))
    colour = style("bootstrapped").colour
    for place, (_, marks) in enumerate(PARTS.values()):
        for mark, (left, right) in zip(marks, parts.values(), strict=True):
            look = {"color": colour} if mark == "■" else {"facecolor": "none", "edgecolor": QUIET, "linewidth": 0.6}
            below.barh(place, right - left - 0.12, left=left + 0.06, height=0.5, **look)
    name_rows(below, [name for name, _ in PARTS.values()], "filled: learned from; one decision a second")
    below.set(xlim=(0, end), xticks=())
    for words, (left, right) in parts.items():
        at, side = (end, "right") if words == "accident" else ((left + right) / 2, "center")
        ax.annotate(words, (at, 1.04), xycoords=("data", "axes fraction"), ha=side, fontsize=SMALL, color=QUIET)
        for panel in (ax, below):
            panel.axvline(right, color=QUIET, linewidth=0.8, linestyle=(0, (2, 2)), zorder=1)
    learned = "; ".join(f"{name}: {marks}" for name, marks in PARTS.values())
    alt = f"A drive of {end} s, in the free lane from {first} s on, with {len(parts)} parts. {learned}."
    return finish(figure, title, alt)


def shown_lanes() -> np.ndarray:
    """The ego's lane in each second of the drive that `three_parts` shows: the first with four seconds in each part."""
    drives = map(crashes.lanes_of, crashes.crashed())
    return next(lanes for lanes in drives if 4 <= (lanes == 0).sum() and 4 <= np.argmax(lanes == 0) and len(lanes) < 20)


def chosen(kept: Callable[[np.ndarray], np.ndarray]) -> Markdown:
    """A table of two agents that learn from the crashing drives' decisions that `kept` marks."""
    tested = crashes.short_training(kept)
    shares = (f"{100 * tested[name].mean():.0f}" for name in ("success", "accident"))
    rows = [[PARTS["lane"][0], *shares, f"{tested['returns'].mean():.0f}"]]
    return table(["two agents learn from", "get out, %", "accidents, %", "return"], rows)


def scores(agents: Results) -> dict[str, np.ndarray]:
    """What a figure's row says of agents, each (agents,)."""
    return {name: agents.scores(name) for name in ("success", "returns", "accident")}


def in_rows(
    title: str,
    groups: Mapping[str, Mapping[str, np.ndarray]],
    methods: Sequence[str],
    drawn: str,
    left: float = 1.25,
    width: float = 2.8,
    verdicts: Mapping[str, Mapping[str, str]] | None = None,
    of_drives: tuple[tuple[str, str], Mapping[str, tuple[str, str]]] | None = None,
) -> Figure:
    """A dot for each agent at its success (%) or return, a row for each group; beside it what the group reached.

    groups: {name: `scores`}; methods: of each group, for its colour; drawn: "success" or "returns"; left, width: in
    inches; of_drives: two headings, {name: cells} about the teacher's drives, left of the dots.
    """
    row, alt_parts, is_success = 0.42, [], drawn == "success"
    head = HEAD + 0.2 * (of_drives is not None)
    figure = new_figure(head + row * len(groups) + FOOT)
    ax = axes_at(figure, left, head, width, row * len(groups))
    if is_success:
        ax.axvline(100 * ESCAPES, color=QUIET, linewidth=1, linestyle=(0, (2, 2)), zorder=1)
    for place, ((name, group), method) in enumerate(zip(groups.items(), methods, strict=True)):
        fills = group["success"] >= ESCAPES
        dots(ax, 100 * group["success"] if is_success else group["returns"], place, style(method).colour, fills)
        escape, mean = f"{fills.sum()} of {len(fills)}", round(group["returns"].mean())
        accidents, found = f"{100 * group['accident'].mean():.0f}", (verdicts or {}).get(name, {})
        marks = [MARKS.get(found.get(score), "") for score in ("success", "returns")]
        cells = (f"{mean} {marks[1]}", accidents)
        about = f"return {mean}, accidents in {accidents} %"
        if of_drives:
            crash, reach = of_drives[1][name]
            about += f"; of its teacher's drives {crash} % crash, {reach} % reach lane 0"
            before(ax, place, crash, reach)
        beside(ax, place, f"{escape} {marks[0]}", *cells)
        words = "".join(f", {score}: {word}" for score, word in found.items() if word in MARKS)
        alt_parts.append(f"{name}: {escape} escape, {about}{words}")
    beside(ax, -0.75, "escape", "return", "accidents, %", colour=QUIET)
    if of_drives:
        before(ax, -0.75, *of_drives[0], colour=QUIET)
        before(ax, -1.25, "", "the teacher's drives")
        beside(ax, -1.25, "the students")
    of_success = f"success of a student (%); filled: {100 * ESCAPES:.0f} % or more, it escapes"
    name_rows(ax, list(groups), of_success if is_success else "return of an agent after training; filled: it escapes")
    if of_drives:
        ax.tick_params(axis="y", pad=126)
    ax.set_xlim((-2, 102) if is_success else (min(0, *(group["returns"].min() - 3 for group in groups.values())), None))
    return finish(figure, title, f"A dot for each agent. {'; '.join(alt_parts)}.")


def before(ax: Axes, place: float, *cells: str, colour: str = INK) -> None:
    """Write two cells between a row's name and its dots."""
    for words, left in zip(cells, (1.148, 0.196), strict=True):  # inches
        at = -left / (ax.get_position().width * ax.get_figure().get_figwidth()), place
        look = {"va": "center", "ha": "right", "fontsize": SMALL, "color": colour}
        ax.annotate(words, at, xycoords=("axes fraction", "data"), **look)
