"""The figure of one decision: the road from above with its nine imagined drives."""

import numpy as np
from matplotlib.figure import Figure

from bootcourse.colours import ALARM, OTHER, QUIET
from bootcourse.episodes.lookahead import Imagined
from bootcourse.errors import BootcourseError
from bootcourse.plots.canvas import MplAxes
from bootcourse.plots.figure import INK, SMALL, WIDTH, axes_at, finish, new_figure
from bootcourse.plots.futures import LEGEND, trails
from bootcourse.plots.road import draw_cars, draw_road, edges_of
from bootcourse.road.state import EGO, X
from bootcourse.scenario import ACTION_NAMES, DEFAULT, Scenario

BEHIND, AHEAD, ASIDE = 14.0, 24.0, 1.6  # m behind the ego, beyond the longest imagined drive, beside the road
THIN, BOLD = 1.2, 3.2  # points
LOWER = 0.8  # inches, below the road


def nine_futures(
    cars: np.ndarray, imagined: Imagined, title: str, scenario: Scenario = DEFAULT, colour: str = OTHER.colour
) -> Figure:
    """The road at a decision with the nine imagined drives on it; x is in metres from the ego.

    cars (vehicles, 10): the road at the decision; imagined: of this road alone, values (1, 9). colour: the ego's.
    Raises BootcourseError for several roads.
    """
    if len(imagined.values) != 1:
        raise BootcourseError(f"There are imagined drives of {len(imagined.values)} roads: give those of one.")
    values, hurt, paths = imagined.values[0], imagined.accidents[0] > 0, imagined.paths[0]
    left, right = -BEHIND, float(paths[..., 0].max() - cars[EGO, X]) + AHEAD
    tall = (
        scenario.road.lanes * scenario.road.lane_width + 2 * ASIDE
    ) * 2.8  # metres across are drawn larger than along
    width = WIDTH - 0.4
    height = tall * width / (right - left)
    figure = new_figure(height + LOWER + 0.63)
    ax = axes_at(figure, 0.2, 0.63, width, height)
    draw_road(MplAxes(ax), scenario, left, right, cars[EGO, X])
    draw_cars(MplAxes(ax), cars, scenario, colour, left, right, cars[EGO, X])
    for one in trails(imagined, int(values.argmax())):
        x = one.x - cars[EGO, X]
        ax.plot(x, one.y, color=one.colour, linewidth=BOLD if one.chosen else THIN, zorder=7 if one.chosen else 6)
        if one.hurt:
            ax.plot(x[-1], one.y[-1], "X", color=ALARM, markersize=6, markeredgecolor="white", zorder=7)
    top, bottom = edges_of(scenario.road)
    ax.set(xlim=(left, right), ylim=(bottom + ASIDE, top - ASIDE))
    ax.set_yticks([])
    for side in ("top", "right", "left", "bottom"):
        ax.spines[side].set_visible(False)
    ax.tick_params(labelsize=SMALL, labelcolor=QUIET, length=3)
    ax.set_xlabel("distance from the ego (m)", fontsize=SMALL, color=QUIET)
    safe = ", ".join(name for name, end in zip(ACTION_NAMES, hurt, strict=True) if not end) or "none"
    best = ACTION_NAMES[values.argmax()]
    words = f"{LEGEND[0].upper()}{LEGEND[1:]}.\nWithout an accident: {safe}. Bold, the best: {best}."
    figure.text(0.012, 0.08 / figure.get_figheight(), words, fontsize=SMALL, color=INK)
    described = (
        f"{name} {'ends in an accident' if end else f'is worth {value:.1f}'}"
        for name, value, end in zip(ACTION_NAMES, values, hurt, strict=True)
    )
    return finish(figure, title, f"Nine imagined drives on the road from above: {'; '.join(described)}.")
