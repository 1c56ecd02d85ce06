"""Figures of the lesson on SAC's update and loop: what small worlds teach, tests, and what critics expect."""

from collections.abc import Mapping, Sequence

import numpy as np
from IPython.display import Markdown
from matplotlib.figure import Figure

from bootcourse.colours import OTHER, QUIET, STRANGERS, Style
from bootcourse.course import charts, table
from bootcourse.course.lessons.update_and_loop import by_hand, numbers, worlds
from bootcourse.course.lessons.update_and_loop.explorable import BUG
from bootcourse.plots.figure import TEXT, finish, label_ends, one_axes

OF_A_FALL = "What critics expect in a fall"
OF_Q = f"Q {worlds.BEFORE} pushes before the fall", "Q of a fallen pole"


def small_worlds(*learned: Mapping[str, worlds.Learned]) -> Markdown:
    """A table of what is right in each small world, and of what agents learned: one, and one with a bug."""
    rows = []
    for words, world in worlds.WORLDS.items():
        alike = len(set(world.pays[0])) == 1  # both pushes pay the same
        found = (each[words] for each in learned)
        shown = (
            f"{q.mean():.1f}" if alike else f"{abs(q[0]):.1f} and {q[1]:.1f}; π(right) {pi[1]:.2f}" for q, pi in found
        )
        rows.append([words, world.right, *shown])
    headings = ["world", "right Q (no entropy)", "your agent's Q", "its Q if `terminated` is lost"]
    return table(headings[: 2 + len(learned)], rows, worlds_apart(*learned) if len(learned) == 2 else "")


def worlds_apart(one: Mapping[str, worlds.Learned], other: Mapping[str, worlds.Learned]) -> str:
    """In which small worlds these two learned another Q, in a sentence."""
    apart = [abs(one[words].q - other[words].q).max() > 0.3 for words in worlds.WORLDS]
    return f"The last two columns differ in: {', '.join(f'world {i + 1}' for i in np.flatnonzero(apart)) or 'none'}."


def tests_in_training(tests: Sequence[float], block: int, lost: float) -> Figure:
    """The tests of an agent, one before its training and one after each `block` of pushes, over those of ours that are
    not the same.

    lost: the test after one block of an agent that learns with the bug and begins as this one.
    """
    pushes, look = np.arange(len(tests)) * block, BUG
    title = f"After {block:,} pushes of training yours balances {tests[1]:.0f}, with the bug {lost:.0f}"
    figure, ax = one_axes(3.6, title, "pushes in training", "pushes balanced", width=0.66)
    ours = [each for each in numbers.tests() if len(each) != len(tests) or not np.allclose(each, tests)]
    for each in ours:
        ax.plot(numbers.BLOCK * np.arange(len(each)), each, color=QUIET, linewidth=0.8)
    ax.plot(pushes, tests, "o-", color=OTHER.colour, linewidth=2, markersize=4)
    ax.plot(pushes[:2], [tests[0], lost], "o", linestyle=look.line, color=look.colour, linewidth=2, markersize=4)
    ax.set(xlim=(0, max(pushes[-1], *numbers.pushes())), ylim=(-15, 560))
    near = {"textcoords": "offset points", "fontsize": TEXT}
    ax.annotate("your agent", (pushes[-1], tests[-1]), (0, 6), color=OTHER.colour, ha="right", **near)
    ax.annotate("with the bug", (block, lost), (8, 0), color=look.colour, va="center", **near)
    label_ends(ax, [(ours[0][-1], f"thin: {len(ours)} of ours, other seeds", QUIET)])
    says = f"Your agent: {', '.join(f'{test:.3g}' for test in tests)}; with the bug: {lost:.3g}."
    return finish(figure, title, f"Pushes balanced against pushes in training. {says}")


def along_falls(yours: np.ndarray, unmarked: by_hand.SAC) -> Figure:
    """What two agents' critics expect along a fall, see `worlds.along_falls`, and the most that Q can be."""
    q, most = worlds.along_falls(unmarked), worlds.most_possible(unmarked)
    shown = q.argmax() == worlds.BEFORE and q.min() > most
    title = "With the bug a fallen pole is worth most, more than is possible" if shown else OF_A_FALL
    ceiling = f"its ceiling {most:.0f} (α = {unmarked.log_alpha.exp():.2f})"
    return falls(title, {"with the bug": q, "your agent": yours}, [BUG, OTHER], {ceiling: most})


def with_rows(yours: np.ndarray, unmarked: by_hand.SAC, added: by_hand.SAC, stands: float) -> Figure:
    """The same for an agent with the bug whose buffer has rows of fallen poles. stands: pushes that it balances."""
    shown = drops(added) and yours[-1] < yours[0] / 2
    title = "With rows of fallen poles Q drops towards the fall, as yours does" if shown else OF_A_FALL
    named = {f"bug and rows: stands for {stands:.0f} pushes": worlds.along_falls(added), "your agent": yours}
    return beyond(falls(title, named, [STRANGERS[2], OTHER]), "bug alone", unmarked)


def with_frozen_guess(
    yours: np.ndarray, unmarked: by_hand.SAC, frozen: by_hand.SAC, worth: float, stands: float
) -> Figure:
    """The same for an agent with the bug whose guess of a fallen pole is frozen at `worth`; it stands for `stands`."""
    bug, q = worlds.along_falls(unmarked)[-1], worlds.along_falls(frozen)
    title = f"Frozen at {worth:g}, Q of a fallen pole stays near {worth:g}; not frozen it is {bug:.0f}"
    named = {f"frozen at {worth:g}: stands for {stands:.0f} pushes": q, "your agent": yours}
    figure = falls(title if abs(q[-1] - worth) < 6 else OF_A_FALL, named, [STRANGERS[1], OTHER])
    return beyond(figure, "not frozen", unmarked)


def with_held_temperature(named: Mapping[str, by_hand.SAC]) -> Markdown:
    """A table of agents after equally many pushes: α, Q along a fall, and for how long they balance the pole."""
    rows = []
    for name, agent in named.items():
        q = worlds.along_falls(agent)
        alpha, stands = agent.log_alpha.exp().item(), by_hand.balanced(agent)
        rows.append([name, f"{alpha:.2f}", *(f"{each:,.0f}" for each in (q[0], q[-1], stands))])
    return table(["agent", "its α now", *OF_Q, "pushes balanced"], rows)


def twice_as_long(
    halves: Mapping[str, tuple],
    wholes: Sequence[by_hand.SAC],
    first: Sequence[float],
    later: Sequence[float],
    block: int,
) -> Markdown:
    """A table of two agents after one block of pushes and after two: Q along a fall, and for how long they stand.

    halves: {name: (agent after one block, its rows)}; wholes: after two; first, later: pushes that they balance.
    """
    rows = []
    for (name, (half, _)), whole, *stands in zip(halves.items(), wholes, first, later, strict=True):
        for blocks, agent, stood in zip((1, 2), (half, whole), stands, strict=True):
            q = worlds.along_falls(agent)
            rows.append([name, f"{block * blocks:,}", *(f"{each:,.0f}" for each in (q[0], q[-1], stood))])
    return table(["agent", "pushes in training", *OF_Q, "pushes balanced"], rows)


def beyond(figure: Figure, words: str, agent: by_hand.SAC) -> Figure:
    """The figure with a note at its upper edge: an agent's Q along a fall, which lies off the picture."""
    ax, q = figure.axes[0], worlds.along_falls(agent)
    low, high = ax.get_ylim()
    if q.min() > high:
        ax.set_ylim(low, high + 0.16 * (high - low))
        says = f"{words}: from {q[0]:.0f} to {q[-1]:.0f}, off the picture ↑"
        ax.text(0.5, 0.99, says, transform=ax.transAxes, ha="center", va="top", color=BUG.colour, fontsize=TEXT)
    return figure


def drops(agent: by_hand.SAC) -> bool:
    """Whether Q drops towards the fall by more than a half."""
    q = worlds.along_falls(agent)
    return bool(q[-1] < q[0] / 2)


def falls(title: str, named: Mapping[str, np.ndarray], looks: Sequence[Style], marks: Mapping = {}) -> Figure:
    """A line for each agent's Q along a fall. marks: {words: Q}, dotted."""
    says = "; ".join(f"{words}: {q[0]:.3g}, then {q[-1]:.3g}" for words, q in named.items())
    says += "".join(f"; {words}: {most:.3g}" for words, most in marks.items())
    pushes, x_label = np.arange(-worlds.BEFORE, 1), "pushes from the fall (0: the pole has fallen)"
    return charts.lines(pushes, named, title, x_label, "Q, mean of 40 falls", marks=marks, looks=looks, alt=f"{says}.")
