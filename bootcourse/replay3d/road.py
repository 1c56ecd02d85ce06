"""The road as meshes: asphalt, lane markings, and posts that make the speed visible; and the two colour themes.

The whole road is made once, in world coordinates (see `bootcourse.replay3d.scene`): x along it, y to the left, z up;
y = 0 is the centre of its leftmost lane.
"""

from typing import NamedTuple

import numpy as np

from bootcourse.replay3d.car import Mesh, box, join, quads
from bootcourse.scenario import Road

BEHIND, AHEAD = 120.0, 450.0  # m of road before the start and after the last car's end
DASH, PERIOD, LINE = 4.0, 12.0, 0.16  # m: length of a dash, distance from dash to dash, width of a line
SHOULDER = 1.0  # m of asphalt beyond the outer lines
POST_EVERY = 25.0  # m
PIECE, FAR = 25.0, 900.0  # m: length of a piece of road; how far the ground reaches
GROUND_Z, LINE_Z = -0.12, 0.02  # m


class Theme(NamedTuple):
    """The colours of everything but the cars."""

    sky: str
    horizon: str
    ground: str
    asphalt: str
    line: str
    post: str


THEMES = {  # dark?
    False: Theme("#9CC4E6", "#E6EEF2", "#CFD8BE", "#6F747C", "#FFFFFF", "#FFFFFF"),
    True: Theme("#0B1220", "#26344A", "#2C3A35", "#474D57", "#E2E5E9", "#9BA2AB"),
}


def edges(road: Road) -> tuple[float, float]:
    """World y of the road's left and right edge, m."""
    return road.lane_width / 2, -(road.lanes - 0.5) * road.lane_width


def road_parts(road: Road, start: float, end: float) -> dict[str, Mesh]:
    """asphalt, lines and posts of the road from x = start to x = end, m."""
    left, right = edges(road)
    x = np.arange(np.floor(start / PERIOD) * PERIOD, end, PERIOD)
    dashes = [quads(x, x + DASH, y - LINE / 2, y + LINE / 2, LINE_Z) for y in divider_ys(road)]
    solid = [strip(start, end, y - LINE / 2, y + LINE / 2, LINE_Z) for y in (left, right)]
    posts = []
    for x_post in np.arange(np.ceil(start / POST_EVERY) * POST_EVERY, end, POST_EVERY):
        for y in (left + SHOULDER + 0.6, right - SHOULDER - 0.6):
            posts.append(box((x_post - 0.06, y - 0.08, GROUND_Z), (x_post + 0.06, y + 0.08, 0.85)))
    return {
        "asphalt": strip(start, end, right - SHOULDER, left + SHOULDER),
        "lines": join(*dashes, *solid),
        "posts": join(*posts),
    }


def strip(x0: float, x1: float, y0: float, y1: float, z: float = 0.0) -> Mesh:
    """A long flat rectangle in pieces: on a triangle of two kilometres, depth is too inexact to draw a line over it."""
    x = np.append(np.arange(x0, x1, PIECE), x1)
    return quads(x[:-1], x[1:], y0, y1, z)


def ground() -> Mesh:
    """The ground around the road, in pieces, beyond what is visible in the fog."""
    x = np.arange(-FAR, FAR, 4 * PIECE)
    return join(*(quads(x, x + 4 * PIECE, y, y + 4 * PIECE, GROUND_Z) for y in x))


def divider_ys(road: Road) -> list[float]:
    """World y of the broken lines between lanes, m."""
    return [-(lane + 0.5) * road.lane_width for lane in range(road.lanes - 1)]
