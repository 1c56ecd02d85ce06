"""Figures of the lesson on traffic: a jam over time, how IDM follows, when MOBIL changes lane, how steering swings.

Each draws what it is given, or one formula of `bootcourse.road.formulas`.
"""

from collections.abc import Sequence

import numpy as np
from matplotlib.figure import Figure

from bootcourse.colours import ALARM
from bootcourse.plots.figure import INK, QUIET, SMALL, TEXT, finish, label_ends, new_figure, plain_axes
from bootcourse.road.formulas import desired_gap, idm_acceleration, mobil_incentive
from bootcourse.scenario import DEFAULT, Traffic

LINES = (("#0072B2", "-"), ("#444444", "--"), ("#D55E00", "-."))  # colour and line, first to last
FAST = 12.5  # m/s, the bright end of the colours


def space_time(drives: dict[str, tuple[np.ndarray, np.ndarray]], dt: float, title: str) -> Figure:
    """Where each car of a ring is over time, coloured by its speed; one panel for each named ring.

    drives: name -> (places (m), speeds (m/s)), both (steps, cars); dt: seconds between two steps.
    """
    figure = new_figure(3.9)
    told, width = [], 0.78 / len(drives)
    for k, (name, (places, speeds)) in enumerate(drives.items()):
        ax = figure.add_axes((0.08 + k * (width + 0.04), 0.15, width - 0.02, 0.62))
        seconds = np.arange(len(places)) * dt
        dots = ax.scatter(
            np.repeat(seconds, places.shape[1]), places.ravel(), c=speeds.ravel(), s=0.5, cmap="viridis", vmin=0,
            vmax=FAST, linewidths=0, rasterized=True,
        )  # fmt: skip
        plain_axes(ax, f"place on the ring (m): {name}", grid="")
        ax.set_xlim(0, seconds[-1])
        ax.set_xlabel("time (s)", fontsize=TEXT, color=INK)
        last = speeds[-1]
        told.append(f"{name}: at the end the slowest car drives {last.min():.1f} m/s, the fastest {last.max():.1f}")
    bar = figure.colorbar(dots, cax=figure.add_axes((0.925, 0.15, 0.015, 0.62)))
    bar.outline.set_visible(False)
    bar.ax.tick_params(labelsize=SMALL, labelcolor=QUIET, length=0)
    bar.ax.set_title("m/s", fontsize=SMALL, color=INK, loc="left")
    return finish(figure, title, f"Each line is one car, dark where it is slow. {'; '.join(told)}.")


def following(v: float, closing: Sequence[float], title: str, traffic: Traffic = DEFAULT.traffic) -> Figure:
    """IDM's acceleration at speed v (m/s) against the gap, closing in at several speeds (m/s)."""
    figure = new_figure(3.6)
    ax = figure.add_axes((0.08, 0.16, 0.68, 0.62))
    gaps, ends, told = np.linspace(8, 120, 300), [], []
    for dv, (colour, line) in zip(closing, LINES, strict=False):
        s_star = desired_gap(v, dv, traffic.s0, traffic.time_gap, traffic.a_max, traffic.b)
        values = [idm_acceleration(v, traffic.desired_speed, s, s_star, traffic.a_max, traffic.delta) for s in gaps]
        ax.plot(gaps, np.maximum(values, -3), color=colour, linestyle=line, linewidth=1.8)
        words = f"closing in at {dv:g} m/s" if dv > 0 else (f"falling back at {-dv:g} m/s" if dv < 0 else "same speed")
        ends.append((float(values[-1]), f"{words}, s* = {s_star:.0f} m", colour))
        told.append(f"{words}: zero at a gap of {np.interp(0, values, gaps):.0f} m")
    ax.axhline(0, color=QUIET, linewidth=1)
    plain_axes(ax, "acceleration (m/s²)")
    ax.set_ylim(-3, 0.6)
    ax.set_xlim(0, 120)
    ax.set_xlabel("gap to the car ahead, centre to centre (m)", fontsize=TEXT, color=INK)
    label_ends(ax, ends)
    return finish(figure, title, f"Three curves that rise with the gap from hard braking. {'; '.join(told)}.")


def changing(own_gain: float, follower, politeness: Sequence[float], traffic: Traffic = DEFAULT.traffic) -> Figure:
    """MOBIL's incentive against the gap to the new follower, for several degrees of politeness.

    own_gain (m/s²); follower(gap) -> (acceleration before, after) of the new follower (m/s²).
    """
    figure = new_figure(3.6)
    ax = figure.add_axes((0.08, 0.16, 0.72, 0.62))
    gaps = np.linspace(8, 100, 300)
    before, after = np.array([follower(gap) for gap in gaps]).T
    ends, told = [], []
    for p, (colour, line) in zip(politeness, LINES, strict=False):
        values = np.array([mobil_incentive(own_gain, gain, 0.0, p) for gain in after - before])
        ax.plot(gaps, values, color=colour, linestyle=line, linewidth=1.8)
        ends.append((float(values[-1]), f"p = {p:g}", colour))
        allowed = gaps[(values >= traffic.a_threshold) & (after >= -traffic.safe_braking)]
        told.append(f"p = {p:g}: changes from {allowed[0]:.0f} m on" if len(allowed) else f"p = {p:g}: never changes")
    unsafe = gaps[after < -traffic.safe_braking]
    if len(unsafe):
        ax.axvspan(gaps[0], unsafe[-1], color=ALARM, alpha=0.12, linewidth=0)
        ax.text(gaps[0] + 0.4, 0.45, "not safe", fontsize=TEXT, color=ALARM, va="top")
    ax.axhline(traffic.a_threshold, color=QUIET, linewidth=1, linestyle=":")
    ax.text(gaps[0] + 0.4, traffic.a_threshold - 0.03, "threshold", fontsize=SMALL, color=QUIET, va="top")
    plain_axes(ax, "incentive (m/s²)")
    ax.set_ylim(-1.2, 0.5)
    ax.set_xlim(gaps[0], gaps[-1])
    ax.set_xlabel("gap to the new follower, centre to centre (m)", fontsize=TEXT, color=INK)
    label_ends(ax, ends)
    return finish(figure, "The more polite the driver, the larger the gap that it waits for", f"{'; '.join(told)}.")


def swinging(taus: Sequence[float], dt: float, seconds: float = 5.0) -> Figure:
    """A heading error of 1, step by step, for several time constants (s) at a time step dt (s)."""
    figure = new_figure(3.4)
    ax = figure.add_axes((0.08, 0.17, 0.68, 0.58))
    steps = np.arange(int(seconds / dt) + 1)
    ends, told = [], []
    for tau, (colour, line) in zip(taus, LINES, strict=False):
        factor = 1 - dt / tau
        shown = (factor**steps)[np.abs(factor**steps) < 12]
        ax.plot(steps[: len(shown)] * dt, shown, "o", color=colour, linestyle=line, linewidth=1.5, markersize=4)
        kind = "grows" if abs(factor) > 1 else ("overshoots, then settles" if factor < 0 else "settles")
        words = f"τ = {tau:g} s: times {factor:.2f}, {kind}".replace("-", "−")
        ends.append((float(np.clip(shown[-1], -7, 7)), words, colour))
        told.append(words)
    ax.axhline(0, color=QUIET, linewidth=1)
    plain_axes(ax, "heading error (its start is 1)")
    ax.set_ylim(-8, 8)
    ax.set_xlim(0, seconds)
    ax.set_xlabel("time (s)", fontsize=TEXT, color=INK)
    label_ends(ax, ends)
    title = f"At {1 / dt:g} Hz a controller that is too quick throws the car from side to side"
    return finish(figure, title, f"Heading errors over {seconds:g} s, multiplied at each step. {'; '.join(told)}.")
