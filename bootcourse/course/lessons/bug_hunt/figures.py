"""The pictures of the bug hunt: two drives, and a panel for each agent with a bug, the healthy one in grey.

The titles say what is drawn and not what it shows: to find that is the student's work.
"""

from collections.abc import Mapping

import numpy as np
from matplotlib.figure import Figure
from matplotlib.ticker import NullLocator

from bootcourse.colours import OTHER
from bootcourse.course import charts, shipped
from bootcourse.course.dots import name_rows
from bootcourse.course.lessons.bug_hunt.bugs import EVERY, LETTERS, Hunt
from bootcourse.episodes.evaluate import held_out_seeds
from bootcourse.episodes.record import record
from bootcourse.episodes.rollout import Rollout
from bootcourse.learn.settings import settings_for
from bootcourse.plots.figure import axes_at, finish, new_figure

DRIVERS = {"first agent": "healthy", "second agent": "E"}
ROADS = held_out_seeds(13, 400)  # new ones, for the agents' likeliest actions
FIRST = 80  # training episode, with which the curves of the return begin: none has moved before
HEAD, FOOT = 0.6, 0.5  # inches, above and below the rows of `line_ends`
FAR = 10.0, 2.0, 2.0, 10.0  # beyond the healthy agent's two seeds, in each column of `line_ends`
LAST = 8  # values of a probe, of which `line_ends` shows the mean
LINEAR = 20  # of the promise: above it the axis is logarithmic
PALE, PALER = "#B4BDC7", "#E9EDF1"  # the healthy agent, and what is not far from it


def most(with_bonus: bool = True) -> float:
    """What a critic may promise at most: a road that pays 1 a second and the bonus in every second, discounted."""
    settings = settings_for("bootstrapped")
    return (1 + with_bonus * settings.bonus) / (1 - settings.gamma)


def two_drives(hunt: Hunt) -> list[Rollout]:
    """The first 50 s of the healthy agent and of one with a bug, on the same road, under names that do not tell."""
    drives = [record(hunt.agent(name).as_policy(), [10], label=label)[0] for label, name in DRIVERS.items()]
    return [shipped.beginning(drive, 50) for drive in drives]


def returns(hunt: Hunt) -> Figure:
    """Mean return of the last 30 training episodes."""
    title = "Return in training"
    episode = "training episode (logarithmic)"
    what = "return, mean of 30 episodes (an agent that crashes early drives more episodes)"
    figure = charts.many(hunt.curves("return"), title, episode, what, reference="healthy", x_scale="log")
    for panel in figure.axes:
        panel.set_xlim(left=FIRST)
    return figure


def accidents(hunt: Hunt) -> Figure:
    """Q of the decisions that ended in an accident."""
    title = "Q at an agent's own accidents"
    what = "Q where an accident followed"
    figure = charts.many(hunt.probes("end"), title, "updates", what, reference="healthy", level=-10)
    at_dotted(figure, {"right: −10": -10})
    return figure


def promises(hunt: Hunt) -> Figure:
    """Mean of Σ π Q in seconds that the rule drove."""
    title = "What the critic promises"
    what = f"promise Σ π Q, logarithmic above {LINEAR}"
    limits = (-2, 200)
    figure = charts.many(hunt.probes("promise"), title, "updates", what, "healthy", limits, level=most())
    for panel in figure.axes:
        panel.set_yscale("symlog", linthresh=LINEAR, linscale=2)
        panel.set(ylim=limits, yticks=(0, 10, 20, 100))
        panel.yaxis.set_major_formatter("{x:g}")
        panel.yaxis.set_minor_locator(NullLocator())
        panel.axhline(most(False), color=charts.INK, linewidth=1, linestyle=(0, (1, 2)), zorder=1)
    names = {f"ceiling without bonus: {most(False):.0f}": most(False)}
    at_dotted(figure, {**names, f"ceiling with the bonus always: {most():.0f}": most()})
    return figure


def at_dotted(figure: Figure, named: Mapping[str, float]) -> None:
    """Write below the first panel's dotted lines, {words: y}, what they are."""
    for words, y in named.items():
        at = {"xy": (1, y), "xycoords": ("axes fraction", "data"), "xytext": (0, -3), "textcoords": "offset points"}
        figure.axes[0].annotate(words, **at, ha="right", va="top", fontsize=charts.SMALL, color=charts.INK)


def rarest(hunt: Hunt) -> Figure:
    """Mean log of the smallest of the nine probabilities in the same seconds."""
    title = "The policy's rarest action"
    what = "ln of the rarest action's probability (−20: 2 in a billion)"
    return charts.many(hunt.probes("rarest"), title, "updates", what, reference="healthy")


def likeliest(hunt: Hunt) -> Figure:
    """How much more often the likeliest of the nine actions is the rule's of the same second than of the next."""
    title = "Is the policy's likeliest action the rule's of this second, or of the next?"
    what = "agrees with the rule now, less agrees with it a second later (share of seconds)"
    return charts.many(now_not_next(hunt), title, "updates", what, reference="healthy")


def now_not_next(hunt: Hunt) -> dict[str, tuple[np.ndarray, np.ndarray]]:
    """What `likeliest` draws: {name: (updates (points,), values (2 seeds, points))}."""
    return {name: (hunt.updates, hunt.probe(name, "alike") - hunt.probe(name, "late")) for name in hunt.names}


def line_ends(hunt: Hunt) -> Figure:
    """Where the lines of the four pictures above end: a row for each agent, a column for each picture.

    The return is the mean of the last 30 episodes, as above; a probe's value is the mean of its last `LAST`.
    """
    panels = {
        "return (Round 1)": hunt.at_the_end("return"),
        "Q at own accidents (2)": last(hunt, "end"),
        "promise (3)": last(hunt, "promise"),
        "ln of rarest action (4)": last(hunt, "rarest"),
    }
    title, row, alt = "Where the lines end", 0.27, []
    figure = new_figure(HEAD + row * len(LETTERS) + FOOT)
    for place, (what, ends) in enumerate(panels.items()):
        ax = axes_at(figure, 0.4 + 1.66 * place, HEAD, 1.45, row * len(LETTERS))
        low, high = min(ends["healthy"]), max(ends["healthy"])
        ax.axvspan(low - FAR[place], high + FAR[place], color=PALER, linewidth=0, zorder=0)
        ax.axvspan(low, high, color=PALE, linewidth=2, zorder=1)  # its edge shows a narrow band, too
        for y, name in enumerate(LETTERS):
            ax.scatter(ends[name], [y, y], s=22, color=OTHER.colour, zorder=3, clip_on=False)
        name_rows(ax, LETTERS if place == 0 else [""] * len(LETTERS), what)
        ax.margins(x=0.08)
        said = "; ".join(f"{name}: {', '.join(f'{value:.3g}' for value in ends[name])}" for name in ends)
        alt.append(f"{what}: {said}; far is more than {FAR[place]:.0f} beyond healthy")
    beyond = f"{', '.join(f'{far:g}' for far in FAR[:-1])} and {FAR[-1]:g}"
    means = f"two seeds each, mean of the last 30 episodes or {LAST * EVERY:,} updates"
    words = f"{means}; dark grey: healthy; light grey: {beyond} beyond"
    figure.text(0.012, 1 - 0.42 / figure.get_figheight(), words, fontsize=charts.SMALL, color=charts.QUIET)
    span = f"Two dots in each row: means of 30 episodes or {LAST * EVERY:,} updates."
    return finish(figure, title, f"{span} {'. '.join(alt)}.".replace("-", "−"))


def last(hunt: Hunt, probe: str) -> dict[str, np.ndarray]:
    """The mean of a probe's last `LAST` values, {name: (2 seeds,)}."""
    return {name: hunt.probe(name, probe)[:, -LAST:].mean(axis=1) for name in hunt.names}
