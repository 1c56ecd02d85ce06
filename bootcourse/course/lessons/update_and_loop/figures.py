"""Figures of the lesson on SAC's update and loop: the pole before training, tests, and what critics expect."""

from collections.abc import Mapping, Sequence

import numpy as np
from IPython.display import Markdown
from matplotlib.figure import Figure

from bootcourse.colours import GRID, INK, OTHER, QUIET, STRANGERS
from bootcourse.course import charts, table
from bootcourse.course.lessons.discrete_sac.figures import cartpole_strip
from bootcourse.course.lessons.update_and_loop import by_hand, numbers, worlds
from bootcourse.learn.teachers import teacher_policy
from bootcourse.plots.figure import finish, label_ends, one_axes
from bootcourse.research.experiments import checks


def before_training(agent: by_hand.SAC) -> Figure:
    """An episode of an untrained agent, by its most probable pushes, and one of the rule."""
    drivers = {"untrained": agent.as_policy(), "rule: one weighted sum": teacher_policy(checks.balance, None, 2)}
    drives = {}
    for label, driver in drivers.items():
        rows, pushes = checks.data(driver, checks.cartpole, 1, seed=0)
        drives[f"{label}: {pushes:.0f} pushes"] = rows[:, :4].numpy()
    return cartpole_strip(drives, "An untrained agent lets the pole fall at once")


def small_worlds(learned: Mapping[str, worlds.Learned]) -> Markdown:
    """A table of what Q should be in each small world, and of what the critics expect there."""
    rows = []
    for words, (q, pi) in learned.items():
        world = worlds.WORLDS[words]
        left, right = world.pays[0]
        each = f"{abs(q[0]):.1f} and {q[1]:.1f}; it pushes right in {100 * pi[1]:.0f} %"
        rows.append([words, world.right, f"{q.mean():.1f}" if left == right else each, world.shows])
    return table(["world", "right Q", "your agent", "a bug that it would show"], rows)


def tests_in_training(tests: Sequence[float], block: int) -> Figure:
    """The tests of an agent, one before its training and one after each `block` of pushes, over five of ours."""
    pushes, falls = np.arange(len(tests)) * block, int((np.diff(tests) < 0).sum())
    ended = "Solved after" if min(tests[-2:]) >= 475 else "Not solved in"
    worse = "test is" if falls == 1 else "tests are"
    title = f"{ended} {pushes[-1]:,} pushes; {falls} {worse} worse than the one before"
    figure = charts.lines(pushes, {"your agent": np.array(tests)}, title, "pushes in training",
                          "pushes balanced (thin: five of ours)", looks=[OTHER._replace(marker="o")])  # fmt: skip
    (ax,) = figure.axes
    for each in numbers.tests():
        ax.plot(numbers.BLOCK * np.arange(len(each)), each, color=QUIET, linewidth=0.8, zorder=1)
    ax.set_xlim(0, max(pushes[-1], *numbers.pushes()))
    return figure


def along_falls(marked: by_hand.SAC, unmarked: by_hand.SAC) -> Figure:
    """What two agents' critics expect along a fall, see `worlds.along_falls`, and in a band what Q can be there."""
    curves = {"no fall is marked": worlds.along_falls(unmarked), "your agent": worlds.along_falls(marked)}
    least, most = worlds.still_paid(unmarked.gamma), worlds.most_possible(unmarked)
    impossible = curves["no fall is marked"].min() > most
    title = "Without marks, Q is above all that is possible" if impossible else "What the critics expect along a fall"
    x_label, y_label = "pushes from the fall (0: the pole has fallen)", "Q, mean of 40 falls (logarithmic above 1)"
    figure, ax = one_axes(3.6, title, x_label, y_label, width=0.66)
    ax.set_yscale("symlog", linthresh=1)
    ax.yaxis.set_major_formatter("{x:g}")
    pushes, ends = np.arange(-worlds.BEFORE, 1), [(most, f"the most possible: {most:.0f}", QUIET)]
    ax.fill_between(pushes[:-1], least, most, color=GRID, linewidth=0)
    ax.plot(pushes[:-1], least, color=INK, linewidth=1)
    ax.axhline(most, color=QUIET, linewidth=1, linestyle=(0, (2, 2)))
    ends.append((least[-1], f"the least possible: Round 1's curve, γ = {unmarked.gamma:g}", INK))
    for (label, values), look in zip(curves.items(), (STRANGERS[1], OTHER), strict=True):
        ax.plot(pushes, values, color=look.colour, linestyle=look.line, linewidth=2)
        words = f"{label}: from {values[0]:.0f} to {values[-1]:.0f}".replace("-", "−")
        ends.append((values[-1], words, look.colour))
    ax.set_xlim(pushes[0], 0)
    scaled = ax.get_yaxis_transform().transform  # labels are placed in a linear height
    (low, high), places = scaled([(0, y) for y in ax.get_ylim()])[:, 1], scaled([(0, y) for y, *_ in ends])[:, 1]
    heights = np.interp((places - low) / (high - low), (0, 1), ax.get_ylim())
    label_ends(ax, [(height, *rest) for height, (_, *rest) in zip(heights, ends, strict=True)])
    said = (f"{label}: {values[0]:.0f} at -8, {values[-1]:.0f} at 0." for label, values in curves.items())
    between = f"A band holds what Q can be, from {least[0]:.1f} at -8 and {least[-1]:.0f} at -1 to {most:.0f}."
    return finish(figure, title, f"Q against pushes from the fall. {' '.join(said)} {between}")
