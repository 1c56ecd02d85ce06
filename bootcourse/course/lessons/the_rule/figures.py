"""Figures of the rule: its speed, when it changes lane, and what its sight does."""

from collections.abc import Sequence

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from bootcourse.colours import ALARM
from bootcourse.course.lessons.the_rule.explorable import braking_distance, long_enough
from bootcourse.course.lessons.the_rule.rules import FastChanges, makes_way_at
from bootcourse.episodes.evaluate import Episodes
from bootcourse.episodes.rollout import Rollout
from bootcourse.episodes.words import overtaken
from bootcourse.methods import style
from bootcourse.plots.figure import INK, QUIET, TEXT, axes_at, finish, new_figure, one_axes, plain_axes
from bootcourse.road.state import EGO, LANE, SPEED, TRAP_1, TRAP_2, X
from bootcourse.rule import Reason, safety_distance
from bootcourse.scenario import DEFAULT


def when_to_change(drive: Rollout) -> Figure:
    """In the first lane, our condition and the printed one, each as what has to rise above what."""
    scenario, green = drive.scenario, style("rule").colour
    states = drive.states[: 1 + int(np.argmax(drive.states[:, EGO, LANE] != drive.states[0, EGO, LANE]))]
    seconds = np.arange(len(states)) * scenario.clock.dt
    v, slower = states[:, EGO, SPEED], np.minimum(states[:, TRAP_1, SPEED], states[:, TRAP_2, SPEED])
    ahead = states[:, TRAP_2, X] - states[:, EGO, X]
    gap, t_safe = ahead - scenario.car.length, scenario.rule.t_safe
    needed = np.array([safety_distance(a, b, b, t_safe, scenario.rule.floor) for a, b in zip(v, slower, strict=True)])
    printed, first = (v - slower) * t_safe, int(np.argmax(gap > needed))
    figure = new_figure(3.2)
    panels = (
        (
            "ours: true where green is above dashed (m)",
            (gap, "gap to trap 2,\nbumper to bumper", green),
            (needed, "safety distance"),
        ),
        (
            "printed: true where red is above dashed (m)",
            (printed, "closing\nspeed\n× t_safe", ALARM),
            (ahead, "distance"),
        ),
    )
    for column, (words, (has_to_rise, name, colour), (above, named)) in enumerate(panels):
        ax = axes_at(figure, 0.45 + 3.75 * column, 0.75, 2.1, 1.85)
        ax.plot(seconds, has_to_rise, color=colour, linewidth=2.5)
        ax.plot(seconds, above, color=INK, linewidth=2, linestyle="--")
        plain_axes(ax, words)
        ax.set(xlim=(0, seconds[-1]), ylim=(-5, 15), yticks=(-5, 0, 5, 10, 15))
        ax.set_xlabel("time (s)", fontsize=TEXT, color=INK)
        for values, text, look in ((has_to_rise, name, colour), (above, named, INK)):
            ax.text(seconds[-1] * 1.03, values[-1], text, color=look, fontsize=TEXT, va="center")
        if column == 0:
            ax.plot(seconds[first], gap[first], "o", color=colour, markersize=7)
            place = {"textcoords": "offset points", "ha": "right", "fontsize": TEXT, "color": colour}
            ax.annotate("room: change", (seconds[first], gap[first]), xytext=(-4, 10), **place)
    alt = (
        f"Over {seconds[-1]:g} s. Ours: the gap grows from {gap[0]:.1f} to {gap[-1]:.1f} m, above the safety distance "
        f"of {needed[first]:.1f} m from {seconds[first]:g} s on. Printed: the left side goes from {printed[0]:.1f} to "
        f"{printed[-1]:.1f} m, the right side from {ahead[0]:.1f} to {ahead[-1]:.1f} m: it is never true."
    )
    title = f"Ours is true from {seconds[first]:g} s on, the printed condition never"
    return finish(figure, title, alt)


def speed_over_time(drive: Rollout) -> Figure:
    """The rule's speed over a drive, with the traps' speed, and the time from which it is ahead of trap 1."""
    title = "The rule falls back, keeps the traps' speed, then slows down again and again"
    ahead, traps = overtaken(drive), drive.states[0, TRAP_1, SPEED]
    figure, ax = one_axes(2.4, title, "time (s)", "the rule's speed (m/s)")
    ax.plot(drive.times, drive.states[:, EGO, SPEED], color=style("rule").colour, linewidth=1.8)
    ax.axhline(traps, color=ALARM, linewidth=1, linestyle=(0, (4, 2)))
    ax.axvline(ahead, color=QUIET, linewidth=1, linestyle=(0, (4, 2)))
    ax.set(xlim=(0, drive.times[-1]), ylim=(7, 16), yticks=(8, 10, 12, 14))
    ax.text(drive.times[-1], traps - 0.2, "the traps' speed", fontsize=TEXT, color=ALARM, ha="right", va="top")
    ax.text(ahead + 1, 8.2, f"ahead of trap 1 after {ahead:.0f} s", fontsize=TEXT, color=QUIET, va="center")
    speeds = drive.states[drive.times > ahead, EGO, SPEED]
    return finish(
        figure, title, f"It falls to {drive.states[:, EGO, SPEED].min():g} m/s behind the traps, which drive {traps:g} "
        f"m/s. From {ahead:.0f} s on, ahead of trap 1, it rises and falls between {speeds.min():g} and "
        f"{speeds.max():g} m/s.",
    )  # fmt: skip


def speeds_by_sight(far: Rollout, near: Rollout) -> Figure:
    """Over one time axis: how far ahead the car is that the rule follows, and its speed, with a shorter sight, too."""
    title = "A slow car almost 200 m ahead holds the rule back"
    rule, steps, sight = style("rule").colour, far.scenario.clock.steps, far.scenario.sight.distance
    begins = int(np.argmax(far.rule_reasons == Reason.LEFTMOST)) * steps  # it follows one car from here on
    lane = (far.states[begins, :, LANE] == far.states[begins, EGO, LANE]) & (np.arange(far.states.shape[1]) != EGO)
    gaps = np.where(lane, far.states[begins, :, X] - far.states[begins, EGO, X], np.inf)
    followed = int(np.where(gaps > 0, gaps, np.inf).argmin())
    times, ahead = far.times[begins:], (far.states[:, followed, X] - far.states[:, EGO, X])[begins:]
    figure = new_figure(4.0)
    upper, lower = (axes_at(figure, 0.6, top, 6.2, height) for top, height in ((0.75, 1.1), (2.2, 1.3)))
    plain_axes(upper, "car that the rule follows, ahead by (m)")
    plain_axes(lower, "the rule's speed (m/s)")
    upper.plot(times, ahead, color=INK, linewidth=1.5)
    upper.plot(times, np.where(ahead > sight, ahead, np.nan), color=ALARM, linewidth=2.5)
    upper.axhline(sight, color=INK, linewidth=1.2, linestyle="--")
    upper.text(1, sight + 2, f"sight {sight:g} m", fontsize=TEXT, color=INK, va="bottom")
    upper.text(62, 216, "out of sight", fontsize=TEXT, color=ALARM, va="center", ha="center")
    upper.set(xlim=(0, 110), ylim=(140, 220), yticks=(150, 200), xticklabels=[])
    for drive, colour, width in ((far, QUIET, 1.3), (near, rule, 2.6)):
        lower.plot(drive.times, drive.states[:, EGO, SPEED], color=colour, linewidth=width)
    lower.set(xlim=(0, 110), ylim=(7, 17), yticks=(8, 10, 12, 14))
    lower.set_xlabel("time (s)", fontsize=TEXT, color=INK)
    lower.text(23, 9.0, "sight 200 m", fontsize=TEXT, color=QUIET, va="center")
    lower.text(17, 16.0, "sight 30 m", fontsize=TEXT, color=rule, va="center")
    moment = near.times[makes_way_at(near, followed)]
    lower.plot(moment, near.states[makes_way_at(near, followed), EGO, SPEED], "o", color=rule, markersize=7)
    lower.text(moment, 16.0, "the car ahead makes way", fontsize=TEXT, color=rule, va="center")
    out = np.flatnonzero(np.diff((ahead > sight).astype(int)) == 1)
    said = (
        f"{name}: ahead of trap 1 after {overtaken(drive):.0f} s, then {speeds.min():g} to {speeds.max():g} m/s"
        for name, drive in (("200 m", far), ("30 m", near))
        for speeds in [drive.states[drive.times > overtaken(drive), EGO, SPEED]]
    )
    alt = (
        f"Two drives on one road. The rule follows a car {ahead[0]:.0f} m ahead at {times[0]:g} s. From "
        f"{times[out[0] + 1]:g} s on this car leaves the sight of {sight:g} m again and again, and each time the speed "
        f"rises. {'; '.join(said)}. With a sight of 30 m the car ahead makes way at {moment:g} s."
    )
    return finish(figure, title, alt)


def crash_over_time(drive: Rollout) -> Figure:
    """Why a drive with a short sight crashes: how far ahead trap 1 is, and how much faster it is than trap 2.

    Marked: where it begins a lane change, calls it off and changes lane in the end.
    """
    scenario, green, steps = drive.scenario, style("rule").colour, drive.scenario.clock.steps
    ego, one, two = (drive.states[:, car] for car in (EGO, TRAP_1, TRAP_2))
    ahead, faster, sight = one[:, X] - ego[:, X], ego[:, SPEED] - two[:, SPEED], scenario.sight.distance
    given, (*_, safe) = drive.rule_reasons, long_enough(scenario.rule.t_safe)
    lost, changes = int(np.argmax(given == Reason.FREE)), np.flatnonzero(given == Reason.CHANGE)
    began, changed = int(changes[0]), int(changes[-1])
    figure, last = new_figure(3.3), drive.times[-1]

    def panel(left: float, words: str, limits: tuple[float, float]) -> Axes:
        ax = axes_at(figure, left, 0.75, 2.2, 1.95)
        plain_axes(ax, words)
        ax.set(xlim=(0, last), ylim=limits, xticks=range(0, 12, 3))
        ax.set_xlabel("time (s)", fontsize=TEXT, color=INK)
        return ax

    ax = panel(0.4, "trap 1 ahead (m)", (12, 28))
    ax.plot(drive.times, ahead, color=green, linewidth=2.5)
    unseen = (ahead > sight) & (drive.times >= lost)  # the rule looks once a second
    ax.plot(drive.times, np.where(unseen, ahead, np.nan), color=ALARM, linewidth=2.5)
    ax.plot(began, ahead[began * steps], "o", color=green, markersize=7)
    begins = f"{began} s: begins to\nchange lane"
    ax.text(began + 0.6, ahead[began * steps] - 0.6, begins, fontsize=TEXT, color=green, va="top")
    ax.axhline(sight, color=INK, linewidth=1.5, linestyle="--")
    ax.text(0.2, sight + 0.3, "sight", fontsize=TEXT, color=INK, va="bottom")
    out = f"{lost} s: out of sight, so it\nstays and speeds up"
    ax.text(lost - 0.6, ahead.max() + 0.9, out, fontsize=TEXT, color=ALARM, va="bottom")

    ax = panel(3.35, "faster than trap 2 (m/s)", (-3, 4))
    ax.plot(drive.times, faster, color=green, linewidth=2.5)
    ax.axhline(safe, color=INK, linewidth=1.5, linestyle="--")
    ax.text(
        last + 0.3,
        safe,
        f"above {safe:g} m/s\nthe asked gap is\ntoo short to\nbrake in",
        fontsize=TEXT,
        color=INK,
        va="center",
    )
    then = faster[changed * steps]
    ax.plot(changed, then, "o", color=ALARM, markersize=7)
    says = f"{changed} s: changes lane"
    ax.text(changed - 0.5, then + 0.2, says, fontsize=TEXT, color=ALARM, ha="right", va="center")
    title = f"It calls a lane change off at {lost} s, speeds up, and changes lane too fast at {changed} s"
    alt = (
        f"Trap 1 is {ahead[0]:.0f} m ahead at first and later up to {ahead.max():.0f} m, beyond the sight of "
        f"{sight:g} m. At {began} s a lane change begins. At {lost} s trap 1 is out of sight, and the car stays in its "
        f"lane and speeds up. At {changed} s it changes lane {then:.1f} m/s faster than trap 2; above {safe:g} m/s "
        f"it brakes in more than the gap that the rule asks for. At {last:g} s the drive ends in an accident."
    )
    return finish(figure, title, alt)


def tells_apart(changes: FastChanges) -> float:
    """The gap (m) in the middle between the longest of a drive that crashes and the shortest of one that gets out."""
    return float((changes.gap[changes.crashed].max() + changes.gap[~changes.crashed].min()) / 2)


def room_to_brake(changes: FastChanges) -> Figure:
    """A dot for each fast lane change: the gap in which it begins, and whether the drive crashes."""
    crashed, asked = changes.crashed, DEFAULT.rule.t_safe * changes.faster.min()
    takes, split, green = braking_distance(changes.faster.min()), tells_apart(changes), style("rule").colour
    title = f"3 m/s faster: with less than {split:.2f} m all {crashed.sum()} crash, "
    title += f"with more all {(~crashed).sum()} get out"
    figure, ax = one_axes(2.9, title, "gap to trap 2 when the lane change begins, from bumper to bumper (m)", "", 0.87)
    rows = (crashed, 1, ALARM, "X", f"{crashed.sum()} crash"), (~crashed, 0, green, "o", f"{(~crashed).sum()} get out")
    for which, row, colour, marker, words in rows:
        gaps = np.sort(changes.gap[which])
        heights = row + 0.09 * (np.arange(len(gaps)) % 5 - 2)  # one above the other, so that none hides another
        ax.scatter(gaps, heights, c=colour, marker=marker, s=42, edgecolors="white", linewidths=0.5, zorder=3)
        ax.text(gaps[0] - 0.04, row, words, color=colour, fontsize=TEXT, ha="right", va="center")
    for gap, words, side in (
        (asked, f"the rule asks for {asked:.1f} m ", "left"),
        (takes, f" braking straight on takes {takes:.2f} m", "left"),
    ):
        ax.axvline(gap, color=INK, linewidth=1.2, linestyle="--", zorder=1)
        ax.text(gap + 0.01, 1.62, words.strip(), fontsize=TEXT, color=INK, ha=side, va="center")
    ax.set(xlim=(4.2, 5.9), ylim=(-0.5, 1.85), yticks=[])
    alt = (
        f"{len(crashed)} drives. Those that crash began the lane change with {changes.gap[crashed].min():.2f} to "
        f"{changes.gap[crashed].max():.2f} m, those that get out with {changes.gap[~crashed].min():.2f} to "
        f"{changes.gap[~crashed].max():.2f} m. The rule asks for {asked:.1f} m; braking straight on takes "
        f"{takes:.2f} m."
    )
    return finish(figure, title, alt)


def against_sight(sights: Sequence[float], driven: Sequence[Episodes]) -> Figure:
    """The rule's mean return against how far it sees (m); a red cross where it has accidents."""
    safe = min(sight for sight, each in zip(sights, driven, strict=True) if not each.accident.any())
    title = f"The return grows as the sight shrinks to {safe:g} m; at {min(sights):g} m drives crash"
    returns = np.array([each.returns.mean() for each in driven])
    crashed = np.array([np.mean(each.accident > 0) for each in driven])
    figure, ax = one_axes(3.2, title, "how far the rule sees (m)", "return of an episode")
    ax.plot(sights, returns, "o-", color=style("rule").colour, linewidth=2, markersize=5)
    apart = [sight for sight in sights if sight != safe]  # its number stands at its point
    ax.set(xlim=(0, 1.04 * max(sights)), ylim=(0, 1.2 * returns.max()), xticks=apart)
    words = {"textcoords": "offset points", "fontsize": TEXT}
    for x, y, each in zip(sights, returns, driven, strict=True):
        crashes = np.sum(each.accident > 0)
        if x == safe:
            ax.annotate(f"{x:g} m: {y:.0f}", (x, y), (-8, 2), ha="right", color=INK, **words)
        elif not crashes:
            ax.annotate(f"{y:.0f}", (x, y), (0, 8), ha="center", color=INK, **words)
        else:
            ax.plot(x, y, "X", color=ALARM, markersize=9, zorder=3)
            ends = f"{y:.0f}: of {len(each.success)} drives\n{each.success.sum()} get out, {crashes} crash"
            ax.annotate(ends, (x, y), (10, -18), color=ALARM, **words)
    listed = (f"{x:g} m: {y:.0f}, {share:.0%}" for x, y, share in zip(sights, returns, crashed, strict=True))
    return finish(figure, title, f"Sight, return and share of roads with an accident: {'; '.join(listed)}.")
