"""Figures of the lesson on traffic: a jam over time, how IDM follows, cars in a row, how steering swings.

Each draws what it is given, or one formula of `bootcourse.road.formulas`.
"""

from collections.abc import Sequence

import numpy as np
from matplotlib import colormaps
from matplotlib.collections import LineCollection
from matplotlib.colors import ListedColormap
from matplotlib.figure import Figure

from bootcourse.colours import Style
from bootcourse.course.charts import lines
from bootcourse.plots.figure import INK, QUIET, SMALL, TEXT, finish, new_figure, one_axes, plain_axes
from bootcourse.road.formulas import desired_gap, idm_acceleration
from bootcourse.scenario import DEFAULT, Traffic

LOOKS = (Style("#7C8793"), Style("#1F2933", "--"), Style("#7A1F1F", "-."))  # of the lines; no method's colours
DRIVERS = {  # those of a row that are drawn: colour, and where their words stand at their lowest speed
    1: ("#7C8793", "right", (0, -14)),
    4: ("#7A1F1F", "center", (-4, -24)),
    8: ("#1F2933", "left", (0, -14)),
}
SPEEDS = ListedColormap(colormaps["viridis"](np.linspace(0, 0.85, 256)))  # its bright end cannot be seen on white
FAST = 12.5  # m/s, the bright end of the colours
SWING = 3.6  # times its start: where a growing error leaves the picture


def space_time(drives: dict[str, tuple[np.ndarray, np.ndarray]], dt: float, title: str) -> Figure:
    """Where each car of a ring is over time, coloured by its speed; one panel for each named ring.

    drives: name -> (places (m), speeds (m/s)), both (steps, cars); dt: seconds between two steps.
    """
    figure = new_figure(3.9)
    alt_parts, width = [], 0.78 / len(drives)
    for k, (name, (places, speeds)) in enumerate(drives.items()):
        ax = figure.add_axes((0.08 + k * (width + 0.04), 0.15, width - 0.02, 0.62))
        seconds = np.arange(len(places)) * dt
        length = places.max() - places.min()
        points = np.stack([np.broadcast_to(seconds[:, None], places.shape), places], axis=-1)
        pieces = np.stack([points[:-1], points[1:]], axis=2)  # (steps - 1, cars, 2 ends, 2)
        goes_on = np.abs(np.diff(places, axis=0)) < length / 2  # the others jump from the ring's end to its start
        goes_on[:, 1::2] = False  # lines of all cars would lie too close
        colours = LineCollection(pieces[goes_on], array=speeds[1:][goes_on], cmap=SPEEDS, linewidths=0.9)
        colours.set(clim=(0, FAST), rasterized=True)
        dots = ax.add_collection(colours)
        ax.set_ylim(places.min(), places.max())
        plain_axes(ax, f"place on the ring (m): {name}", grid="")
        ax.set_xlim(0, seconds[-1])
        ax.set_xlabel("time (s)", fontsize=TEXT, color=INK)
        last = speeds[-1]
        alt_parts.append(
            f"{name}: at the end the slowest car drives {last.min():.1f} m/s, the fastest {last.max():.1f}"
        )
    bar = figure.colorbar(dots, cax=figure.add_axes((0.925, 0.15, 0.015, 0.62)))
    bar.outline.set_visible(False)
    bar.ax.tick_params(labelsize=SMALL, labelcolor=QUIET, length=0)
    bar.ax.set_title("m/s", fontsize=SMALL, color=INK, loc="left")
    drawn = "Each line is one car, coloured by its speed; half of the cars are drawn"
    return finish(figure, title, f"{drawn}. {'; '.join(alt_parts)}.")


def following(v: float, title: str, traffic: Traffic = DEFAULT.traffic) -> Figure:
    """IDM's acceleration at speed v (m/s) against the gap: closing in at 2 m/s, at the same speed, falling back."""
    gaps, alt_parts = np.linspace(8, 120, 300), []
    x_label, y_label = "gap to the car ahead, centre to centre (m)", "acceleration (m/s²)"
    figure, ax = one_axes(3.6, title, x_label, y_label)
    named = {-2: "falling back at 2 m/s", 0: "same speed", 2: "closing in at 2 m/s"}
    for look, (dv, words) in zip(LOOKS, named.items(), strict=True):
        s_star = desired_gap(v, dv, traffic.s0, traffic.time_gap, traffic.a_max, traffic.b)
        values = [idm_acceleration(v, traffic.desired_speed, s, s_star, traffic.a_max, traffic.delta) for s in gaps]
        ax.plot(gaps, np.maximum(values, -traffic.braking_limit), color=look.colour, linestyle=look.line, linewidth=2)
        if min(values) > 0:
            ax.text(gaps[-1], 0.5, words, fontsize=TEXT, color=look.colour, ha="right")
            alt_parts.append(f"{words}: above zero at each gap")
            continue
        holds = np.interp(0, values, gaps)
        does = "brakes below" if dv else "settles at"  # who closes in does not stay at this gap
        ax.plot(holds, 0, "o", color=look.colour)
        ax.text(holds, 0.5, f"{words},\n{does} {holds:.0f} m", fontsize=TEXT, color=look.colour, ha="center")
        alt_parts.append(f"{words}: zero at a gap of {holds:.0f} m")
    ax.axhline(0, color=QUIET, linewidth=1, linestyle=(0, (2, 2)), zorder=1)
    ax.set(xlim=(gaps[0], gaps[-1]), ylim=(-1.05 * traffic.braking_limit, 1.4))
    alt_parts.append(f"no driver brakes harder than {traffic.braking_limit:g} m/s²")
    return finish(figure, title, f"Three curves that rise with the gap. {'; '.join(alt_parts)}.")


def row(leader: np.ndarray, drivers: Sequence[np.ndarray], dt: float, title: str) -> Figure:
    """Speeds (m/s) of a leader and of some of the drivers behind it, each with its lowest speed written below it."""
    seconds, alt_parts = dt * np.arange(len(leader)), []
    figure, ax = one_axes(3.6, title, "time (s)", "speed (m/s)")
    ax.plot(seconds, leader, color="#444444", linestyle="--", linewidth=1.5)
    ax.text(seconds[np.argmin(leader)] - 2, leader.min() + 0.5, "leader", fontsize=TEXT, color="#444444", ha="right")
    for k, (colour, side, offset) in DRIVERS.items():
        speeds = drivers[k - 1]
        ax.plot(seconds, speeds, color=colour, linewidth=2)
        words, lowest = f"driver {k}: {speeds.min():.1f} m/s", (seconds[np.argmin(speeds)], speeds.min())
        ax.annotate(words, lowest, offset, textcoords="offset points", ha=side, fontsize=TEXT, color=colour)
        alt_parts.append(words)
    ax.set(xlim=(seconds[0], seconds[-1]), ylim=(min(v.min() for v in drivers) - 1.1, 11.5))
    return finish(figure, title, f"The leader brakes to {leader.min():g} m/s. Lowest speeds: {'; '.join(alt_parts)}.")


def swinging(taus: Sequence[float], dt: float, seconds: float = 5.0) -> Figure:
    """A heading error of 1, step by step, for several time constants (s) at a time step dt (s)."""
    steps, named = np.arange(int(seconds / dt) + 1), {}
    for tau in taus:
        factor = 1 - dt / tau
        settles = "overshoots, then settles" if factor < 0 else "settles"
        kind = "grows and leaves the picture" if abs(factor) > 1 else settles
        words = f"τ = {tau:g} s: times {factor:.2f}, {kind}".replace("-", "−")
        named[words] = np.where(np.abs(factor**steps) < 1.2 * SWING, factor**steps, np.nan)
    title = f"At {1 / dt:g} Hz a controller that is too quick throws the car from side to side"
    alt = f"Heading errors over {seconds:g} s, multiplied at each step. {'; '.join(named)}."
    look = {"marks": {"": 0.0}, "limits": (-SWING, SWING), "looks": [each._replace(marker="o") for each in LOOKS]}
    return lines(steps * dt, named, title, "time (s)", "heading error (its start is 1)", **look, alt=alt)
