"""Figures of demonstrations: where demonstrators were, and how clones drive."""

from collections.abc import Sequence

import numpy as np
from matplotlib.figure import Figure

from bootcourse.course import charts
from bootcourse.course.lessons.demonstrations import cloning
from bootcourse.episodes.rollout import Rollout
from bootcourse.learn.agent import Agent
from bootcourse.methods import style
from bootcourse.plots.canvas import MplAxes
from bootcourse.plots.figure import INK, TEXT, finish, new_figure, plain_axes
from bootcourse.plots.road import draw_road, edges_of
from bootcourse.road.state import EGO, TRAP_1, Accident, X, Y

UNSURE = "#6CC3A0"  # the stochastic rule: the rule's green, lighter


def where_they_were(drives: dict[str, Sequence[Rollout]], seconds: float, title: str) -> Figure:
    """The ego's paths, seen from trap 1, for some seconds; one panel for each named demonstrator."""
    figure = new_figure(1.0 + 1.35 * len(drives))
    total, alt_parts = figure.get_figheight(), []
    for k, (name, some) in enumerate(drives.items()):
        ax = figure.add_axes((0.08, (total - 1.75 - 1.35 * k) / total, 0.88, 0.95 / total))
        places, scenario = [], some[0].scenario
        draw_road(MplAxes(ax), scenario, -60, 15)
        for drive in some:
            states = drive.states[: int(seconds / drive.scenario.clock.dt) + 1]
            path = np.column_stack([states[:, EGO, X] - states[:, TRAP_1, X], states[:, EGO, Y]])
            ax.plot(*path.T, color=style("rule").colour if k == 0 else UNSURE, linewidth=0.8, alpha=0.45)
            places.append(path)
        plain_axes(ax, name, grid="")
        lanes, (top, edge) = range(scenario.road.lanes), edges_of(scenario.road)
        ax.set_yticks(np.array(lanes) * scenario.road.lane_width, [f"lane {lane}" for lane in lanes])
        ax.set(xlim=(-60, 15), ylim=(edge + 0.6, top - 0.6))
        last = k == len(drives) - 1
        ax.tick_params(axis="x", labelbottom=last)
        if last:
            ax.set_xlabel("distance ahead of trap 1 (m)", fontsize=TEXT, color=INK)
        all_places = np.concatenate(places)
        cells = len(np.unique(np.round(all_places / [2.0, 0.5]), axis=0))
        alt_parts.append(f"{name}: {len(some)} drives pass through {cells} squares of 2 by 0.5 m")
    return finish(
        figure, title, f"The ego's paths seen from trap 1 in the first {seconds:g} s. {'; '.join(alt_parts)}."
    )


def clones(measured: dict[str, np.ndarray]) -> Figure:
    """How clones drive: name -> (seeds, 4), shares of agreement, success and accidents, and the return.

    A dot for each seed, and a line for the rule's return. Those of the rule's drives come first.
    """
    of_rule = cloning.rule_s_drives().returns.mean()
    (agrees, _, crash, _), *others = (values.mean(0) for values in measured.values())
    title = "The data sets, and how their clones drive"
    if all(agrees > other[0] and crash > other[2] for other in others):
        title = "Clones of the rule's drives agree most with their data, and crash most"
    figure = new_figure(1.3 + 0.55 * len(measured))
    alt_parts = {name: [] for name in measured}
    height = figure.get_figheight()
    for k, label in enumerate(("agree with\ntheir data (%)", "success (%)", "have an\naccident (%)", "return")):
        ax = figure.add_axes((0.25 + 0.19 * k, 0.4 / height, 0.165, 1 - 1.4 / height))
        unit = "" if label == "return" else " %"
        for row, (name, values) in enumerate(measured.items()):
            shown = (100 if unit else 1) * values[:, k]
            ax.plot(shown, np.full(len(shown), row), "o", color=style("bc").colour, markersize=5, alpha=0.55)
            ax.plot(shown.mean(), row, "|", color=INK, markersize=15, markeredgewidth=2)
            ax.text(shown.mean(), row - 0.32, f"{shown.mean():.0f}", fontsize=TEXT, color=INK, ha="center")
            alt_parts[name].append(f"{' '.join(label.replace(' (%)', '').split())} {shown.mean():.0f}{unit}")
        plain_axes(ax, label, grid="x")
        names = [name.replace(", ", ",\n").replace("stochastic ", "stochastic\n") for name in measured]
        ax.set_yticks(range(len(measured)), names if k == 0 else [""] * len(measured))
        ax.tick_params(axis="y", labelcolor=INK, labelsize=TEXT)
        ax.set_ylim(len(measured) - 0.5, -0.6)
        if unit:
            ax.set_xlim(-6, 106)
    ax.axvline(of_rule, color=style("rule").colour, linewidth=1.5)
    ax.text(of_rule, len(measured) - 0.55, "the rule ", fontsize=TEXT, color=style("rule").colour, ha="right")
    words = "; ".join(f"clones of {name}: on average {', '.join(parts)}" for name, parts in alt_parts.items())
    ending = f"A dot for each clone, a bar for their mean. {words}. The rule's return is {of_rule:.0f}."
    return finish(figure, title, ending)


def differing(agents: Sequence[Agent], of_rule: Sequence[Rollout], own: Sequence[Rollout]) -> Figure:
    """In which seconds the clones differ from the rule: in their own drives, and in the states of the rule's."""
    theirs = np.mean([cloning.unlike(agent, of_rule) for agent in agents], axis=(0, 1))
    unlike = cloning.unlike_the_rule(own)
    mine, here = np.nanmean(unlike, axis=0), f"{100 * np.nanmean(unlike[:, 10:40]):.0f} %"
    there = f"{100 * theirs[10:40].mean():.0f} %"
    title = f"First they differ in both; from 10 to 40 s in {here} of their own states, in {there} of the rule's"
    named = {"in their own states": 100 * mine, "in the rule's states": 100 * theirs}
    looks = [charts.Style(style(method).colour) for method in ("bc", "rule")]
    return charts.lines(np.arange(len(mine)), named, title, "time (s)", "differ (%)", looks=looks)


def of_tests(tests: dict[str, Sequence[Rollout]]) -> tuple[list[str], list[list[str]], str]:
    """A table's columns, rows and last line: what the rule drives -> the clones' drives."""
    columns = ["the rule drives", "the clones differ, 40 to 60 s", "slow in the free lane"]
    columns += ["an accident by 15 s", "15 to 40 s", "after 40 s", "return"]
    rows = []
    for name, drives in tests.items():
        differ = np.nanmean(cloning.unlike_the_rule(drives)[:, 40:60])
        ended = np.array([len(each.actions) if each.accident else np.inf for each in drives])
        counts, _ = np.histogram(ended, [0, 15.5, 40.5, 1e6])  # drives without an accident are in none
        shares = [f"{100 * each / len(drives):.0f} %" for each in counts]
        back = np.mean([each.rewards.sum() for each in drives])
        rows.append([name, f"{100 * differ:.0f} %", f"{cloning.slow_seconds(drives):.0f} s", *shares, f"{back:.0f}"])
    ends = [each.accident for drives in tests.values() for each in drives if each.accident]
    left = sum(each == Accident.ROAD_DEPARTURE for each in ends)
    clones = len(drives) // len({each.seed for each in drives})
    return columns, rows, f"{clones} clones, 20 roads each. In {left} of the {len(ends)} accidents they leave the road."


def of_trainings(trainings: Sequence[np.ndarray], of_rule: np.ndarray) -> tuple[list[str], list[list[str]], str]:
    """A table's columns, rows and last line: each driver of each training (rounds + 1, 4) as `cloning.compared` has it,
    clones of the rule as `cloning.measure` has them, and the rule.
    """
    columns = ["trained on", "agrees in the rule's states", "in its own", "has an accident, each training", "return"]
    rows = []
    for number, drivers in enumerate(np.swapaxes(trainings, 0, 1)):
        there, own, _, back = drivers.mean(0)
        accidents = ", ".join(f"{100 * each:.0f}" for each in drivers[:, 2])
        texts = f"{100 * there:.0f} %", f"{100 * own:.0f} %", f"{accidents} %", f"{back:.0f}"
        rows.append([f"and {20 * number} own" if number else "20 drives of the rule", *texts])
    agrees, _, crash, back = of_rule.mean(0)
    rows.append(["200 drives of the rule", f"{100 * agrees:.0f} %", "", f"{100 * crash:.0f} %", f"{back:.0f}"])
    drives = cloning.rule_s_drives()
    crash, back = (drives.accident > 0).mean(), drives.returns.mean()
    rows.append(["(the rule itself)", "100 %", "100 %", f"{100 * crash:.0f} %", f"{back:.0f}"])
    clones = f"in the row with 200 drives all are means of {len(of_rule)} clones"
    return columns, rows, f"Agreement and return are means of the trainings; {clones}."
