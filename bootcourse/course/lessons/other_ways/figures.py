"""What each learner takes from a teacher, how two trainings went, and what the learners earn at equal budgets."""

from collections.abc import Mapping, Sequence

import numpy as np
from matplotlib.figure import Figure

from bootcourse.colours import OTHER, Style
from bootcourse.course import charts
from bootcourse.methods import display_name, style
from bootcourse.plots.diagrams import Diagram, label
from bootcourse.plots.figure import (
    INK,
    QUIET,
    SMALL,
    TEXT,
    axes_at,
    finish,
    label_ends,
    new_figure,
    plain_axes,
)
from bootcourse.research import equal_decisions
from bootcourse.research.beyond import at_budget
from bootcourse.research.results import Results
from bootcourse.statistics import Estimate, interval

SHOWN = equal_decisions.BUDGETS[:2]
START, TRAINED, END = 210, 560, 690  # pixels: the training begins and ends, and the trained agent drives
ROW, TOP, THICK = 52, 62, 18
TAKES = {  # learner: (what it takes, from, until, whether it fades)
    "ppo_cloned": ("a first policy", START - 34, START, False),
    "bootstrapped": ("a KL, and demonstrations with a bonus", START, TRAINED, True),
    "jsrl": ("the first seconds of each episode", START, TRAINED - 60, True),
    "rlpd": ("half of each batch", START, TRAINED, False),
    "ibrl": ("demonstrations at first, and a second action", START, END, False),
}


def what_is_taken() -> Diagram:
    """A row for each learner: a bar while it uses the teacher, which gets thinner where that fades."""
    height = TOP + ROW * len(TAKES) + 4
    parts = [label(8, 18, "A teacher can help before, during or after training", "start", bold=True)]
    middles = {"before": START - 40, "training": (START + TRAINED) / 2, "after": (TRAINED + END) / 2}
    parts += [label(x, 40, words) for words, x in middles.items()]
    for x in (START, TRAINED):
        dash = 'stroke="currentColor" stroke-dasharray="4 4" opacity="0.6"'
        parts.append(f'<line x1="{x}" y1="46" x2="{x}" y2="{height}" {dash}/>')
    alt_parts = ["A teacher can help before, during or after training."]
    for i, (method, (words, first, last, fades)) in enumerate(TAKES.items()):
        learner, top = display_name(method), TOP + ROW * i + 18
        end = top + (2 if fades else THICK)
        corners = f"{first},{top} {last},{top} {last},{end} {first},{top + THICK}"
        parts += [f'<polygon points="{corners}" fill="{style(method).colour}"/>']
        parts += [label(START - 44, top + 14, learner, "end", bold=True)]
        place = (START - 8, top - 6, words, "end") if last == START else (START + 12, top - 6, words, "start")
        parts += [label(*place)]
        until = {START: "before the training", END: "in training and afterwards"}.get(last, "in training")
        alt_parts.append(f"{learner} takes {words}, {until}{', which fades' * fades}.")
    return Diagram(END + 10, height, parts, " ".join(alt_parts))


def believed(updates: Sequence[int], values: Mapping[str, np.ndarray], bound: float) -> Figure:
    """The mean Q of the rule's actions over the updates: {which critics: (points,)}; bound: no drive is worth more."""
    over = [words for words, each in values.items() if each[-1] > bound]
    passes = f"passes what any drive can earn if the layers are {' or '.join(over)}"
    title = f"Q {passes if over else 'stays below what a drive can earn'}"
    looks = [Style(style("rlpd").colour, width=2.0), OTHER]
    marks = {f"no drive is worth more than {bound:.0f}": bound}
    return charts.lines(updates, values, title, "update", "mean Q of the rule's actions", looks=looks, marks=marks)


def handing_over(episodes: Sequence[float], h: np.ndarray, mean: np.ndarray, needed: np.ndarray) -> Figure:
    """How a teacher hands over: h above, and below it the mean return with the one that it has to reach.

    All are of the same episodes; `needed` is NaN while there is no best mean yet.
    """
    figure, look = new_figure(4.0), style("jsrl")
    title = f"In {episodes[-1]} episodes h falls {len(set(h)) - 1} times, from {h.max():g} s to {h.min():g} s"
    upper, lower = (axes_at(figure, 0.6, 0.72 + 1.55 * row, 5.0, 1.15) for row in range(2))
    upper.plot(episodes, h, color=look.colour, linewidth=2, drawstyle="steps-post")
    plain_axes(upper, "h: the rule drives first (s)")
    upper.set_ylim(0, 1.08 * np.max(h))
    upper.tick_params(labelbottom=False)
    lower.plot(episodes, mean, color=look.colour, linewidth=2)
    lower.plot(episodes, needed, color=QUIET, linewidth=1.2, linestyle=(0, (4, 2)), drawstyle="steps-post")
    plain_axes(lower, "mean return of the last episodes")
    steps = np.flatnonzero(np.diff(h) < 0) + 1
    for ax in (upper, lower):
        for step in steps:
            ax.axvline(episodes[step], color=QUIET, linewidth=0.6, linestyle=(0, (1, 2)), zorder=1)
        ax.set_xlim(min(episodes), max(episodes))
    lower.set_xlabel("training episode", fontsize=TEXT, color=INK)
    label_ends(lower, [(mean[-1], "the mean", look.colour), (needed[-1], "what it has to reach", QUIET)])
    each = ", ".join(f"{h[step]:g} s at {episodes[step]}" for step in steps)
    ends = f"at the end the mean return is {mean[-1]:.0f} and has to reach {needed[-1]:.0f}"
    return finish(figure, title, f"Against the training episode. h: {h[0]:g} s at first, {each}; {ends}.")


def at_equal_budgets(computed: Mapping[str, Results], rule: float, title: str) -> Figure:
    """Returns with their 95 % intervals: a row for each method, a panel for each budget, and one for equal seconds.

    computed: see `equal_decisions.by_method`; rule: what the rule earns, the green line.
    """
    panels = {f"{budget:,} decisions": _after(computed, budget) for budget in SHOWN}
    timed = {method: results for method, results in computed.items() if method not in equal_decisions.UNTIMED}
    seconds = {method: after_seconds(results) for method, results in timed.items()}
    panels[f"{equal_decisions.SECONDS} s of a core\n(in training)"] = seconds
    names, alt_parts, height = [display_name(method) for method in computed], [], 0.35 * len(computed)
    figure = new_figure(1.6 + height)
    for place, (words, estimates) in enumerate(panels.items()):
        ax = axes_at(figure, 1.4 + 1.9 * place, 1.05, 1.7, height)
        plain_axes(ax, words, grid="x")
        ax.axvline(rule, color=style("rule").colour, linewidth=2, zorder=1.5)
        for row, method in enumerate(computed):
            if method in estimates:
                value, low, high = estimates[method]
                colour = style(method).colour
                ax.plot([low, high], [row, row], color=colour, linewidth=1.8, zorder=2)
                ax.plot(value, row, style(method).marker or "o", color=colour, ms=5.5, zorder=3)
            else:
                ax.text(95, row, "not timed", color=QUIET, fontsize=SMALL, ha="center", va="center")
        ax.set(xlim=(0, 140), ylim=(len(names) - 0.5, -0.5), xticks=(0, 50, 100), yticks=range(len(names)))
        ax.set_yticklabels(names if place == 0 else [], fontsize=TEXT, color=INK)
        numbers = (f"{display_name(method)} {_words(one)}" for method, one in estimates.items())
        alt_parts.append(f"{words}: {'; '.join(numbers)}".replace("\n", " "))
    first = next(iter(panels.values()))
    lowest = list(computed).index(min(first, key=lambda method: first[method].value))  # there is room beside its mark
    figure.axes[0].text(rule + 4, lowest, "the rule", color=style("rule").colour, fontsize=SMALL, va="center")
    words = "return: interquartile mean of the agents, and its 95 % interval"
    figure.text(0.6, 0.04, words, fontsize=TEXT, color=INK, ha="center")
    numbers = f"{'. '.join(alt_parts)}. The rule: {rule:.0f}."
    return finish(figure, title, f"Interquartile means of returns and their 95 % intervals. {numbers}")


def _after(computed: Mapping[str, Results], budget: int) -> dict[str, Estimate]:
    """{method: the return of its tested agents} of those that made so many decisions."""
    returns = {method: equal_decisions.at(results, "returns", budget) for method, results in computed.items()}
    return {method: interval(each) for method, each in returns.items() if each.size}


def after_seconds(results: Results) -> Estimate:
    """The return in training after `equal_decisions.SECONDS` of a core."""
    each = results.measured[f"seconds_{equal_decisions.BUDGETS[0]}"] / equal_decisions.BUDGETS[0]  # for a decision
    return interval(at_budget(results.curves, equal_decisions.SECONDS / each))


def _words(one: Estimate) -> str:
    return f"{one.value:.0f} [{one.low:.0f}, {one.high:.0f}]"
