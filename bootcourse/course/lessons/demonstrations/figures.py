"""Figures of demonstrations: where demonstrators were, and how clones drive."""

import re
from collections.abc import Sequence

import numpy as np
from matplotlib.figure import Figure
from torch import Tensor

from bootcourse.colours import ALARM, QUIET
from bootcourse.course.lessons.demonstrations import cloning
from bootcourse.course.shipped import shipped_experiment
from bootcourse.episodes.rollout import Rollout
from bootcourse.methods import style
from bootcourse.plots.canvas import MplAxes
from bootcourse.plots.figure import INK, SMALL, TEXT, finish, label_ends, new_figure, plain_axes
from bootcourse.plots.road import draw_road, edges_of
from bootcourse.road.state import EGO, TRAP_1, X, Y

UNSURE = "#6CC3A0"  # the stochastic rule: the rule's green, lighter
SEEN = -45, 15  # m from trap 1, of the paths


def where_they_were(drives: dict[str, Sequence[Rollout]], seconds: float, title: str) -> Figure:
    """The ego's paths, seen from trap 1, for some seconds; one panel for each named demonstrator."""
    figure = new_figure(1.0 + 1.35 * len(drives))
    total, alt_parts = figure.get_figheight(), []
    for k, (name, some) in enumerate(drives.items()):
        ax = figure.add_axes((0.11, (total - 1.75 - 1.35 * k) / total, 0.87, 0.95 / total))
        places, scenario = [], some[0].scenario
        draw_road(MplAxes(ax), scenario, *SEEN)
        for drive in some:
            states = drive.states[: int(seconds / drive.scenario.clock.dt) + 1]
            path = np.column_stack([states[:, EGO, X] - states[:, TRAP_1, X], states[:, EGO, Y]])
            ax.plot(*path.T, color=style("rule").colour if k == 0 else UNSURE, linewidth=0.8, alpha=0.45)
            places.append(path)
        ended = sum(drive.accident > 0 for drive in some)
        plain_axes(ax, f"{name}: {ended} of {len(some)} drives end in an accident", grid="")
        lanes, (top, edge) = range(scenario.road.lanes), edges_of(scenario.road)
        ax.set_yticks(
            np.array(lanes) * scenario.road.lane_width, ["lane 0 (left)", *(f"lane {lane}" for lane in lanes[1:])]
        )
        ax.set(xlim=SEEN, ylim=(edge + 0.6, top - 0.6))
        last = k == len(drives) - 1
        ax.tick_params(axis="x", labelbottom=last)
        if last:
            ax.set_xlabel(f"distance ahead of trap 1 (m); paths are cut at {SEEN[1]} m", fontsize=TEXT, color=INK)
        all_places = np.concatenate(places)
        cells = len(np.unique(np.round(all_places / [2.0, 0.5]), axis=0))
        alt_parts.append(
            f"{name}: {len(some)} drives, {ended} with an accident, pass through {cells} squares of 2 by 0.5 m"
        )
    return finish(
        figure, title, f"The ego's paths seen from trap 1 in the first {seconds:g} s. {'; '.join(alt_parts)}."
    )


def clones(measured: dict[str, np.ndarray]) -> Figure:
    """How clones drive: name -> (seeds, 4) of `cloning.measure`. A dot for each seed, a bar for the mean."""
    agrees, crash = (np.array([values[:, k].mean() for values in measured.values()]) for k in (0, 2))
    title = "Agreement with the data, and accidents"
    if agrees.argmax() == crash.argmax() and (agrees[1], crash[1]) == (agrees[1:].max(), crash[1:].max()):
        title = "Agreement with its own data says little about a clone's driving"
    agree = "agree with\ntheir data (%)", "agree with the rule,\nown states (%)"
    return _panels(measured, dict(enumerate([*agree, "have an\naccident (%)"])), title)


def added(measured: dict[str, np.ndarray], fed: dict[str, np.ndarray], longer: dict[str, np.ndarray]) -> Figure:
    """What rows added to the rule's change: as `clones`, with the agreement with the rule in the clones' own states.

    measured: as in `clones`, last the rule's drives and the stochastic rule's. fed: the rule's with three kinds of
    others, the last two from the band's rim and from beyond it. longer: after a longer training.
    """
    rule_s, stochastic = [*measured][-2:]
    crash = {name: values[:, 2].mean() for name, values in (measured | fed).items()}
    title = "Accidents, with rows added to the rule's"
    if max(crash[kind] for kind in [*fed][1:]) < crash[rule_s] / 2:
        title = "Rows from the band's rim and beyond prevent more than half of the accidents"
    rows = {name: (measured | fed | longer)[name] for name in (rule_s, *fed, stochastic, *longer)}
    cures = {"shows the way back": (2, 4), "seldom leaves the band": (5, 5)}
    return _panels(rows, {1: "agree with the rule, own states (%)", 2: "have an accident (%)"}, title, cures)


SHIPPED = {0: "agrees", 1: "own", 2: "accidents"}  # what the columns of `cloning.measure` are called there


def _panels(
    measured: dict[str, np.ndarray],
    columns: dict[int, str],
    title: str,
    bands: dict[str, tuple[int, int]] | None = None,
) -> Figure:
    """A row for each name, a panel for each of two or three columns of `cloning.measure`.

    A square: the mean of the fifteen clones that ship, of the kinds of which some do. bands: words that stand, in the
    last panel, beside the rows from one to another, which are tinted.
    """
    figure, fifteen = new_figure(1.45 + 0.5 * len(measured)), shipped_experiment("clones")
    alt_parts = {name: [] for name in measured}
    height, step = figure.get_figheight(), 0.74 / len(columns)
    for place, (k, label) in enumerate(columns.items()):
        ax = figure.add_axes((0.27 + step * place, 0.6 / height, step - 0.03, 1 - 1.4 / height))
        for row, (name, values) in enumerate(measured.items()):
            shown = 100 * values[:, k]
            ax.plot(shown, np.full(len(shown), row), "o", color=style("bc").colour, markersize=5, alpha=0.55)
            ax.plot(shown.mean(), row, "|", color=INK, markersize=15, markeredgewidth=2)
            alt_parts[name].append(f"{label.removesuffix(' (%)')} {shown.mean():.0f} %".replace("\n", " "))
            kind = re.sub(r"\+ \d+ ", "", name)
            kind = cloning.ADDED.get(kind, kind)
            if kind in fifteen:
                mean = 100 * fifteen[kind].notes[SHIPPED[k]].mean()
                ax.plot(mean, row + 0.27, "s", color="none", markeredgecolor=INK, markersize=5)
                alt_parts[name][-1] += f" (fifteen others {mean:.0f} %)"
            ax.text(shown.mean(), row - 0.32, f"{shown.mean():.0f}", fontsize=TEXT, color=INK, ha="center")
        for words, (first, last) in (bands or {}).items():
            ax.axhspan(first - 0.47, last + 0.47, color=style("bc").colour, alpha=0.07, linewidth=0)
            if place == len(columns) - 1:
                ax.text(
                    103,
                    (first + last) / 2,
                    words.replace(" ", "\n", 1),
                    fontsize=TEXT,
                    color=INK,
                    ha="right",
                    va="center",
                )
        plain_axes(ax, label, grid="x")
        ax.set_yticks(range(len(measured)), list(measured) if place == 0 else [""] * len(measured))
        ax.tick_params(axis="y", labelcolor=INK, labelsize=TEXT)
        ax.set(xlim=(-4, 104), ylim=(len(measured) - 0.5, -0.7))
    words = "a dot: a clone; a bar: their mean; a square: the mean of fifteen other clones"
    figure.text(0.27, 0.12 / height, words, fontsize=SMALL, color=INK)
    words = "; ".join(f"{name}: {', '.join(parts)}" for name, parts in alt_parts.items())
    words += "".join(f". {cure.capitalize()}: rows {a + 1} to {b + 1}" for cure, (a, b) in (bands or {}).items())
    return finish(figure, title, f"Clones' means, by data. {words}.")


BEFORE = 15  # s before an accident that `off_the_road` shows
DRAWN = 6  # of its drives, which differ most; the table counts all
PLACES = {-1.0: "1 m right", 0.0: "left lane's\nmiddle", 1.0: "1 m left", 2.0: "2 m left:\nroad's edge"}


def off_the_road(own: Sequence[Rollout], of_rule: Tensor) -> Figure:
    """Where the clones' cars were in the last seconds before they left the road on the left, and where they erred.

    A few of the drives, see `unlike`, are drawn; all are counted in what it says.
    """
    ended = [drive for drive in own if cloning.off_on_the_left(drive)]
    high = cloning.left_in(of_rule).max().item()
    figure = new_figure(3.9)
    ax = figure.add_axes((0.125, 0.14, 0.85, 0.71))
    ax.axhspan(-2, high, color=style("rule").colour, alpha=0.16, linewidth=0)
    drawn = unlike(ended, DRAWN)
    for drive in drawn:
        clock = drive.scenario.clock
        at = np.arange(len(drive.actions)) - (len(drive.states) - 1) * clock.dt
        place, errs = cloning.metres_left(drive), drive.actions != drive.rule_actions
        ax.plot(
            (np.arange(len(drive.states)) - len(drive.states) + 1) * clock.dt, -drive.states[:, EGO, Y],
            color=style("bc").colour, linewidth=1.2, alpha=0.6,
        )  # fmt: skip
        for which, colour in ((~errs, QUIET), (errs, ALARM)):
            ax.plot(at[which], place[which], "o", color=colour, markersize=4, alpha=0.8, markeredgewidth=0)
    ax.axhline(2, color=INK, linewidth=1.5)
    plain_axes(ax, "", grid="")
    words = {"fontsize": TEXT, "ha": "left", "va": "bottom"}
    ax.text(-BEFORE + 0.2, -1.68, "green: where the rule drives, in the left lane", color=style("rule").colour, **words)
    ax.text(-BEFORE + 0.2, -1.94, "dots: decisions, red: errors", color=ALARM, **words)
    ax.set(xlim=(-BEFORE, 0.2), ylim=(-2, 2.35))
    ax.set_yticks(list(PLACES), list(PLACES.values()))
    parts = [(ever_beyond(some, of_rule), len(some)) for some in (drawn, ended)]
    kinds = (f"{a} of {b}" for a, b in zip(*((beyond, of - beyond) for beyond, of in parts), strict=True))
    words = f"time before the car is off the road (s); drawn: {' drives ever left of the band, '.join(kinds)} never"
    ax.set_xlabel(words, fontsize=TEXT, color=INK)
    left_of_it, elsewhere = errors(ended, high)
    title = f"The last {BEFORE} s of {len(drawn)} drives off the left edge, and their errors"
    if 0 < ever_beyond(ended, of_rule) < len(ended):
        title = "Cars leave the road from beyond the green band, and from inside it"
    return finish(
        figure, title,
        f"{len(drawn)} of {len(ended)} drives that leave the road on the left. In the left lane the rule's rows reach "
        f"{high:.1f} m left of its middle. Left of this place {100 * left_of_it:.0f} % of all {len(ended)} drives' "
        f"decisions are errors, elsewhere {100 * elsewhere:.0f} %.",
    )  # fmt: skip


def unlike(drives: Sequence[Rollout], count: int) -> list[Rollout]:
    """Drives that are in the left lane all their last seconds, each as far as possible from those before it."""
    steps = BEFORE * drives[0].scenario.clock.simulation_rate
    paths = {k: each.states[-steps:, EGO, Y] for k, each in enumerate(drives) if len(each.states) >= steps}
    paths = {k: path for k, path in paths.items() if path.max() < 2} or paths
    chosen = list(paths)[:1]
    while len(chosen) < min(count, len(paths)):
        apart = {k: min(np.abs(path - paths[other]).mean() for other in chosen) for k, path in paths.items()}
        chosen.append(max(apart, key=apart.get))
    return [drives[k] for k in chosen]


def errors(drives: Sequence[Rollout], high: float) -> tuple[float, float]:
    """The share of errors among these drives' decisions farther left than this (m), and among the others."""
    wrong = np.concatenate([drive.actions != drive.rule_actions for drive in drives])
    beyond = np.concatenate([cloning.metres_left(drive) > high for drive in drives])
    return wrong[beyond].mean(), wrong[~beyond].mean()


def ever_beyond(drives: Sequence[Rollout], of_rule: Tensor) -> int:
    """In how many of these drives the car is left of all of the rule's rows at a decision."""
    high = cloning.left_in(of_rule).max().item()
    return sum(bool((cloning.metres_left(drive) > high).any()) for drive in drives)


def taught(trainings: np.ndarray, alike: np.ndarray) -> Figure:
    """What DAgger changes: (trainings, rounds + 1, 4) of `cloning.measure`. alike: accidents of clones of 60 drives.

    Left the agreement with the rule, right the accidents: a thin line for each training, a thick one for their mean.
    """
    trainings = np.asarray(trainings)
    drives, mean = 20 * np.arange(1, trainings.shape[1] + 1), 100 * trainings.mean(axis=0)
    title = "Agreement and accidents, while the clone's own drives are added"
    if mean[-1, 0] < mean[0, 0] and mean[-1, 2] < mean[0, 2]:
        title = "The clones agree less in the rule's states, and crash less"
    figure = new_figure(3.2)
    lines = {0: ("in the rule's states", style("rule").colour), 1: ("in its own states", style("bc").colour)}
    for left, label, some in (
        (0.075, "agrees with the rule (%)", lines),
        (0.59, "has an accident (%)", {2: ("", style("bc").colour)}),
    ):
        ax = figure.add_axes((left, 0.16, 0.28, 0.6))
        plain_axes(ax, label)
        for k, (_, colour) in some.items():
            ax.plot(drives, 100 * trainings[:, :, k].T, color=colour, linewidth=0.8, alpha=0.7)
            ax.plot(drives, mean[:, k], color=colour, linewidth=2.2, marker="o", markersize=4)
        ax.set(xlim=(drives[0] - 2, drives[-1] + 2), ylim=(-3, 103))
        ax.set_xticks(drives, ["20 drives\nof the rule", *(f"+ {each} of\nthe clone" for each in drives[:-1])])
        ends = [(mean[-1, k], *some[k]) for k in some if some[k][0]]
        if 2 in some:
            crash = 100 * alike.mean()
            ax.axhline(crash, color=style("rule").colour, linewidth=1.2, linestyle=(0, (4, 2)))
            low, high = 100 * alike.min(), 100 * alike.max()
            words = f"{len(alike)} clones of 60 drives of the rule ({low:.0f} to {high:.0f} %)"
            ends = [(crash, words, style("rule").colour)]
        label_ends(ax, ends, wrap=14)
    words = [f"{name} {', '.join(f'{each:.0f}' for each in mean[:, k])} %" for k, (name, _) in lines.items()]
    each = "; then ".join(", ".join(f"{100 * x:.0f}" for x in crash) for crash in trainings[:, :, 2].T)
    alt = f"On average the clone agrees {', '.join(words)}. Accidents of the three trainings (%): {each}. "
    alt += f"{len(alike)} clones of 60 drives of the rule: {100 * alike.mean():.0f} %."
    return finish(figure, title, alt)
