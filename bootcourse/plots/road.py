"""The road from above, in metres and to scale, for any canvas: a figure's axes or a panel's SVG.

x is metres from `origin`, a place on the road; y is the road's own, to the right of the leftmost lane's centre.
"""

from collections.abc import Sequence

import numpy as np

from bootcourse.colours import ASPHALT, EDGE, INK, PAINT, TRAFFIC, TRAP
from bootcourse.plots.canvas import Canvas
from bootcourse.plots.svg import SvgAxes, over
from bootcourse.road.state import EGO, HEADING, TRAP_1, TRAP_2, X, Y
from bootcourse.scenario import Car, Road, Scenario

DASH, PERIOD = 3.0, 9.0  # m; lane lines are dashes of 3 m, one every 9 m
NAME, FAR_NAME = 9.0, 22.0  # m of road that the name of a trap takes, without and with its distance
NO_TRAIL = np.zeros((0, 2))
BEHIND = 0.36  # share of a panel's road that lies behind the ego


def edges_of(road: Road) -> tuple[float, float]:
    """y of the road's left and right edge, m."""
    return -road.lane_width / 2, (road.lanes - 0.5) * road.lane_width


def draw_road(canvas: Canvas, scenario: Scenario, left: float, right: float, origin: float = 0.0) -> None:
    """The empty road from `left` to `right`, m from `origin`."""
    top, bottom = edges_of(scenario.road)
    canvas.fill([left, right, right, left], [top, top, bottom, bottom], ASPHALT)
    for y in (top, bottom):
        canvas.line([left, right], [y, y], EDGE, 1.3)
    starts = np.arange(np.floor((origin + left) / PERIOD) * PERIOD - origin, right, PERIOD)
    dashes = np.column_stack([starts, starts + DASH, np.full(len(starts), np.nan)]).clip(left, right).ravel()
    for lane in range(1, scenario.road.lanes):
        canvas.line(dashes, np.full(len(dashes), top + lane * scenario.road.lane_width), PAINT, 1.2)


def draw_car(canvas: Canvas, x: float, y: float, heading: float, colour: str, car: Car, name: str = "car") -> None:
    """One car, to scale, its windscreen towards its nose; `name` marks the body in tests and SVG files."""
    size, radius = np.array([car.length, car.width]), 0.22 * car.width
    turns = np.linspace(0, 2 * np.pi, 16, endpoint=False) + np.pi / 16
    round_ = np.column_stack([np.cos(turns), np.sin(turns)])
    body = np.sign(round_) * (size / 2 - radius) + radius * round_
    windscreen = np.array([[0.08, -0.36], [0.24, -0.30], [0.24, 0.30], [0.08, 0.36]]) * size
    rear = np.array([[-0.34, -0.32], [-0.26, -0.36], [-0.26, 0.36], [-0.34, 0.32]]) * size
    cos, sin = np.cos(heading), np.sin(heading)
    for outline, paint, clear in ((body, colour, 1.0), (windscreen, "white", 0.6), (rear, "white", 0.6)):
        xs, ys = (outline @ [[cos, sin], [-sin, cos]] + [x, y]).T
        canvas.fill(xs, ys, paint, clear, *(("white", name) if outline is body else ()))


def draw_cars(
    canvas: Canvas, cars: np.ndarray, scenario: Scenario, colour: str, left: float, right: float, origin: float,
    names: bool = True, trail: np.ndarray = NO_TRAIL,
) -> None:  # fmt: skip
    """All cars between `left` and `right`, the ego last; the traps' names, or how far away they are.

    cars: (vehicles, 10), columns of bootcourse.road.state; colour: of the ego. trail: places (n, 2) on the road, m,
    where no name should lie.
    """
    half = scenario.car.length / 2
    for i in reversed(range(len(cars))):
        x, kind = cars[i, X] - origin, {EGO: "ego", TRAP_1: "trap 1", TRAP_2: "trap 2"}.get(i, f"traffic {i - TRAP_2}")
        if left - half < x < right + half:
            paint = {EGO: colour, TRAP_1: TRAP, TRAP_2: TRAP}.get(i, TRAFFIC)
            draw_car(canvas, x, cars[i, Y], cars[i, HEADING], paint, scenario.car, kind)
    for trap in (TRAP_1, TRAP_2) if names else ():
        _name_trap(canvas, cars, trap, scenario, left, right, origin, trail)


def _name_trap(
    canvas: Canvas, cars: np.ndarray, trap: int, scenario: Scenario, left: float, right: float, origin: float,
    trail: np.ndarray,
) -> None:  # fmt: skip
    """The trap's name in front of it, else behind it or beside it, where no car is; its distance if it is far away."""
    x, y, ahead, name = cars[trap, X] - origin, cars[trap, Y], cars[trap, X] - cars[EGO, X], f"trap {trap}"
    half, lane, (top, bottom) = scenario.car.length / 2, scenario.road.lane_width, edges_of(scenario.road)
    lanes = [down for down in (y, y - lane, y + lane) if top < down < bottom]
    if x < left - half:
        name, long, places = f"◂ {name}, {-ahead:.0f} m behind", FAR_NAME, [(left + 1, down, "start") for down in lanes]
    elif x > right + half:
        name, long, places = f"{name}, {ahead:.0f} m ahead ▸", FAR_NAME, [(right - 1, down, "end") for down in lanes]
    else:
        long, places = NAME, [(x + half + 0.8, y, "start"), (x - half - 0.8, y, "end")]
        places += [(x, down, "middle") for down in lanes[1:]]
    from_left = {"start": 0.0, "middle": 0.5, "end": 1.0}

    def free(place: tuple[float, float, str]) -> bool:
        begin = place[0] - from_left[place[2]] * long
        for xy, longer, wider in ((cars[:, [X, Y]], half, 2.5), (trail, 0.0, 1.3)):
            along, across = xy[:, 0] - origin - begin, np.abs(xy[:, 1] - place[1])
            if np.any((along > -longer) & (along < long + longer) & (across < wider)):
                return False
        return left <= begin <= right - long

    at, down, anchor = next(filter(free, places), places[0])
    canvas.words(at, down, name, INK, anchor)


def road_svg(
    cars: np.ndarray, scenario: Scenario, colour: str, width: float, scale: float,
    trails: Sequence = (),
) -> tuple[list[str], float]:  # fmt: skip
    """The SVG parts of one moment around the ego, and their height in pixels.

    width: pixels; scale: pixels per metre. trails: imagined drives, each a `futures.Trail`.
    """
    left, right, (top, bottom) = -BEHIND * width / scale, (1 - BEHIND) * width / scale, edges_of(scenario.road)
    canvas = SvgAxes(0, 0, width, (bottom - top) * scale, (left, right), (bottom, top))
    draw_road(canvas, scenario, left, right, cars[EGO, X])
    for trail in trails:
        x = np.where(trail.x - cars[EGO, X] <= right, trail.x - cars[EGO, X], np.nan)
        canvas.line(x, trail.y, trail.colour, 2.6 if trail.chosen else 1.1)
    draw_cars(canvas, cars, scenario, colour, left, right, cars[EGO, X])
    if trails:  # which run below the names
        canvas.parts = [over(part, 6) if part.startswith("<text ") else part for part in canvas.parts]
    for trail in trails:
        if trail.hurt and trail.x[-1] - cars[EGO, X] <= right:
            canvas.words(trail.x[-1] - cars[EGO, X], trail.y[-1], "✕", trail.colour, "middle", 11)
    return canvas.parts, canvas.height
