"""What each learner takes from a teacher, how two trainings went, and what the learners earn at equal budgets."""

from collections.abc import Mapping, Sequence

import numpy as np
from matplotlib.figure import Figure

from bootcourse.colours import ALARM, OTHER, Style
from bootcourse.course import charts
from bootcourse.course.lessons.other_ways.measures import Episodes
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
    says = "A teacher can help before, during or after training (thinner: less and less)"
    parts = [label(8, 18, says, "start", bold=True)]
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


def handing_over(driven: Episodes) -> Figure:
    """How a teacher hands over: a column for each episode says who drives, and below it the mean return."""
    figure, look, rule = new_figure(4.4), style("jsrl"), style("rule")
    h, episodes = driven.h, np.arange(1, len(driven.h) + 1)
    title = f"In {len(h)} episodes h falls from {h[0]:g} s to {h.min():g} s"
    upper, lower = (axes_at(figure, 0.6, top, 5.0, height) for top, height in ((0.72, 1.75), (2.85, 1.0)))
    by_rule = np.minimum(h, driven.decisions)
    upper.bar(episodes, by_rule, width=0.9, color=rule.colour)
    upper.bar(episodes, driven.decisions - by_rule, bottom=by_rule, width=0.9, color=look.colour, alpha=0.6)
    upper.scatter(episodes[driven.accident], driven.decisions[driven.accident], s=9, color=ALARM, zorder=3)
    plain_axes(upper, "seconds of the episode")
    upper.tick_params(labelbottom=False)
    ends = [(h[-1] / 2, "the rule", rule.colour), (h[-1] + 30, "then the agent", look.colour)]
    label_ends(upper, [*ends, (driven.decisions.max(), "dot: an accident", ALARM)])
    lower.plot(episodes, driven.mean, color=look.colour, linewidth=2)
    lower.plot(episodes, driven.needed, color=QUIET, linewidth=1.2, linestyle=(0, (4, 2)), drawstyle="steps-post")
    plain_axes(lower, "mean return of the last episodes")
    lower.set_xlabel("training episode", fontsize=TEXT, color=INK)
    label_ends(lower, [(driven.mean[-1], "the mean", look.colour), (driven.needed[-1], "what it has to reach", QUIET)])
    for ax in (upper, lower):
        ax.set_xlim(0.5, len(h) + 0.5)
    first = ", ".join(f"{seconds:g} s from {1 + np.argmax(h == seconds)}" for seconds in sorted(set(h), reverse=True))
    ends = f"at the end the mean return is {driven.mean[-1]:.0f} and has to reach {driven.needed[-1]:.0f}"
    accidents = f"{driven.accident.sum()} of the {len(h)} end in an accident"
    return finish(figure, title, f"A column for each training episode. h: {first}; {accidents}; {ends}.")


def at_equal_decisions(computed: Mapping[str, Results], rule: float) -> Figure:
    """Returns with their 95 % intervals, a row for each method, a panel for each budget; then the accidents.

    computed: see `equal_decisions.by_method`; rule: what the rule earns, the green line.
    """
    title = "After 100,000 decisions bootstrapped SAC and IBRL earn more than PPO after cloning"
    names, alt_parts, height = [display_name(method) for method in computed], [], 0.35 * len(computed)
    figure = new_figure(1.6 + height)
    crashes = f"accidents in 100 drives,\n{SHOWN[0]:,} decisions"
    panels = [axes_at(figure, 1.4 + 1.9 * place, 1.05, 1.7, height) for place in range(3)]
    for ax, words in zip(panels, [f"return,\n{budget:,} decisions" for budget in SHOWN] + [crashes], strict=True):
        plain_axes(ax, words, grid="x")
        ax.set(xlim=(0, 140), ylim=(len(names) - 0.5, -0.5), xticks=(0, 50, 100), yticks=range(len(names)))
        ax.set_yticklabels(names if ax is panels[0] else [], fontsize=TEXT, color=INK)
    for ax, budget in zip(panels, SHOWN, strict=False):
        ax.axvline(rule, color=style("rule").colour, linewidth=2, zorder=1.5)
        estimates = _returns(computed, budget)
        for row, (method, (value, low, high)) in enumerate(estimates.items()):
            colour = style(method).colour
            ax.plot([low, high], [row, row], color=colour, linewidth=1.8, zorder=2)
            ax.plot(value, row, style(method).marker or "o", color=colour, ms=5.5, zorder=3)
        numbers = (f"{display_name(method)} {_words(one)}" for method, one in estimates.items())
        alt_parts.append(f"{budget:,} decisions: {'; '.join(numbers)}")
    panels[2].set(xlim=(-4, 85), xticks=(0, 40, 80))
    means = []
    for row, (method, results) in enumerate(computed.items()):
        of_agents = 100 * equal_decisions.at(results, "accident", SHOWN[0])
        places = row + np.linspace(-0.2, 0.2, len(of_agents))
        panels[2].scatter(of_agents, places, s=12, color=style(method).colour, alpha=0.6, linewidths=0, zorder=2)
        panels[2].plot([of_agents.mean()] * 2, [row - 0.32, row + 0.32], color=INK, linewidth=1.8, zorder=3)
        means.append(f"{display_name(method)} {of_agents.mean():.0f}, at most {of_agents.max():.0f}")
    words = "return: interquartile mean and its 95 % interval; accidents: each agent, and the mean"
    figure.text(0.5, 0.04, words, fontsize=TEXT, color=INK, ha="center")
    lowest = list(computed).index(min(estimates, key=lambda method: estimates[method].value))  # room beside its mark
    panels[0].text(rule + 4, lowest, "the rule", color=style("rule").colour, fontsize=SMALL, va="center")
    numbers = f"{'. '.join(alt_parts)}. The rule: {rule:.0f}. Accidents in 100 drives, mean: {'; '.join(means)}."
    return finish(figure, title, f"Interquartile means of returns and their 95 % intervals. {numbers}")


def _returns(computed: Mapping[str, Results], budget: int) -> dict[str, Estimate]:
    """{method: the return of its tested agents} of those that made so many decisions."""
    values = {method: equal_decisions.at(results, "returns", budget) for method, results in computed.items()}
    return {method: interval(each) for method, each in values.items() if each.size}


def after_seconds(results: Results) -> Estimate:
    """The return in training after `equal_decisions.SECONDS` of a core."""
    each = results.measured[f"seconds_{equal_decisions.BUDGETS[0]}"] / equal_decisions.BUDGETS[0]  # for a decision
    return interval(at_budget(results.curves, equal_decisions.SECONDS / each))


def _words(one: Estimate) -> str:
    return f"{one.value:.0f} [{one.low:.0f}, {one.high:.0f}]"
