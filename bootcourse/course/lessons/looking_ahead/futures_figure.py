"""The figure of one decision: the road from above with its nine imagined drives."""

from dataclasses import replace

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from bootcourse.colours import ALARM, QUIET
from bootcourse.episodes.lookahead import NINE, imagine
from bootcourse.methods import style
from bootcourse.plots.canvas import MplAxes
from bootcourse.plots.figure import INK, SMALL, WIDTH, axes_at, finish, new_figure
from bootcourse.plots.futures import LEGEND, trails
from bootcourse.plots.road import draw_cars, draw_road, edges_of
from bootcourse.policies import Policy
from bootcourse.road.state import EGO, HEADING, X
from bootcourse.scenario import ACTION_NAMES, DEFAULT, Scenario

BEHIND, AHEAD, ASIDE = 14.0, 44.0, 1.6  # m behind the ego, beyond the longest imagined drive, beside the road
THIN, BOLD = 1.2, 3.2  # points
UPPER, LOWER = 0.95, 0.95  # inches, above the road with its names, and below it
STRETCH = 4.0  # metres across are drawn so much larger than metres along
CAR = 1.5  # a car is drawn so much longer than it is, to be seen
APART = 8.0, 1.2  # m along and across; drives that end closer to each other share their label


def unharmed(cars: np.ndarray, policy: Policy, horizon: int = 10) -> int:
    """How many of the nine drives that begin at these cars, (vehicles, 10), end without an accident."""
    return int((imagine(cars[None], NINE[None], policy, horizon=horizon).accidents == 0).sum())


def nine_futures(
    cars: np.ndarray,
    policy: Policy,
    title: str,
    horizon: int = 10,
    scenario: Scenario = DEFAULT,
) -> Figure:
    """The road at a decision with the nine imagined drives on it; x is in metres from the ego.

    cars (vehicles, 10): the road at the decision; policy: drives on after each of the nine actions.
    """
    imagined = imagine(cars[None], NINE[None], policy, horizon=horizon, scenario=scenario)
    values, hurt, paths = imagined.values[0], imagined.accidents[0] > 0, imagined.paths[0]
    left, right = -BEHIND, float(paths[..., 0].max() - cars[EGO, X]) + AHEAD
    width = WIDTH - 0.4
    tall = scenario.road.lanes * scenario.road.lane_width + 2 * ASIDE
    height = STRETCH * tall * width / (right - left)
    figure = new_figure(height + LOWER + UPPER)
    ax = axes_at(figure, 0.2, UPPER, width, height)
    car = replace(scenario.car, length=CAR * scenario.car.length, width=CAR * scenario.car.width / STRETCH)
    level = cars.copy()
    level[:, HEADING] = 0
    draw_road(MplAxes(ax), scenario, left, right, cars[EGO, X])
    draw_cars(MplAxes(ax), level, replace(scenario, car=car), style("bootstrapped").colour, left, right, cars[EGO, X])
    for one in trails(imagined, int(values.argmax())):
        x = one.x - cars[EGO, X]
        ax.plot(x, one.y, color=one.colour, linewidth=BOLD if one.chosen else THIN, zorder=7 if one.chosen else 6)
        if one.hurt:
            ax.plot(x[-1], one.y[-1], "X", color=ALARM, markersize=6, markeredgecolor="white", zorder=7)
    top, bottom = edges_of(scenario.road)
    _name_ends(ax, paths[:, -1] - [cars[EGO, X], 0.0], hurt, top)
    ax.set(xlim=(left, right), ylim=(bottom + ASIDE, top - ASIDE))
    ax.set_yticks([])
    for side in ("top", "right", "left", "bottom"):
        ax.spines[side].set_visible(False)
    ax.tick_params(labelsize=SMALL, labelcolor=QUIET, length=3)
    ax.set_xlabel("distance from the ego (m)", fontsize=SMALL, color=QUIET)
    best = ACTION_NAMES[values.argmax()]
    safe = f"{(~hurt).sum()} of nine end without an accident; bold, the best: {best}"
    scale = f"Across, the road is drawn {STRETCH:g} times larger than along; cars are drawn {CAR:g} times as long."
    words = f"{LEGEND[0].upper()}{LEGEND[1:]}. {safe}.\n{scale}"
    figure.text(0.012, 0.08 / figure.get_figheight(), words, fontsize=SMALL, color=INK)
    described = (
        f"{name} {'ends in an accident' if end else f'is worth {value:.1f}'}"
        for name, value, end in zip(ACTION_NAMES, values, hurt, strict=True)
    )
    return finish(figure, title, f"Nine imagined drives on the road from above: {'; '.join(described)}.")


def _name_ends(ax: Axes, ends: np.ndarray, hurt: np.ndarray, top: float) -> None:
    """Write each drive's first action at its end (9, 2), once for drives that end together; above the road at its edge.

    ends: x from the ego, y; hurt (9,): which end in an accident. top: y of the road's left edge.
    """
    groups: list[list[int]] = []
    for one in np.argsort(ends[:, 0]):
        near = [group for group in groups if np.all(np.abs(ends[group[0]] - ends[one]) < APART)]
        same = [group for group in near if hurt[group[0]] == hurt[one]]
        same[0].append(int(one)) if same else groups.append([int(one)])
    raised, before = 0, -np.inf
    for group in groups:
        x, y = ends[group].mean(axis=0)
        names = _together([ACTION_NAMES[one] for one in sorted(group)])
        colour = ALARM if hurt[group[0]] else INK
        look = {"fontsize": SMALL, "color": colour, "textcoords": "offset points", "zorder": 8}
        if y < top + 1 and hurt[group[0]]:
            raised = 0 if x - before > 45 else raised + 1
            before = x
            ax.annotate(names, (x, top), (0, 6 + 11 * raised), ha="center", va="bottom", **look)
        else:
            ax.annotate(names, (x, y), (7, 0), ha="left", va="center", **look)


def _together(names: list[str]) -> str:
    """ "brake, keep, accelerate left" of three that steer left; else the names below each other."""
    sides = {name.split()[-1] for name in names}
    if len(names) > 1 and len(sides) == 1:
        return f"{', '.join(name.rsplit(' ', 1)[0] for name in names)} {sides.pop()}"
    return "\n".join(names)
