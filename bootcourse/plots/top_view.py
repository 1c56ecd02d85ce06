"""The road from above, at several moments below each other.

Everything is drawn in metres and to scale. The ego stands at 0 and the road moves past it; what is too far away to be
drawn is named at the edge.
"""

from collections.abc import Sequence

import numpy as np
from matplotlib.figure import Figure

from bootcourse.colours import ALARM, EDGE
from bootcourse.episodes.rollout import Rollout
from bootcourse.episodes.words import cars_at, doing, outcome, overtaken, sentence
from bootcourse.errors import BootcourseError
from bootcourse.methods import display_name, style
from bootcourse.plots.canvas import MplAxes
from bootcourse.plots.figure import INK, QUIET, SMALL, TEXT, WIDTH, axes_at, finish, new_figure
from bootcourse.plots.road import draw_cars, draw_road, edges_of
from bootcourse.road.state import EGO, LANE, SPEED, TRAP_1, TRAP_2, X, Y

NEAR, FAR, SPAN = 16.0, 70.0, 84.0  # m; least behind the ego, most to either side, least in all
CLEAR = 15.0  # m; so far ahead of trap 1 the escape is over
TRAIL = 3.0  # s of the ego's own path behind it


def draw_moment(
    ax, rollout: Rollout, time: float, left: float, right: float, origin: float | None = None, colour: str = ""
) -> None:
    """The road and its cars at a time; x is in metres from `origin`, a place on the road (None: the ego).

    colour: of the ego; its label's own if there is none.
    """
    canvas, cars, scenario = MplAxes(ax), cars_at(rollout, time), rollout.scenario
    origin, colour = cars[EGO, X] if origin is None else origin, colour or style(rollout.label).colour
    draw_road(canvas, scenario, left, right, origin)
    top, bottom = edges_of(scenario.road)
    ax.set(xlim=(left, right), ylim=(bottom + 0.4, top - 0.4), aspect="equal")
    trail = np.array([cars_at(rollout, t)[EGO, [X, Y]] for t in np.arange(max(0.0, time - TRAIL), time + 1e-9, 0.25)])
    size = (scenario.car.length / 2 + 1, scenario.car.width / 2 + 0.4)  # m, a car and a little more
    under = np.flatnonzero((np.abs(trail[:, None] - cars[1:, [X, Y]]) < size).all(axis=2).any(axis=1))
    trail = trail[under[-1] + 1 :] if len(under) else trail  # another car stands there by now
    canvas.line(trail[:, 0] - origin, trail[:, 1], colour, 2, opacity=0.35)
    draw_cars(canvas, cars, scenario, colour, left, right, origin, trail=trail)
    if rollout.accident and time > rollout.times[-1] - 1e-9:
        x, y = cars[EGO, X] - origin, cars[EGO, Y]
        ax.plot(x, y, marker="X", markersize=12, color=ALARM, markeredgecolor="white", zorder=8, gid="accident")


def window(rollout: Rollout, times: Sequence[float]) -> tuple[float, float]:
    """The stretch of road (m from the ego) that shows both traps at all these times, or as far as FAR."""
    ahead = [cars_at(rollout, t)[[TRAP_1, TRAP_2], X] - cars_at(rollout, t)[EGO, X] for t in times]
    left, right = min(-NEAR, np.min(ahead) - 5), np.max(ahead) + 14
    left, right = max(left, -FAR), min(right, FAR)
    return left, max(right, left + SPAN)


def top_view_over_time(rollout: Rollout, times: Sequence[float] | None = None, title: str | None = None) -> Figure:
    """The road at several moments (s), one below the other, all following the ego.

    times: None for the moments that matter in this drive (`key_moments`). A moment after the end of
    the drive becomes its end. Raises BootcourseError if there is none, or a negative one.
    """
    times = key_moments(rollout) if times is None else _within(rollout, times)
    left, right = window(rollout, times)
    margin, scenario = 1.3, rollout.scenario
    width = WIDTH - margin - 0.15
    row = (scenario.road.lanes * scenario.road.lane_width + 0.8) * width / (right - left)
    gap, head, foot = 0.09, 0.42, 0.46
    total = head + len(times) * (row + gap) + foot
    figure = new_figure(total)
    for i, time in enumerate(times):
        top = head + i * (row + gap) + gap
        ax = axes_at(figure, margin, top, width, row)
        draw_moment(ax, rollout, time, left, right)
        ax.set_yticks([])
        _metres(ax, last=i == len(times) - 1)
        cars = cars_at(rollout, time)
        if i == 0:
            _name_ego(ax, rollout, cars)
        over = rollout.accident and time > rollout.times[-1] - 1e-9
        lines = (
            (0.2, f"{time:.3g} s", {"fontsize": 10.5, "fontweight": "bold", "color": INK}),
            (0.02, doing(rollout, time), {"fontsize": SMALL, "color": ALARM if over else INK}),
            (-0.14, f"{cars[EGO, SPEED]:.1f} m/s", {"fontsize": SMALL, "color": QUIET}),
        )
        for higher, text, letters in lines:
            figure.text(0.012, 1 - (top + row / 2 - higher) / total, text, va="center", **letters)
    story = "; ".join(f"at {t:.3g} s: {doing(rollout, t)}, {_gap_in_words(rollout, t)}" for t in times)
    words = sentence(f"{display_name(rollout.label)}: {outcome(rollout)}")
    return finish(figure, title or words, f"The road from above at {len(times)} moments. {sentence(story)}.")


def key_moments(rollout: Rollout, most: int = 6) -> list[float]:
    """The moments that tell this drive: its start, each new lane, its farthest back, its passing, its accident.

    Where nothing of the kind happens, moments at even distances. Never more than `most`, 1 s apart or more.
    """
    states, times, end = rollout.states, rollout.times, float(rollout.times[-1])
    passes, ahead = overtaken(rollout), states[:, EGO, X] - states[:, TRAP_1, X]
    clear = times[ahead > CLEAR]
    until = float(min(clear[clear >= passes], default=end)) if passes else end
    moments = [0.0]
    if rollout.accident and not passes:
        moments += [max(0.0, end - back) for back in (0, 1, 2, 4)]
    elif passes:
        lanes = np.flatnonzero(np.diff(states[:, EGO, LANE])) + 1
        moments += [until, passes, *times[lanes[times[lanes] < passes]][:2], times[np.argmin(ahead)]]
    moments += list(np.round(np.linspace(0, until, most if moments[1:] else 4)))
    chosen: list[float] = []
    for moment in moments:  # the first ones matter most
        if len(chosen) < most and moment <= end and all(abs(moment - other) >= 1 for other in chosen):
            chosen.append(float(moment))
    return sorted(chosen)


def _within(rollout: Rollout, times: Sequence[float]) -> list[float]:
    end = float(rollout.times[-1])
    if len(times) == 0 or not all(np.isfinite(t) and t >= 0 for t in times):
        raise BootcourseError(f"times = {list(times)}: give at least one moment, in seconds from 0 to {end:g}.")
    return sorted({min(float(t), end) for t in times})


def _metres(ax, last: bool = True) -> None:
    for side in ("top", "right", "left", "bottom"):
        ax.spines[side].set_visible(False)
    low, high = ax.get_xlim()
    ax.set_xticks(np.arange(np.ceil(low / 10), np.floor(high / 10) + 1) * 10)
    ax.tick_params(labelsize=SMALL, labelcolor=QUIET, color=EDGE, length=3 if last else 0, labelbottom=last)
    ax.tick_params(axis="y", length=0)
    if last:
        ax.set_xlabel("distance ahead of the ego (m)", fontsize=TEXT, color=INK)


def _name_ego(ax, rollout: Rollout, cars: np.ndarray) -> None:
    back = -rollout.scenario.car.length / 2 - 0.8
    look = {"fontsize": SMALL, "color": style(rollout.label).colour, "zorder": 7}
    ax.text(back, cars[EGO, Y], "ego", ha="right", va="center", **look)


def _gap_in_words(rollout: Rollout, time: float) -> str:
    cars = cars_at(rollout, time)
    ahead = cars[TRAP_1, X] - cars[EGO, X]
    return f"trap 1 {abs(ahead):.1f} m {'ahead' if ahead >= 0 else 'behind'}"
