"""The chain of five states, as a diagram; how values move back in it; which learners leave it; two as they learn."""

from collections.abc import Mapping, Sequence

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.patches import Rectangle

from bootcourse.colours import GRID, PALE
from bootcourse.course import charts
from bootcourse.course.lessons.values import chain
from bootcourse.methods import style
from bootcourse.plots.diagrams import arrow, box, label, line
from bootcourse.plots.figure import (
    INK,
    QUIET,
    SMALL,
    TEXT,
    axes_at,
    finish,
    new_figure,
    one_axes,
    wrapped,
)

WIDE, HIGH = 72, 46  # pixels of a state's box
ON = charts.Style("#56B4E9")  # going on to the free road; what stays in the trap has OTHER's look
OPEN = charts.Style("#E69F00")  # where going on is worth more
CELL = (0.95, 0.31)  # inches of a number's cell
DARK, LIGHT, EMPTY = style("sac").colour, PALE, "white"
SHADES = {  # of a learner's square: how that looks, and how far the learner got
    DARK: ("Dark", "learned to leave"),
    LIGHT: ("Light", "was on the free road, and did not learn to leave"),
    EMPTY: ("Empty", "was not on the free road"),
}


def five_states(middles: Sequence[float], top: float, pay: float) -> tuple[list[str], str]:
    """The states as boxes with these middles and this top, pixels, if the trap pays so much: their parts, and the alt.

    What staying at the two ends pays stands above them, and the way back to the trap below.
    """
    left, low, free = [x - WIDE / 2 for x in middles], top + HIGH + 30, chain.REWARD[4, 0]
    parts = []
    for s, x in enumerate(left):
        lines = {0: ("0", "trap"), 4: ("4", "free road")}.get(s, (str(s),))
        parts.append(box(x, top, WIDE, HIGH, lines, {0: "stored", 4: "world"}.get(s, "learned")))
        if s < 4:
            parts += [arrow(x + WIDE, top + HIGH / 2, left[s + 1], top + HIGH / 2)]
            parts += [label((x + WIDE + left[s + 1]) / 2, top + HIGH / 2 - 8, "action 1")]
        if s in (1, 2, 3):
            parts += [line(middles[s], top + HIGH, middles[s], low)]
            parts += [label(middles[s] + 6, top + HIGH + 20, "action 0", "start")]
    parts.append(label(middles[4], top + HIGH + 20, "no way back"))
    parts += [line(middles[3], low, middles[0], low), arrow(middles[0], low, middles[0], top + HIGH)]
    for x, words in ((left[0], f"action 0: +{pay:.2f}"), (left[4], f"action 0 or 1: +{free:g}")):
        parts += [line(x + 36, top, x + 36, top - 16), line(x + 36, top - 16, x + 70, top - 16)]
        parts += [arrow(x + 70, top - 16, x + 70, top), label(x + WIDE / 2, top - 23, words)]
    alt = (
        f"Five states in a row, from 0, the trap, to 4, the free road. In the trap action 0 stays and pays {pay:.2f}. "
        "Action 1 leads from each of the states 0 to 3 to the next one and pays 0. Action 0 leads from the states 1, 2 "
        f"and 3 back to the trap and pays 0. On the free road both actions stay and pay {free:g}."
    )
    return parts, alt


def sweeps(found: Sequence[np.ndarray]) -> Figure:
    """Q(s, 1) after the first five sweeps and the last one, from each sweep's Q (5, 2), the zeros before included."""
    unpaid, without = chain.REWARD * (np.arange(chain.STATES) < 4)[:, None], [np.zeros((chain.STATES, 2))]
    for _ in found[1:]:
        without.append(unpaid + 0.8 * without[-1].max(axis=1)[chain.NEXT])
    shown = [*range(1, 6), len(found) - 1]
    rows = {f"sweep {k}": (found[k][:, 1], ~np.isclose(found[k], without[k])[:, 1]) for k in shown}
    title = "Each sweep carries the free road's value one state back; the fifth brings it to the trap"
    key = "Blue: holds a part of the free road's reward. White, above 0: only the trap's pay, by turning back."
    return _values(title, rows, 2, key)


def walks(forwards: Sequence[np.ndarray], backwards: np.ndarray) -> Figure:
    """Q(s, 1) after each of a learner's walks out, from its Q (5, 2), and after one walk learned in reverse."""
    named = {f"walk {k}": q for k, q in enumerate(forwards, 1)} | {"walk 1, learned backwards": backwards}
    title = "Learned forwards, each walk carries a value one state back"
    return _values(title, {name: (q[:, 1], q[:, 1] > 0) for name, q in named.items()}, 3, "Blue: above 0.")


def _values(
    title: str,
    rows: Mapping[str, tuple[np.ndarray, np.ndarray]],
    digits: int,
    key: str,
    heads: Sequence[str] = ("trap: Q(0, 1)", "Q(1, 1)", "Q(2, 1)", "Q(3, 1)", "free: Q(4, 1)"),
    what: str = "The value of going on",
    alone: int = -1,
    look: charts.Style = ON,
) -> Figure:
    """A row of cells for each name: a number for each state, and which cells are coloured.

    what: the numbers are, for the alt text; alone: the row that stands apart, the first (0) or the last (-1);
    look: of the coloured cells; with OPEN's the free road's are grey.
    """
    left, top, (wide, high), apart = 2.1, 0.95, CELL, 0.12
    figure, listed = new_figure(top + len(rows) * high + apart + 0.4), []
    ax = axes_at(figure, left, top, 5 * wide, len(rows) * high + apart)
    ax.set(xlim=(0, 5 * wide), ylim=(len(rows) * high + apart, 0))
    ax.axis("off")
    for s, name in enumerate(heads):
        ax.text((s + 0.5) * wide, -0.08, name, fontsize=TEXT, color=INK, ha="center", va="bottom")
    for k, (name, (values, blue)) in enumerate(rows.items()):
        down = k * high + apart * (k > 0 if alone == 0 else k == len(rows) - 1)
        words = [f"{number:.{digits}f}" if number else "0" for number in values]
        ax.text(-0.12, down + high / 2, name, fontsize=TEXT, color=INK, ha="right", va="center")
        for s in range(5):
            colour = GRID if look is OPEN and s == 4 else look.colour if blue[s] else "white"
            cell = {"facecolor": colour, "alpha": 0.55, "edgecolor": QUIET}
            ax.add_patch(Rectangle((s * wide, down), wide, high, linewidth=0.7, clip_on=False, **cell))
            at = {"fontsize": TEXT + 0.5, "color": INK, "ha": "center", "va": "center"}
            ax.text((s + 0.5) * wide, down + high / 2, words[s], **at)
        mark = " (orange)" if look is OPEN else " (blue)"
        said = (f"{word}{mark * bool(is_blue)}" for word, is_blue in zip(words, blue, strict=True))
        listed.append(f"{name}: {', '.join(said)}")
    figure.text(0.012, 0.06, key, fontsize=SMALL, color=QUIET)
    return finish(figure, title, f"{what} in the states 0 to 4. {key} {'; '.join(listed)}.")


def who_leaves(found: Mapping[str, Sequence[np.ndarray]]) -> Figure:
    """A square for each learner, a row for each kind: how far it got, by the Q (5, 2) that it ends with."""
    title = "All thirty learn to leave by acting at random or from a demonstration, none with a longer view alone"
    most = max(map(len, found.values()))
    size, height, top = min(0.19, 4.4 / most), 0.29 * len(found), 0.34 + 0.2 * len(wrapped(title).splitlines())
    figure, listed = new_figure(top + height + 0.2 + 0.19 * len(SHADES)), []
    ax = axes_at(figure, 1.75, top, size * most, height)
    ax.set(xlim=(-0.5, most - 0.5), ylim=(len(found) - 0.5, -0.5))
    ax.axis("off")
    for row, (kind, all_q) in enumerate(found.items()):
        got = [DARK if chain.leaves(q) else LIGHT if chain.has_been_free(q) else EMPTY for q in all_q]
        for column, shade in enumerate(sorted(got, key=[*SHADES].index)):
            _square(ax, column, row, shade, 47 * size)
        dark, light, empty = map(got.count, SHADES)
        ax.text(most - 0.1, row, f"{dark} of {len(got)}", fontsize=TEXT, color=INK, va="center")
        ax.text(-0.9, row, kind, fontsize=TEXT, color=INK, va="center", ha="right")
        listed.append(f"{kind}: {dark} dark, {light} light, {empty} empty")
    key = axes_at(figure, 1.75, top + height + 0.08, 0.19, 0.19 * len(SHADES))
    key.set(xlim=(-0.5, 0.5), ylim=(len(SHADES) - 0.5, -0.5))
    key.axis("off")
    for row, (shade, (_, words)) in enumerate(SHADES.items()):
        _square(key, 0, row, shade, 6.5)
        key.text(0.9, row, words, fontsize=SMALL, color=QUIET, va="center")
    legend = " ".join(f"{look}: {words}." for look, words in SHADES.values())
    return finish(figure, title, f"A square for each learner. {legend} {'; '.join(listed)}.")


def _square(ax: Axes, x: float, y: float, shade: str, size: float) -> None:
    ax.plot(x, y, "s", markersize=size, color=shade, markeredgecolor=QUIET, markeredgewidth=0.7, clip_on=False)


def goes_on_from(q: np.ndarray, state: int) -> int:
    """After which walk, of q (walks + 1, 5, 2), the learner goes on in a state, and no longer turns back."""
    return len(q) - int(np.argmax((q[:, state, 1] <= q[:, state, 0])[::-1]))


def two_learners(both: Sequence[Sequence[np.ndarray]]) -> Figure:
    """The larger Q of each state: of a learner at its end that does not learn to leave, and of one that does, when it
    goes on in the states 3, 2, 1 and 0 for good.

    both: the Q (5, 2) of each after each walk, the zeros before included.
    """
    blocked, opened = map(np.array, both)
    ends = [goes_on_from(opened, state) for state in (3, 2, 1, 0)]
    rows = {}
    for name, q, walk in (("blocked, in the end", blocked, len(blocked) - 1), *(("opened", opened, k) for k in ends)):
        arrived = (chain.arrivals(q) <= walk).sum()
        going_on = (q[walk, :, 1] > q[walk, :, 0]) & (np.arange(chain.STATES) < 4)
        rows[f"{name}: {arrived} arrivals"] = q[walk].max(axis=1), going_on
    key = "The larger Q. Orange: that is the Q of going on. White: of action 0. Grey: both actions stay."
    heads = ("trap", "state 1", "state 2", "state 3", "free road")
    title = "Before leaving wins, going on must win in states 3, 2 and 1"
    return _values(title, rows, 3, key, heads, "The larger Q", alone=0, look=OPEN)


def after_arrivals(q: np.ndarray, step: float, gamma: float, most: int = 14) -> Figure:
    """How many learners reach the free road once, twice, ..., and for how many of these leaving then wins.

    q: the Q (5, 2) of each before its first walk and after each, (walks + 1, learners, 5, 2);
    step, gamma: of Q-learning.
    """
    times, had, wins = np.arange(1, most + 1), np.zeros(most, dtype=int), np.zeros(most, dtype=int)
    for learner in range(q.shape[1]):
        for k, walk in enumerate(chain.arrivals(q[:, learner])[:most]):
            had[k] += 1
            wins[k] += chain.leaves(q[walk, learner])
    enough = [k for k, all_of, won in zip(times, had, wins, strict=True) if won > all_of / 2]
    title = f"With a step of {step:g} and γ = {gamma:g} leaving wins "
    title += f"for most learners that have arrived {enough[0]} times" if enough else "for hardly any learner"
    figure, ax = one_axes(3.2, title, "arrivals so far", f"learners of C, of {q.shape[1]}")
    for values, colour in ((had, LIGHT), (wins, DARK)):
        ax.bar(times, values, 0.72, color=colour, linewidth=0)
    for k, all_of, won in zip(times, had, wins, strict=True):
        ax.text(k, all_of + 5, f"{won / all_of:.0%}", fontsize=TEXT, color=INK, ha="center")
    at = {"fontsize": TEXT, "color": INK, "ha": "right"}
    ax.text(most + 0.4, 0.92 * had[0], "whole bar: learners that have arrived so often", **at)
    ax.text(most + 0.4, 0.80 * had[0], "dark, and %: for these leaving now wins", **at)
    ax.set(xlim=(0.5, most + 0.5), ylim=(0, 1.12 * had[0]), xticks=times)
    each = ", ".join(f"{k}: {won} of {all_of}" for k, all_of, won in zip(times, had, wins, strict=True))
    return finish(figure, title, f"For how many learners leaving wins right after an arrival, by its number: {each}.")
