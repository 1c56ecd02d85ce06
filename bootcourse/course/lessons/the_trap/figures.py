"""Figures of the trap: where each action leads, what pays, how agents drive after training, what each way is worth."""

from collections import Counter
from collections.abc import Mapping
from functools import partial

import numpy as np
from matplotlib.figure import Figure

from bootcourse.colours import OTHER
from bootcourse.course.dots import name_rows
from bootcourse.course.lessons.the_trap.driving import Worth
from bootcourse.episodes.evaluate import Episodes
from bootcourse.methods import METHODS, style
from bootcourse.plots.canvas import MplAxes
from bootcourse.plots.figure import INK, QUIET, SMALL, TEXT, WIDTH, axes_at, finish, in_front, new_figure, one_axes
from bootcourse.plots.road import draw_car, draw_road, edges_of
from bootcourse.research import report
from bootcourse.research.results import Results
from bootcourse.road.formulas import bicycle_step, speed_reward
from bootcourse.scenario import ACTION_NAMES, DEFAULT, Scenario
from bootcourse.statistics import ESCAPES

RIGHT_FIRST = ("keep right", ("keep left", 4), ("keep right", 3))  # the quick way out on road 10, then accelerate
REST = "#C5CBD2"  # of roads on which nothing happens
SHADES = ("#8A939B", INK, "#5F6B77")  # brake, keep, accelerate


def reward_curve(traps: float = 10.0, best: float = 15.0) -> Figure:
    """r_v against speed (m/s), with the traps' speed and the best one marked."""
    title = "The speed term is small up to 12.5 m/s and largest at 15 m/s"
    figure, ax = one_axes(3.2, title, "speed along the road (m/s)", "speed term $r_v$ (no unit)")
    speeds = np.linspace(0, 20, 801)
    ax.plot(speeds, [speed_reward(v) for v in speeds], color=INK, linewidth=2)
    for v, words in ((traps, "behind the traps"), (best, "a free road")):
        ax.plot(v, speed_reward(v), "o", color=INK)
        text = f"{words}: {v:g} m/s pays {speed_reward(v):.2f}"
        look = {"textcoords": "offset points", "ha": "right", "fontsize": TEXT, "color": INK}
        ax.annotate(text, (v, speed_reward(v)), xytext=(-10, 8), **look)
    ax.set_xlim(0, 20)
    alt = (
        f"The speed term against speed: zero up to 5 m/s, rising slowly to 12.5 m/s, steeply to 1 at {best:g} m/s, and "
        f"almost zero from 17 m/s on. At {traps:g} m/s it is {speed_reward(traps):.2f}."
    )
    return finish(figure, title, alt)


def nine_actions(decoded: np.ndarray, seconds: int = 2, scenario: Scenario = DEFAULT) -> Figure:
    """Where each action, held for some seconds, brings the ego from its start in the right lane.

    decoded: the acceleration (m/s²) and the steering (rad) of each action, (9, 2).
    """
    left, right = -5.0, scenario.ego.speed * seconds + 14.0
    lanes, width = scenario.road.lanes, scenario.road.lane_width
    road = (lanes * width + 4.4) * (WIDTH - 0.7) / (right - left)
    figure = new_figure(road + 0.95)
    ax = figure.add_axes((0.55 / WIDTH, 0.45 / (road + 0.95), (WIDTH - 0.7) / WIDTH, road / (road + 0.95)))
    draw_road(MplAxes(ax), scenario, left, right)
    start = (lanes - 1) * width
    draw_car(MplAxes(ax), 0.0, start, 0.0, OTHER.colour, scenario.car)
    ends = []
    for action, words in enumerate(ACTION_NAMES):
        path = path_of(decoded[action], seconds, scenario)
        colour = SHADES[action // 3]
        ax.plot(path[:, 0], path[:, 1] + start, color=colour, linewidth=1.3, zorder=5, clip_on=False)
        x, y = path[-1] + [0, start]
        ax.plot(x, y, "o", color=colour, markersize=5, zorder=6, clip_on=False)
        ends.append(f"{words} {x:.1f} m on and {abs(y - start):.1f} m to the side")
    labels = (("brake", (-4, 4), "right"), ("keep", (0, 9), "center"), ("accelerate", (7, -1), "left"))
    for i, (words, offset, align) in enumerate(labels):
        x, y = path_of(decoded[3 * i], seconds, scenario)[-1] + [0, start]
        ax.annotate(words, (x, y), xytext=offset, textcoords="offset points", ha=align,
                    fontsize=TEXT, color=SHADES[i], zorder=7)  # fmt: skip
    (x, y), (far, low) = (path_of(decoded[action], seconds, scenario)[-1] + [0, start] for action in (4, 8))
    look = {"textcoords": "offset points", "fontsize": TEXT, "zorder": 7}
    ax.annotate(f"dots: after {seconds} s", (x, y), xytext=(0, 7), ha="center", color=INK, **look)
    ax.annotate("right: leaves the road", (far, low), xytext=(8, -3), ha="left", color=SHADES[2], **look)
    for lane, words in enumerate(("left lane: 0", "middle lane: 1", "right lane: 2")):
        ax.text(right - 0.5, lane * width, words, ha="right", va="center", fontsize=SMALL, color=QUIET)
    top, bottom = edges_of(scenario.road)
    ax.set(xlim=(left, right), ylim=(bottom + 4.0, top - 0.4), aspect="equal")
    for side in ("top", "right", "left", "bottom"):
        ax.spines[side].set_visible(False)
    ax.set_yticks(np.arange(0, start + 0.1, 2))
    ax.tick_params(labelsize=SMALL, labelcolor=QUIET, length=3)
    ax.set_xlabel("distance along the road from the start (m)", fontsize=TEXT, color=INK)
    ax.set_ylabel("y, to the right (m)", fontsize=TEXT, color=INK)
    alt = f"Nine paths fan out from the ego in the right lane. After {seconds} s: {'; '.join(ends)}."
    least, most = (abs(path_of(decoded[action], seconds, scenario)[-1, 1]) for action in (0, 6))
    return finish(figure, f"In {seconds} s steering moves the car {least:.1f} to {most:.1f} m sideways", alt)


def worth_with_crashes(worths: Mapping[str, Worth]) -> Figure:
    """What each way is worth at γ = 0.8, crashes included and if they paid 0, in order of worth.

    worths: of `driving.worths`.
    """
    title = "The blind plan's crashes cost most of its worth, the agents' crashes little of theirs"
    colours = style("idle").colour, style("rule").colour, INK, style("sac").colour, style("bootstrapped").colour
    ways = sorted(zip(worths.items(), colours, strict=True), key=lambda each: each[0][1].worth)
    high, left, top = 0.42 * len(ways), 2.1, 1.15
    figure, says = new_figure(top + high + 0.6), []
    ax = axes_at(figure, left, top, 2.9, high)
    for row, ((name, way), colour) in enumerate(ways):
        ax.barh(row, way.unpaid, 0.6, color="white", edgecolor=colour, linewidth=1.2)
        ax.barh(row, way.worth, 0.6, color=colour, edgecolor=colour, linewidth=1.2)
        crashes = f"{100 * way.crashes:.0f}; {_when(way.seconds)}" if way.crashes else "none"
        for x, words in ((1.42, f"{way.worth:.2f}"), (1.62, crashes)):
            ax.text(x, row, words, fontsize=TEXT, color=colour, va="center")
        says.append(f"{name} {way.worth:.2f}, if crashes paid 0 {way.unpaid:.2f}, crashes: {crashes}")
    for x, words in ((1.42, "worth"), (1.62, "crashes on 100 roads")):
        ax.text(x, -0.72, words, fontsize=TEXT, color=QUIET, va="bottom")
    name_rows(ax, [name for (name, _), _ in ways], "worth at γ = 0.8, the mean of 100 roads")
    row, way = max(enumerate(way for (_, way), _ in ways), key=lambda each: each[1].unpaid - each[1].worth)
    middle = (way.worth + way.unpaid) / 2
    ax.text(middle, row, "if crashes paid 0", fontsize=SMALL, color=INK, ha="center", va="center")
    ax.axvline(worths["staying"].worth, color=colours[0], linestyle="--", linewidth=1.2, zorder=0)
    ax.set(xlim=(0, 1.36), xticks=(0, 0.5, 1))
    return finish(figure, title, f"A bar for what each way is worth, the least first. {'; '.join(says)}.")


def _when(seconds: np.ndarray) -> str:
    """When most of a way's crashes come, or else the first; seconds: of each, (crashes,)."""
    second, often = Counter(seconds.tolist()).most_common(1)[0]
    return f"{often} in second {second}" if often > len(seconds) / 2 else f"first in second {seconds.min()}"


def early_crashes(gaps: np.ndarray, early: np.ndarray) -> Figure:
    """Roads by how far ahead trap 2 starts (m), and on how many of them the blind plan crashes in second 5."""
    title = "The blind plan crashes in second 5 only where trap 2 starts close"
    figure, ax = one_axes(2.9, title, "how far ahead trap 2 starts (m, in steps of 0.2 m)", "held-out roads")
    edges = np.arange(4.0, gaps.max() + 0.2, 0.2)
    (all_roads, crashed), left = (np.histogram(each, edges)[0] for each in (gaps, gaps[early])), edges[:-1]
    look = {"width": 0.17, "align": "edge", "linewidth": 0}
    ax.bar(left + 0.015, crashed, color=INK, **look)
    ax.bar(left + 0.015, all_roads - crashed, bottom=crashed, color=REST, **look)
    ax.text(4.02, all_roads.max() + 9, f"dark: crashes in second 5 ({early.sum()} roads)", fontsize=TEXT, color=INK)
    ax.text(5.6, all_roads.max() + 9, "light: no crash in second 5", fontsize=TEXT, color=QUIET)
    ax.set(xlim=(3.95, edges[-1] + 0.05), ylim=(0, all_roads.max() + 17))
    each = ", ".join(f"{a:.1f} m {c} of {n}" for a, c, n in zip(left, crashed, all_roads, strict=True))
    return finish(figure, title, f"The roads on which it crashes in second 5, by where trap 2 starts: from {each}.")


def path_of(decoded: np.ndarray, seconds: int, scenario: Scenario = DEFAULT) -> np.ndarray:
    """(x, y) of the ego from (0, 0) while it holds an acceleration (m/s²) and a steering (rad): (steps + 1, 2)."""
    acceleration, steering = map(float, decoded)
    state, places = (0.0, 0.0, 0.0, scenario.ego.speed), [(0.0, 0.0)]
    for _ in range(seconds * scenario.clock.simulation_rate):
        state = bicycle_step(*state, acceleration, steering, scenario.car.length, scenario.clock.dt)
        places.append(state[:2])
    return np.array(places)


def what_they_learned(study: Results, plan: Episodes) -> Figure:
    """Each of the study's agents, without and with help, the rule, and a plan: return against accidents, same roads."""
    title = "Most of plain SAC's agents stay, and most with the rule's help escape"
    figure, ax = one_axes(4.2, title, "drives with an accident (%)", "return, the mean of 1,000 roads")
    listed = []
    for method in ("sac", "bootstrapped"):
        of, colour = study.of(method), style(method).colour
        crashes, earned = 100 * of.scores("accident"), of.scores("returns")
        inside = np.where(of.scores("success") >= ESCAPES, colour, "white")
        look = {"edgecolors": colour, "linewidths": 1.4, "zorder": in_front(method), "clip_on": False}
        ax.scatter(crashes, earned, 100 if method == "sac" else 42, inside, **look)
        each = ", ".join(
            f"{r:.0f} ({c:.0f} %)" for c, r in sorted(zip(crashes, earned, strict=True), key=lambda x: x[1])
        )
        listed.append(f"{METHODS[method].name} {each}")
    rule = report.rule_results(DEFAULT, study.sizes[0])
    drivers = (("the rule", rule.episodes, style("rule").colour), ("the blind plan", partial(getattr, plan), INK))
    for name, of, colour in drivers:
        crash, earned = 100 * (of("accident") > 0).mean(), of("returns").mean()
        ax.plot(crash, earned, "s", color=colour, markersize=7, zorder=4, clip_on=False)
        ax.annotate(name, (crash, earned), xytext=(8, -3), textcoords="offset points", fontsize=TEXT, color=colour)
        listed.append(f"{name} {earned:.0f} ({crash:.0f} %)")
    words = (
        (14, 124, "with the rule's help: 7 agents escape", "bootstrapped"),
        (8, 20, "plain SAC: 8 agents stay (7 circles lie together)", "sac"),
        (42, 75, "plain SAC: 1 escapes", "sac"), (97, -10, "plain SAC: 1 always crashes", "sac"),
        (97, 2, "with help: 2 always crash", "bootstrapped"), (64, 52, "with help: 1 often crashes", "bootstrapped"),
    )  # fmt: skip
    for x, y, text, method in words:
        ax.text(x, y, text, fontsize=TEXT, color=style(method).colour, ha="right" if x > 90 else "left")
    ax.text(100, 128, "filled: it escapes", fontsize=SMALL, color=QUIET, ha="right")
    ax.set(xlim=(-2, 102), ylim=(-20, 140))
    return finish(figure, title, f"Each one's return, and its drives with an accident. {'; '.join(listed)}.")
