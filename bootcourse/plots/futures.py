"""The nine imagined drives of a look-ahead on the road from above: thin, accidents red, the chosen one bold."""

from typing import NamedTuple

import numpy as np
from matplotlib.colors import Colormap, LinearSegmentedColormap, to_hex
from matplotlib.figure import Figure

from bootcourse.colours import ALARM, OTHER, QUIET
from bootcourse.episodes.lookahead import Imagined
from bootcourse.errors import BootcourseError
from bootcourse.plots.canvas import MplAxes
from bootcourse.plots.figure import INK, SMALL, WIDTH, finish, new_figure
from bootcourse.plots.road import draw_cars, draw_road, edges_of
from bootcourse.road.state import EGO, X
from bootcourse.scenario import ACTION_NAMES, DEFAULT, Scenario

BEHIND, AHEAD, ASIDE = 14.0, 24.0, 1.6  # m behind the ego, beyond the longest imagined drive, beside the road
# From the worst safe drive to the best: on a light road and on that of a dark theme; on the grey road of the 3D replay.
SHADES = LinearSegmentedColormap.from_list("value", ["#AFC6D8", "#1B79C4"])
BRIGHT = LinearSegmentedColormap.from_list("value in 3D", ["#A3B1BE", "#35C4FF"])
LEGEND = "bluer: worth more; red: ends in an accident"
THIN, BOLD = 1.2, 3.2  # points


class Trail(NamedTuple):
    """An imagined drive, to be drawn on the road."""

    x: np.ndarray  # (points,) m along the road
    y: np.ndarray  # (points,) m, to the right of the leftmost lane's centre
    colour: str
    chosen: bool
    action: int  # the first
    hurt: bool  # ends in an accident


def trails(imagined: Imagined, chosen: int, road: int = 0, shades: Colormap = SHADES) -> list[Trail]:
    """The nine drives of one road: those of less value first, so that the best lie on top, and the chosen one last."""
    values, hurt, paths = imagined.values[road], imagined.accidents[road] > 0, imagined.paths[road]
    safe = values[~hurt]
    spread = np.ptp(safe) if len(safe) > 1 and np.ptp(safe) > 0 else 1.0
    order = sorted(range(len(values)), key=lambda action: (action == chosen, values[action]))
    colours = [
        ALARM if end else to_hex(shades((value - safe.min()) / spread)) for value, end in zip(values, hurt, strict=True)
    ]
    return [Trail(*paths[i].T, colours[i], i == chosen, i, bool(hurt[i])) for i in order]


def in_words(imagined: Imagined, road: int = 0) -> str:
    """ "3 of 9 imagined drives end in an accident; the best begins with keep straight"."""
    values, hurt = imagined.values[road], imagined.accidents[road] > 0
    best = ACTION_NAMES[values.argmax()]
    return f"{hurt.sum()} of {len(values)} imagined drives end in an accident; the best begins with {best}"


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
    figure = new_figure(height + 1.25)
    ax = figure.add_axes((0.2 / WIDTH, 0.62 / (height + 1.25), width / WIDTH, height / (height + 1.25)))
    draw_road(MplAxes(ax), scenario, left, right, cars[EGO, X])
    draw_cars(MplAxes(ax), cars, scenario, colour, left, right, cars[EGO, X], names=False)
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
    words = f"Bold: {ACTION_NAMES[values.argmax()]}, the best. {LEGEND[0].upper()}{LEGEND[1:]}."
    figure.text(0.012, 0.08 / (height + 1.25), words, fontsize=SMALL, color=INK)
    described = (
        f"{name} {'ends in an accident' if end else f'is worth {value:.1f}'}"
        for name, value, end in zip(ACTION_NAMES, values, hurt, strict=True)
    )
    return finish(figure, title, f"Nine imagined drives on the road from above: {'; '.join(described)}.")
