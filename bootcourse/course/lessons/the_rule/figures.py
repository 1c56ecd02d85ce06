"""Figures of the rule: when it changes lane, its reasons, and why it is slow."""

from collections.abc import Sequence

import numpy as np
from matplotlib.figure import Figure

from bootcourse.colours import ALARM, Style
from bootcourse.course.charts import lines
from bootcourse.episodes.evaluate import Episodes
from bootcourse.episodes.rollout import Rollout
from bootcourse.episodes.words import sentence
from bootcourse.methods import style
from bootcourse.plots.figure import INK, QUIET, TEXT, axes_at, finish, new_figure, one_axes, plain_axes
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


def reasons_over_time(rollout: Rollout, title: str, enlarged: float = 15.0) -> Figure:
    """What the rule gives as its reason at each decision; the first seconds are drawn wider than the others."""
    rate, reasons = rollout.scenario.clock.decision_rate, rollout.rule_reasons
    used = [Reason(reason) for reason in dict.fromkeys(reasons.tolist())]  # in the order in which they come
    height = 0.3 * len(used)
    figure = new_figure(height + 1.2)
    for left, first, last, part, step in (
        (2.45, 0, enlarged, f"the first {enlarged:g} s", 5),
        (4.75, enlarged, rollout.times[-1], "the rest", 45),
    ):
        ax = axes_at(figure, left, 0.65, 2.1, height)
        for row, reason in enumerate(used):
            bars = [(k / rate, 1 / rate) for k in np.flatnonzero(reasons == reason)]
            ax.broken_barh(bars, (row - 0.35, 0.7), color=style("rule").colour)
        ax.set_yticks(range(len(used)), [sentence(SENTENCES[reason]) for reason in used] if first == 0 else [])
        ax.set(xlim=(first, last), ylim=(len(used) - 0.5, -0.5))
        plain_axes(ax, "", grid="x")
        ax.tick_params(axis="y", labelcolor=INK, labelsize=TEXT)
        ax.set_xticks(np.arange(first, last + 1, step))
        ax.set_xlabel(f"time (s): {part}", fontsize=TEXT, color=INK)
    shares = ", ".join(f"{SENTENCES[r]} {np.mean(reasons == r):.0%}" for r in used)
    return finish(figure, title, f"Share of the decisions: {shares}.")


def against_sight(sights: Sequence[float], driven: Sequence[Episodes]) -> Figure:
    """The rule's mean return against how far it sees (m); a red cross where it has accidents."""
    title = "A shorter sight more than doubles the rule's return; at 20 m drives crash"
    returns = np.array([each.returns.mean() for each in driven])
    crashed = np.array([np.mean(each.accident > 0) for each in driven])
    figure, ax = one_axes(3.2, title, "how far the rule sees (m)", "return of an episode")
    ax.plot(sights, returns, "o-", color=style("rule").colour, linewidth=2, markersize=5)
    ax.set_ylim(0, 1.2 * returns.max())
    words = {"textcoords": "offset points", "fontsize": TEXT}
    for x, y, each in zip(sights, returns, driven, strict=True):
        crashes = np.sum(each.accident > 0)
        if not crashes:
            ax.annotate(f"{y:.0f}", (x, y), (0, 8), ha="center", color=INK, **words)
        else:
            ax.plot(x, y, "X", color=ALARM, markersize=9, zorder=3)
            ends = f"{y:.0f}: of {len(each.success)} drives\n{each.success.sum()} get out, {crashes} crash"
            ax.annotate(ends, (x, y), (10, -18), color=ALARM, **words)
    listed = (f"{x:g} m: {y:.0f}, {share:.0%}" for x, y, share in zip(sights, returns, crashed, strict=True))
    return finish(figure, title, f"Sight, return and share of roads with an accident: {'; '.join(listed)}.")


def speed_and_distance(drive: Rollout, title: str, first: int = 30) -> Figure:
    """From a second on: the rule's speed, and the next car ahead in its lane, with a line where its sight ends."""
    sight, steps = drive.scenario.sight.distance, drive.scenario.clock.steps
    states = drive.states[first * drive.scenario.clock.decision_rate * steps :: steps]
    seconds, distances = first + np.arange(len(states)) / drive.scenario.clock.decision_rate, []
    for cars in states:
        ahead = cars[(cars[:, LANE] == cars[EGO, LANE]) & (cars[:, X] > cars[EGO, X]), X]
        distances.append(ahead.min() - cars[EGO, X] if len(ahead) else np.nan)
    figure, colour = new_figure(4.0), style("rule").colour
    speed, distance = axes_at(figure, 0.6, 0.75, 6.2, 1.1), axes_at(figure, 0.6, 2.3, 6.2, 1.2)
    for ax, label, values in (
        (speed, "speed (m/s)", states[:, EGO, SPEED]),
        (distance, "next car ahead (m)", distances),
    ):
        ax.plot(seconds, values, color=colour, linewidth=1.8)
        plain_axes(ax, label)
        ax.set_xlim(first, seconds[-1])
    distance.set_ylim(0.93 * sight, 1.05 * sight)
    distance.axhline(sight, color=QUIET, linewidth=1, linestyle=(0, (4, 2)))
    distance.text(seconds[-1], 1.03 * sight, f"its sight ends, {sight:g} m", fontsize=TEXT, color=QUIET, ha="right")
    distance.set_xlabel("time (s)", fontsize=TEXT, color=INK)
    seen = np.nanmedian(distances)
    return finish(figure, title, f"From {first} s on the next car is at a median distance of {seen:.0f} m.")
