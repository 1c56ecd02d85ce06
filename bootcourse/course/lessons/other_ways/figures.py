"""What each learner takes from a teacher, how two trainings went, and what the agents of all earn in the test."""

from collections.abc import Mapping, Sequence

import numpy as np
from matplotlib.collections import LineCollection
from matplotlib.figure import Figure

from bootcourse.colours import ALARM, OTHER, Style
from bootcourse.course import charts
from bootcourse.course.dots import beside, dots, name_rows
from bootcourse.course.lessons.other_ways.measures import (
    AGENTS,
    DECISIONS,
    SECONDS,
    Episodes,
    Judged,
    in_training,
    worth_at_most,
    worth_of_rule,
)
from bootcourse.learn.settings import settings_for
from bootcourse.methods import display_name, style
from bootcourse.plots.diagrams import Diagram, label
from bootcourse.plots.figure import INK, QUIET, SMALL, TEXT, axes_at, finish, label_ends, new_figure, plain_axes
from bootcourse.research import equal_decisions
from bootcourse.research.beyond import WINDOW
from bootcourse.research.results import Results
from bootcourse.scenario import DEFAULT
from bootcourse.statistics import iqm

START, TRAINED, END = 300, 650, 780  # pixels: the training begins and ends, and the trained agent drives
ROW, TOP, THICK = 52, 62, 18
TAKES = {  # learner: (what it takes, from, until, whether it fades)
    "ppo_cloned": ("a first policy", START - 34, START, False),
    "bootstrapped": ("a pull to the rule, and a bonus for its drives", START, TRAINED, True),
    "jsrl": ("the first seconds of each episode", START, TRAINED - 60, True),
    "rlpd": ("its drives: half of each batch", START, TRAINED, False),
    "ibrl": ("its drives, and its action beside the agent's own", START, END, False),
}
MEASURED = ("returns", "accident")  # of each agent in the test
LONGEST = {SECONDS: 15, DECISIONS: 150_000}  # the ends of the learning curves
MARKED = {SECONDS: equal_decisions.SECONDS, DECISIONS: equal_decisions.BUDGETS[0]}  # where the lesson compares them
POINTS = 60  # of each curve


def hours_before(method: str) -> float:
    """The hours that the rule drives before the training: for demonstrations, or for what a clone learns from."""
    settings = settings_for(method, **equal_decisions.COMMON[method])
    drives = settings.demonstration_episodes if settings.needs_demonstrations else 0
    return drives * DEFAULT.clock.decisions / 3600


def what_is_taken() -> Diagram:
    """A row for each learner: a bar while it uses the teacher, which gets thinner where that fades.

    Hollow: how long the rule drives before.
    """
    height = TOP + ROW * len(TAKES) + 24
    says = "A teacher can help before, during or after training"
    parts = [label(8, 18, says, "start", bold=True)]
    middles = {"before": START - 72, "training": (START + TRAINED) / 2, "after": (TRAINED + END) / 2}
    parts += [label(x, 40, words) for words, x in middles.items()]
    for x in (START, TRAINED):
        dash = 'stroke="currentColor" stroke-dasharray="4 4" opacity="0.6"'
        parts.append(f'<line x1="{x}" y1="46" x2="{x}" y2="{height - 20}" {dash}/>')
    parts += [label(START, height - 4, "a bar that gets thinner: the help fades", "start")]
    alt_parts = ["A teacher can help before, during or after training."]
    for i, (method, (words, first, last, fades)) in enumerate(TAKES.items()):
        learner, top = display_name(method), TOP + ROW * i + 18
        end = top + (2 if fades else THICK)
        corners = f"{first},{top} {last},{top} {last},{end} {first},{top + THICK}"
        parts += [f'<polygon points="{corners}" fill="{style(method).colour}"/>']
        parts += [label(START - 152, top + 14, learner, "end", bold=True)]
        if hours := hours_before(method):
            look = 'fill="none" stroke="currentColor"'
            parts += [f'<rect x="{START - 140}" y="{top}" width="98" height="{THICK}" {look}/>']
            parts += [label(START - 91, top + 14, f"{hours:.0f} h of drives")]
        place = (START - 8, top - 6, words, "end") if last == START else (START + 12, top - 6, words, "start")
        parts += [label(*place)]
        until = {START: "before the training", END: "in training and afterwards"}.get(last, "in training")
        drives = f" It needs {hours:.0f} h of the rule's drives before." * (hours > 0)
        alt_parts.append(f"{learner} takes {words}, {until}{', which fades' * fades}.{drives}")
    return Diagram(END + 10, height, parts, " ".join(alt_parts))


def believed(updates: Sequence[int], values: Mapping[str, np.ndarray], gamma: float) -> Figure:
    """Each critic's mean Q of the rule's actions, {agent: (critics, points)}, beside what these actions are worth.

    The axis ends a little above the ceiling, what no drive can be worth more than.
    """
    ceiling, truth = worth_at_most(gamma), worth_of_rule(gamma)
    guessing = list(AGENTS)[1]  # nothing stops its guesses
    critics = len(values[guessing])
    over = [words for words, each in values.items() if (each[:, -1] > ceiling).all()]
    title = "No agent's critics all pass the ceiling"
    if over:
        whose = {1: "one agent", 2: "two agents"}.get(len(over), f"{len(over)} agents")
        title = f"All {critics} critics of {whose} pass the ceiling"
        title += ", with drives of its own none does" if over == [guessing] else ""
    looks = [Style(style("rlpd").colour), OTHER, style("rule"), Style(INK)]
    marks = {f"the ceiling, {ceiling:.0f}": ceiling, f"the rule's drives are worth {truth:.1f}": truth}
    ends = [f"{words}: {each[:, -1].min():.1f} to {each[:, -1].max():.1f}" for words, each in values.items()]
    top = 1.25 * ceiling
    shown = {words: np.where(each < top, each, np.nan) for words, each in values.items()}
    label = f"mean Q of the rule's actions: {critics} lines for each agent"
    alt = f"At the end, {'; '.join(ends)}. The ceiling is {ceiling:.0f}; the rule's drives are worth {truth:.1f}."
    return charts.lines(updates, shown, title, "update", label, looks=looks, marks=marks, limits=(-4.0, top), alt=alt)


def who_chose(driven: Episodes) -> Figure:
    """Who decides in IBRL's first episodes: a column for each episode, and how long the rule alone drives."""
    figure, episodes, alone = new_figure(3.4), len(driven.decisions), DEFAULT.clock.decisions
    ax, accidents = axes_at(figure, 0.6, 0.72, 5.0, 2.1), driven.accident.sum()
    title = f"Beside the rule, {accidents} of {episodes} episodes end in an accident"
    _columns(ax, driven, style("ibrl"), ", sorted by whose action it was")
    ax.axhline(alone, color=style("rule").colour, linewidth=2)
    ax.set_ylim(0, alone * 1.05)
    ax.set_xlabel("training episode", fontsize=TEXT, color=INK)
    says = [(alone, "the rule alone", style("rule").colour), (30, "the agent's action", style("ibrl").colour)]
    label_ends(ax, [*says, (6, "the rule's action", style("rule").colour), (54, "dot: an accident", ALARM)])
    lasts, first = np.median(driven.decisions), episodes // 4
    share = 100 * driven.by_rule[:first].sum() / driven.decisions[:first].sum()
    words = f"half last {lasts:.0f} s at most. In the first {first} Q takes the rule's action in {share:.0f} %"
    return finish(figure, title, f"Columns: {words} of decisions. The rule alone: {alone:g} s.")


def handing_over(driven: Episodes, h: np.ndarray, judged: Sequence[Judged]) -> Figure:
    """How a teacher hands over: a column for each episode says who drives; below, how each judgement came out."""
    figure, look, rule, episodes = new_figure(4.9), style("jsrl"), style("rule"), len(h)
    shrinks = sum(each.shrinks for each in judged)
    title = f"h shrinks {shrinks} times, with {driven.accident.sum()} accidents in {episodes} episodes"
    ax, below = axes_at(figure, 0.6, 0.72, 5.0, 1.9), axes_at(figure, 0.6, 3.1, 5.0, 1.2)
    _columns(ax, driven, look)
    ends = [(h[-1] / 2, "the rule", rule.colour), (h[-1] + 30, "then the agent", look.colour)]
    label_ends(ax, [*ends, (driven.decisions.max(), "dot: an accident", ALARM)])
    for each in judged:
        fill = look.colour if each.shrinks else "white"
        below.plot(each.episode, each.mean, "o", color=look.colour, markerfacecolor=fill, ms=5, clip_on=False, zorder=3)
        below.plot([each.episode - 1.5, each.episode + 1.5], [each.limit] * 2, color=INK, linewidth=2)
        if not np.isfinite(each.limit):
            words = {"textcoords": "offset points", "ha": "center", "fontsize": SMALL, "color": INK}
            below.annotate("no limit yet", (each.episode, each.mean), (0, -16), **words)
    plain_axes(below, "mean return when h is judged")
    below.set(xlim=(0.5, episodes + 0.5), ylim=(0, 1.25 * max(each.mean for each in judged)))
    below.set_xlabel("training episode", fontsize=TEXT, color=INK)
    top = below.get_ylim()[1]
    says = [("filled: h shrinks", look.colour), ("open: h stays", look.colour), ("bar: the limit", INK)]
    label_ends(below, [(top * place, *each) for place, each in zip((0.9, 0.6, 0.3), says, strict=True)])
    steps = ", ".join(f"{seconds:g} s from {1 + np.argmax(h == seconds)}" for seconds in sorted(set(h), reverse=True))
    words = f"h is judged {len(judged)} times and shrinks {shrinks} times, first without a limit"
    return finish(figure, title, f"Columns. h: {steps}. Below, {words}.")


def _columns(ax, driven: Episodes, own: Style, order: str = "") -> None:
    """A column for each episode: the rule's seconds, the agent's above them, and a dot for an accident."""
    episodes, green = np.arange(1, len(driven.decisions) + 1), style("rule").colour
    ax.bar(episodes, driven.by_rule, width=0.9, color=green)
    ax.bar(episodes, driven.decisions - driven.by_rule, bottom=driven.by_rule, width=0.9, color=own.colour, alpha=0.6)
    ax.scatter(episodes[driven.accident], driven.decisions[driven.accident], s=9, color=ALARM, zorder=3)
    plain_axes(ax, f"seconds of the episode{order}")
    ax.set_xlim(0.5, len(episodes) + 0.5)


def in_the_test(computed: Mapping[str, Results], rule: float) -> Figure:
    """Each agent's return after the first budget as a dot, a row for each method; beside it what its agents have.

    computed: see `equal_decisions.by_method`; rule: what the rule earns, the green line.
    """
    budget = equal_decisions.BUDGETS[0]
    title = f"After {budget:,} decisions each agent with a teacher earns more than the rule, none without"
    row, names, alt_parts, green = 0.42, [], [], style("rule").colour
    figure = new_figure(1.3 + row * len(computed))
    ax = axes_at(figure, 1.75, 0.75, 3.3, row * len(computed))
    ax.axvline(rule, color=green, linewidth=2, zorder=1.5)
    for place, method in enumerate([*TAKES, *(one for one in computed if one not in TAKES)]):
        results = computed[method]
        returns, accident = (equal_decisions.at(results, name, equal_decisions.BUDGETS[0]) for name in MEASURED)
        taught, earned, accidents = method in TAKES, iqm(returns), f"{100 * np.median(accident):.0f}"
        names.append(display_name(method) + ", no teacher" * (not taught))
        dots(ax, returns, place, style(method).colour, np.full(len(returns), taught), earned)
        beside(ax, place, f"{earned:.0f}", accidents)
        least, most = returns.min(), returns.max()
        words = f"{earned:.0f} ({least:.0f} to {most:.0f}), accidents {accidents} % (median)"
        alt_parts.append(f"{names[-1]}: {words}")
    beside(ax, -0.75, "return", "accidents,\n% (median)", colour=QUIET)
    name_rows(ax, names, "return of an agent in the test; filled: it had a teacher; bar: interquartile mean")
    ax.set_xlim(0, 140)
    ax.text(rule + 2, len(names) - 1, "the rule", color=green, fontsize=SMALL, va="center")
    return finish(figure, title, f"A dot for each agent. Return: {'; '.join(alt_parts)}. The rule: {rule:.0f}.")


def learning_curve(results: Results, count: str) -> np.ndarray:
    """The interquartile mean of the agents at `POINTS` places of the axis, NaN where one of them has no value."""
    each = [in_training(results, spent, count) for spent in np.linspace(0, LONGEST[count], POINTS + 1)[1:]]
    return np.array([iqm(of) if np.isfinite(of).all() else np.nan for of in each])


def two_counts(computed: Mapping[str, Results], rule: float) -> Figure:
    """The learning curves of the five over the seconds that they computed, and over their decisions.

    computed: see `equal_decisions.by_method`; rule: what the rule earns, the green line.
    """
    figure, green, ends, order = new_figure(3.9), style("rule").colour, [(rule, "the rule", style("rule").colour)], {}
    for count, left in zip(LONGEST, (0.5, 3.05), strict=True):
        unit, by_decisions = (1000, True) if count == DECISIONS else (1, False)
        ax, mark = axes_at(figure, left, 0.95, 2.3, 2.1), MARKED[count]
        plain_axes(ax, "return in training" if not by_decisions else "")
        ax.set(xlim=(0, LONGEST[count] / unit), ylim=(-20, 140))
        ax.set_xlabel("thousand decisions" if by_decisions else count, fontsize=TEXT, color=INK)
        ax.axhline(rule, color=green, linewidth=1.2)
        ax.axvline(mark / unit, color=QUIET, linewidth=0.9, linestyle="--")
        says = f"{mark / DEFAULT.clock.decision_rate / 3600:.0f} h on a road" if by_decisions else f"{mark} s"
        ax.text(1.03 * mark / unit, -17, says, fontsize=SMALL, color=QUIET)
        ax.set_xticks(np.linspace(0, LONGEST[count] / unit, 4).round())
        ax.tick_params(axis="y", labelleft=not by_decisions)
        x = np.linspace(0, LONGEST[count] / unit, POINTS + 1)[1:]
        for method in reversed([one for one in computed if one in TAKES]):
            look, values = style(method), learning_curve(computed[method], count)
            ax.plot(x, values, color=look.colour, linewidth=look.width, linestyle=look.line)
            if by_decisions:
                ends.append((values[np.isfinite(values)][-1], display_name(method), look.colour))
        for method, at in {} if by_decisions else {"ppo_cloned": (8.5, 131), "rlpd": (10.3, 43)}.items():
            ax.text(*at, display_name(method), fontsize=SMALL, color=style(method).colour)
        earned = {display_name(one): iqm(in_training(computed[one], mark, count)) for one in TAKES}
        order[count] = dict(sorted(earned.items(), key=lambda one: -one[1]))
    places, (low, high), colours = label_ends(ax, ends, gap=0.1), ax.get_ylim(), [colour for *_, colour in ends]
    leads = [[(1.01, (y - low) / (high - low)), (1.085, place)] for (y, *_), place in zip(ends, places, strict=True)]
    ax.add_collection(LineCollection(leads, colors=colours, linewidths=0.9, transform=ax.transAxes, clip_on=False))
    best, least = next(iter(order[SECONDS])), [*order[DECISIONS]][-1]
    title = f"By seconds of computing {best} earns the most of the five, by decisions"
    title += f"{'' if best == least else ' ' + least} the least"
    words = f"interquartile mean of ten agents' last {WINDOW} episodes; without the seconds of PPO's cloning;\n"
    words += f"PPO's line ends at {equal_decisions.BUDGETS[-1]:,} decisions"
    figure.text(0.012, 0.1 / figure.get_figheight(), words, fontsize=SMALL, color=INK)
    each = {count: ", ".join(f"{name} {of:.0f}" for name, of in by.items()) for count, by in order.items()}
    alt = f"Return in training after {MARKED[SECONDS]} s of computing: {each[SECONDS]}."
    return finish(
        figure, title, f"{alt} After {MARKED[DECISIONS]:,} decisions: {each[DECISIONS]}. The rule: {rule:.0f}."
    )
