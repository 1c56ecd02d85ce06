"""The road from above as SVG, for panels: to scale, the ego in the middle, the road passing by."""

from collections.abc import Sequence

import numpy as np

from bootcourse.colours import TRAFFIC, TRAP
from bootcourse.panels.svg import QUIET, line, rect, text
from bootcourse.road.state import EGO, HEADING, TRAP_1, TRAP_2, X, Y
from bootcourse.scenario import Scenario

DASH, PERIOD = 3.0, 9.0  # m
BEHIND = 0.36  # share of the picture that lies behind the ego


def road(
    cars: np.ndarray, scenario: Scenario, colour: str, width: float = 1000, scale: float = 7.0,
    ghosts: Sequence[tuple[np.ndarray, str]] = (), behind: float = BEHIND,
) -> tuple[list[str], float]:  # fmt: skip
    """The SVG parts of one moment, and their height.

    cars: (vehicles, 10), columns of bootcourse.road.state; colour: of the ego; scale: pixels per metre;
    ghosts: (state (10,), colour) of egos of other drives, drawn translucent; behind: share of the width
    that lies behind the ego.
    """
    lane_width, lanes = scenario.road.lane_width, scenario.road.lanes
    origin, height = float(cars[EGO, X]), lanes * lane_width * scale

    def place(car):
        return (car[X] - origin) * scale + behind * width, (car[Y] + lane_width / 2) * scale

    parts = [rect(0, 0, width, height, "var(--jp-layout-color2, #F1F3F5)")]
    for lane in range(lanes + 1):
        y = lane * lane_width * scale
        if lane in (0, lanes):
            parts.append(line(0, y, width, y, QUIET, 1.5))
            continue
        start = (origin % PERIOD) * scale - behind * width
        dashes = f'stroke-dasharray="{DASH * scale} {(PERIOD - DASH) * scale}" stroke-dashoffset="{start:.1f}"'
        parts.append(line(0, y, width, y, QUIET, 1, dashes))
    for car, look in ghosts:
        parts.append(_car(*place(car), car[HEADING], look, scenario, scale, 'opacity="0.45"'))
    for i in reversed(range(len(cars))):
        x, y = place(cars[i])
        if -60 < x < width + 60:
            look = colour if i == EGO else TRAP if i in (TRAP_1, TRAP_2) else TRAFFIC
            parts.append(_car(x, y, cars[i, HEADING], look, scenario, scale))
            if i in (TRAP_1, TRAP_2) and scenario.car.width * scale >= 8:  # else the number is taller than the car
                parts.append(text(x - 6, y + 4, str(i), "middle", "white", 11, bold=True))
    parts += _beyond(cars, place, width, height)
    return parts, height


def _car(x: float, y: float, heading: float, colour: str, scenario: Scenario, scale: float, more: str = "") -> str:
    length, width = scenario.car.length * scale, scenario.car.width * scale
    body = rect(
        -length / 2, -width / 2, length, width, colour, f'rx="{0.25 * width:.1f}" stroke="white" stroke-width="0.8"'
    )
    glass = rect(0.1 * length, -0.36 * width, 0.16 * length, 0.72 * width, "white", 'opacity="0.75"')
    return f'<g transform="translate({x:.1f} {y:.1f}) rotate({np.degrees(heading):.1f})" {more}>{body}{glass}</g>'


def _beyond(cars: np.ndarray, place, width: float, height: float) -> list[str]:
    """Say where the traps are when they are out of the picture."""
    parts = []
    for i in (TRAP_1, TRAP_2):
        x, y = place(cars[i])
        away = float(cars[i, X] - cars[EGO, X])
        if x < 0:
            parts.append(text(6, y + 4, f"◀ trap {i}, {-away:.0f} m", "start", TRAP, 11))
        elif x > width:
            parts.append(text(width - 6, y + 4, f"trap {i}, {away:.0f} m ▶", "end", TRAP, 11))
    return parts
