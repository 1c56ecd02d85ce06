"""What each learner takes from a teacher, how two trainings went, and what the learners earn at equal budgets."""

from collections.abc import Mapping, Sequence

import numpy as np
from matplotlib.figure import Figure
from matplotlib.ticker import NullLocator

from bootcourse.methods import display_name, style
from bootcourse.plots.diagrams import Diagram, label
from bootcourse.plots.figure import (
    INK,
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

START, TRAINED, END = 210, 560, 690  # pixels: the training begins and ends, and the trained agent drives
ROW, TOP, THICK = 52, 62, 18
LINES = {"--": ", dashed", "-.": ", dash-dot"}
LEAST = 100  # the return at which the axis of the comparison begins
TAKES = {  # learner: (what it takes, from, until, whether it fades)
    "ppo_cloned": ("a first policy", START - 34, START, False),
    "bootstrapped": ("a KL, and demonstrations with a bonus", START, TRAINED - 110, True),
    "jsrl": ("the first seconds of each episode", START, TRAINED - 60, True),
    "rlpd": ("half of each batch", START, TRAINED, False),
    "ibrl": ("a second action to choose from", START, END, False),
}


def what_is_taken() -> Diagram:
    """A row for each learner: a bar while it uses the teacher, which gets thinner where that fades."""
    height = TOP + ROW * len(TAKES) + 4
    parts = [label(8, 18, "A teacher can help before, during or after training", "start", bold=True)]
    parts += [label((START + TRAINED) / 2, 40, "training"), label((TRAINED + END) / 2, 40, "driving")]
    for x in (START, TRAINED):
        dash = 'stroke="currentColor" stroke-dasharray="4 4" opacity="0.6"'
        parts.append(f'<line x1="{x}" y1="46" x2="{x}" y2="{height}" {dash}/>')
    alt_parts = ["A teacher can help before, during or after training."]
    for i, (method, (words, first, last, fades)) in enumerate(TAKES.items()):
        learner, top = display_name(method), TOP + ROW * i + 18
        end = top + (2 if fades else THICK)
        corners = f"{first},{top} {last},{top} {last},{end} {first},{top + THICK}"
        parts += [f'<polygon points="{corners}" fill="{style(method).colour}"/>']
        parts += [label(START - 44, top + 14, learner, "end", bold=True), label(START + 12, top - 6, words, "start")]
        until = {START: "before the training", END: "in training and afterwards"}.get(last, "in training")
        alt_parts.append(f"{learner} takes {words}, {until}{', which fades' * fades}.")
    return Diagram(END + 10, height, parts, " ".join(alt_parts))


def one_above_the_other(
    x: Sequence[float], named: Mapping[str, np.ndarray], title: str, x_label: str, method: str
) -> Figure:
    """A panel for each quantity over the same x, in the colour of a method: {quantity with its unit: values}."""
    figure = new_figure(4.0)
    for row, (words, values) in enumerate(named.items()):
        ax = axes_at(figure, 0.6, 0.72 + 1.55 * row, 6.2, 1.15)
        ax.plot(x, values, color=style(method).colour, linewidth=2)
        plain_axes(ax, words)
        ax.set(xlim=(min(x), max(x)), ylim=(0, 1.08 * np.max(values)))
        if row + 1 < len(named):
            ax.tick_params(labelbottom=False)
    ax.set_xlabel(x_label, fontsize=TEXT, color=INK)
    alt = (f"{words}: {values[0]:.3g} at {x[0]}, {values[-1]:.3g} at {x[-1]}" for words, values in named.items())
    return finish(figure, title, f"Against the {x_label}. {'; '.join(alt)}.")


def at_equal_budgets(computed: Mapping[str, Results], rule: float, title: str) -> Figure:
    """Returns with their 95 % intervals: left against decisions, right after the same seconds of a core.

    The left panel begins at `LEAST`, and a line below it says who earns less. computed: see
    `equal_decisions.by_method`; rule: what the rule earns, the green line.
    """
    figure, ends, alt_parts, below = new_figure(4.9), [], [], [f"the rule, {rule:.0f}"]
    left, right = axes_at(figure, 0.45, 1.0, 2.9, 2.9), axes_at(figure, 5.0, 1.0, 1.85, 2.9)
    for place, (method, results) in enumerate(computed.items()):
        look, shift = style(method), 1.03 ** (place - 2)
        scores = {b: equal_decisions.at(results, "returns", b) for b in equal_decisions.BUDGETS}
        tested = {budget: interval(each) for budget, each in scores.items() if each.size}
        _draw(left, [budget * shift for budget in tested], list(tested.values()), look)
        quick = after_seconds(results)
        _draw(right, [place], [quick], look)
        last = max(tested)
        if tested[last].value > LEAST:
            ends.append((tested[last].value, display_name(method) + LINES.get(look.line, ""), look.colour))
        else:
            below.append(f"{display_name(method)}, {_range([one.value for one in tested.values()])}")
        below += [f"the lower end of {display_name(method)}'s interval at {budget:,}, {one.low:.0f}"
                  for budget, one in tested.items() if one.low < LEAST < one.value]  # fmt: skip
        numbers = (f"{b:,} decisions {_words(one)}" for b, one in tested.items())
        alt_parts.append(f"{display_name(method)}: {'; '.join(numbers)}; equal seconds {_words(quick)}")
    for ax, words in ((left, "return after training"), (right, f"after {equal_decisions.SECONDS} s of a core")):
        plain_axes(ax, words)
    left.set_ylim(LEAST, 140)
    right.axhline(rule, color=style("rule").colour, linewidth=2, zorder=1.5)
    right.text(len(computed) - 0.35, rule + 3, "the rule", color=style("rule").colour, fontsize=SMALL, ha="right")
    right.set_ylim(0, 145)
    left.set_xscale("log")
    left.set_xlim(80_000, 1_000_000)
    left.xaxis.set_minor_locator(NullLocator())
    left.set_xticks(equal_decisions.BUDGETS, [f"{budget:,}" for budget in equal_decisions.BUDGETS])
    left.set_xlabel("decisions of an agent (logarithmic)", fontsize=TEXT, color=INK)
    names = [display_name(method) for method in computed]
    right.set_xticks(range(len(names)), names, rotation=40, ha="right", rotation_mode="anchor")
    right.tick_params(axis="x", labelcolor=INK, labelsize=SMALL)
    right.set_xlim(-0.7, len(computed) - 0.3)
    label_ends(left, ends, gap=0.03)
    figure.text(0.012, 0.025, f"Below the left axis: {'; '.join(below)}.", fontsize=SMALL, color=INK)
    return finish(figure, title, f"Returns and their 95 % intervals. {'. '.join(alt_parts)}. The rule: {rule:.0f}.")


def _range(values: Sequence[float]) -> str:
    return f"{min(values):.0f} to {max(values):.0f}"


def after_seconds(results: Results) -> Estimate:
    """The return in training after `equal_decisions.SECONDS` of a core."""
    each = results.measured[f"seconds_{equal_decisions.BUDGETS[0]}"] / equal_decisions.BUDGETS[0]  # for a decision
    return interval(at_budget(results.curves, equal_decisions.SECONDS / each))


def _draw(ax, places: Sequence[float], estimates: Sequence[Estimate], look) -> None:
    middle, low, high = np.array(estimates).T
    ax.errorbar(places, middle, [middle - low, high - middle], fmt=look.marker or "o", color=look.colour,
                linestyle=look.line, ms=5, linewidth=1.8, elinewidth=1.2, zorder=3)  # fmt: skip


def _words(one: Estimate) -> str:
    return f"{one.value:.0f} [{one.low:.0f}, {one.high:.0f}]"
