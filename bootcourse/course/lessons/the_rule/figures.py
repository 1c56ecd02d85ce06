"""Figures of the rule: when it changes lane, and its reasons."""

import numpy as np
from matplotlib.figure import Figure

from bootcourse.colours import ALARM, Style
from bootcourse.course.charts import lines
from bootcourse.episodes.rollout import Rollout
from bootcourse.episodes.words import sentence
from bootcourse.methods import style
from bootcourse.plots.figure import INK, TEXT, finish, new_figure, plain_axes
from bootcourse.road.state import EGO, LANE, SPEED, TRAP_1, TRAP_2, X
from bootcourse.rule import SENTENCES, Reason, safety_distance


def when_to_change(drive: Rollout) -> Figure:
    """The gap to trap 2, the safety distance, and what the printed condition compares with 0, in the first lane."""
    scenario = drive.scenario
    states = drive.states[: 1 + int(np.argmax(drive.states[:, EGO, LANE] != drive.states[0, EGO, LANE]))]
    seconds = np.arange(len(states)) * scenario.clock.dt
    v, slower = states[:, EGO, SPEED], np.minimum(states[:, TRAP_1, SPEED], states[:, TRAP_2, SPEED])
    ahead = states[:, TRAP_2, X] - states[:, EGO, X]
    gap, t_safe = ahead - scenario.car.length, scenario.rule.t_safe
    needed = np.array([safety_distance(a, b, b, t_safe, scenario.rule.floor) for a, b in zip(v, slower, strict=True)])
    printed = (v - slower) * t_safe - ahead
    named = {
        "gap to trap 2, bumper to bumper": gap,
        "safety distance": needed,
        "printed condition: change when above 0": printed,
    }
    first = int(np.argmax(gap > needed))
    alt = (
        f"Over {seconds[-1]:g} s the gap grows from {gap[0]:.1f} to {gap[-1]:.1f} m and exceeds the safety distance of "
        f"{needed[first]:.1f} m at {seconds[first]:g} s. The printed condition falls from {printed[0]:.1f} to "
        f"{printed[-1]:.1f} m: it never rises above 0."
    )
    title = "The gap grows past the safety distance; the printed condition only falls"
    rule, looks = style("rule").colour, (style("rule")._replace(line="-"), Style(INK, "--"), Style(ALARM, "-."))
    figure = lines(seconds, named, title, "time (s)", "metres", marks={"": 0.0}, looks=looks, alt=alt)
    figure.axes[0].plot(seconds[first], gap[first], "o", color=rule, markersize=7)
    place = {"textcoords": "offset points", "ha": "right", "fontsize": TEXT, "color": rule}
    figure.axes[0].annotate("room: change", (seconds[first], gap[first]), xytext=(-8, 10), **place)
    return figure


def reasons_over_time(rollout: Rollout, title: str) -> Figure:
    """What the rule gives as its reason at each decision of a drive."""
    figure = new_figure(2.6)
    ax = figure.add_axes((0.34, 0.2, 0.63, 0.6))
    rate = rollout.scenario.clock.decision_rate
    used = [reason for reason in Reason if (rollout.rule_reasons == reason).any()]
    for row, reason in enumerate(used):
        decisions = np.flatnonzero(rollout.rule_reasons == reason)
        ax.broken_barh([(k / rate, 1 / rate) for k in decisions], (row - 0.35, 0.7), color=style("rule").colour)
    ax.set_yticks(range(len(used)), [sentence(SENTENCES[reason]) for reason in used])
    ax.invert_yaxis()
    plain_axes(ax, "", grid="x")
    ax.tick_params(axis="y", labelcolor=INK)
    ax.set_xlabel("time (s)", fontsize=TEXT, color=INK)
    shares = ", ".join(f"{SENTENCES[r]} {np.mean(rollout.rule_reasons == r):.0%}" for r in used)
    return finish(figure, title, f"Share of the decisions: {shares}.")
