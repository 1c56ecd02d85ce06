"""The road as meshes: asphalt, markings that stream by, posts that say how fast; and the two themes.

The road is drawn once, in full length, in the world's directions (see `bootcourse.replay3d.scene`):
x along it, y to the left, z up; y = 0 is the centre of its leftmost lane.
"""

from typing import NamedTuple

import numpy as np

from bootcourse.replay3d.car import Mesh, box, join, quad, quads
from bootcourse.scenario import Road

BEHIND, AHEAD = 120.0, 450.0  # m of road before the start and after the last car's end
DASH, PERIOD, LINE = 4.0, 12.0, 0.16  # m: length of a dash, from dash to dash, width of a line
SHOULDER = 1.0  # m of asphalt beyond the outer lines
POST_EVERY, SIGN_EVERY = 25.0, 100.0  # m
GROUND_Z, LINE_Z = -0.12, 0.02  # m


class Theme(NamedTuple):
    """Colours of everything that is neither car nor driver."""

    sky: str
    horizon: str
    ground: str
    asphalt: str
    line: str
    post: str
    ink: str  # text


LIGHT = Theme("#A9CBE8", "#EAF1F4", "#C9D3B8", "#666B73", "#F7F7F4", "#F4F4F2", "#1C2126")
DARK = Theme("#0B1220", "#1B2636", "#1A2420", "#33373F", "#C9CDD3", "#8C939C", "#EEF1F4")


def theme(dark: bool) -> Theme:
    return DARK if dark else LIGHT


def edges(road: Road) -> tuple[float, float]:
    """World y of the road's left and right edge, m."""
    return road.lane_width / 2, -(road.lanes - 0.5) * road.lane_width


def road_parts(road: Road, start: float, end: float) -> dict[str, Mesh]:
    """asphalt, lines and posts of the road from x = start to x = end, m."""
    left, right = edges(road)
    x = np.arange(np.floor(start / PERIOD) * PERIOD, end, PERIOD)
    dashes = [quads(x, x + DASH, y - LINE / 2, y + LINE / 2, LINE_Z) for y in divider_ys(road)]
    solid = [quad(start, end, y - LINE / 2, y + LINE / 2, LINE_Z) for y in (left, right)]
    posts = []
    for x_post in np.arange(np.ceil(start / POST_EVERY) * POST_EVERY, end, POST_EVERY):
        for y in (left + SHOULDER + 0.6, right - SHOULDER - 0.6):
            posts.append(box((x_post - 0.06, y - 0.08, GROUND_Z), (x_post + 0.06, y + 0.08, 0.85)))
    return {
        "asphalt": quad(start, end, right - SHOULDER, left + SHOULDER),
        "lines": join(*dashes, *solid),
        "posts": join(*posts),
    }


def divider_ys(road: Road) -> list[float]:
    """World y of the broken lines between lanes, m."""
    return [-(lane + 0.5) * road.lane_width for lane in range(road.lanes - 1)]


def signs(start: float, end: float) -> list[int]:
    """Metres at which a sign stands."""
    return [int(x) for x in np.arange(np.ceil(max(start, 0.0) / SIGN_EVERY) * SIGN_EVERY, end, SIGN_EVERY)]
