"""A small chart as SVG: where numbers lie on the drawing, ticks at round ones, curves of several seeds."""

import math
from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from bootcourse.colours import Style
from bootcourse.panels.svg import INK, QUIET, line, path, text
from bootcourse.statistics import rolling_means

DASHES = {"-": "", "--": "7 4", ":": "2 3", "-.": "7 3 2 3"}


@dataclass(frozen=True)
class Axes:
    """A rectangle of a drawing (pixels) that shows the numbers x and y, each (low, high)."""

    left: float
    top: float
    width: float
    height: float
    x: tuple[float, float]
    y: tuple[float, float]

    def at(self, x: float, y: float) -> tuple[float, float]:
        """Where a point lies; y is kept inside."""
        across = (x - self.x[0]) / (self.x[1] - self.x[0])
        up = min(max((y - self.y[0]) / (self.y[1] - self.y[0]), 0.0), 1.0)
        return self.left + across * self.width, self.top + (1 - up) * self.height

    def frame(self, title: str, x_name: str = "", rows: int = 3) -> list[str]:
        """Title above, grid lines and their numbers at round places, `x_name` below."""
        parts = [text(self.left, self.top - 8, title, fill=INK, size=12, bold=True)]
        for y in ticks(*self.y, rows):
            _, down = self.at(self.x[0], y)
            parts.append(line(self.left, down, self.left + self.width, down))
            parts.append(text(self.left - 5, down + 3.5, number(y), "end", QUIET, 10.5))
        for x in ticks(*self.x, 4):
            across, down = self.at(x, self.y[0])
            parts.append(line(across, down, across, down + 3))
            parts.append(text(across, down + 14, number(x), "middle", QUIET, 10.5))
        if x_name:
            middle = self.left + self.width / 2
            parts.append(text(middle, self.top + self.height + 28, x_name, "middle", QUIET, 11))
        return parts

    def curve(self, xs: np.ndarray, ys: np.ndarray, look: Style, width: float, opacity: float = 1.0) -> list[str]:
        """One line, with gaps where y is not a number."""
        parts, dashes = [], DASHES.get(look.line, "9 5") if isinstance(look.line, str) else "9 5"
        more = f'stroke-linejoin="round" opacity="{opacity:g}"' + (f' stroke-dasharray="{dashes}"' if dashes else "")
        for run in _runs(np.isfinite(ys)):
            points = [self.at(x, y) for x, y in zip(xs[run].tolist(), ys[run].tolist(), strict=True)]
            points = points if len(points) > 1 else [points[0], (points[0][0] + 1.5, points[0][1])]
            parts.append(path(points, look.colour, width, more))
        return parts

    def band(self, xs: np.ndarray, low: np.ndarray, high: np.ndarray, look: Style) -> list[str]:
        """What lies between two lines, filled. Nothing where one of them is not a number."""
        if not (np.isfinite(low).all() and np.isfinite(high).all()):
            return []
        there = [self.at(x, y) for x, y in zip(xs.tolist(), high.tolist(), strict=True)]
        back = [self.at(x, y) for x, y in zip(xs[::-1].tolist(), low[::-1].tolist(), strict=True)]
        d = "M" + "L".join(f"{x:.1f} {y:.1f}" for x, y in there + back) + "Z"
        return [f'<path d="{d}" fill="{look.colour}" opacity="0.15"/>']


def _runs(holds: np.ndarray) -> list[slice]:
    """The stretches in which it holds."""
    edges = np.flatnonzero(np.diff(np.concatenate([[0], holds.astype(np.int8), [0]])))
    return [slice(a, b) for a, b in zip(edges[::2], edges[1::2], strict=True)]


def ticks(low: float, high: float, about: int = 3) -> list[float]:
    """Round numbers from low to high, about so many."""
    rough = (high - low) / about
    power = 10.0 ** math.floor(math.log10(rough))
    step = next(power * k for k in (1, 2, 2.5, 3, 5, 10) if power * k >= rough * 0.999)
    first, last = math.ceil(low / step - 1e-9), math.floor(high / step + 1e-9)
    return [round(i * step, 12) for i in range(first, last + 1)]


def number(value: float) -> str:
    return f"{value:.6g}".replace("-", "−")


def span(values: Sequence[float], least: float) -> tuple[float, float]:
    """The range of an axis: all finite values, a little air, and at least so wide."""
    finite = np.asarray(values, dtype=float)
    finite = finite[np.isfinite(finite)]
    low, high = (float(finite.min()), float(finite.max())) if finite.size else (0.0, least)
    low, high = (low, high) if high - low >= least else ((low + high - least) / 2, (low + high + least) / 2)
    air = 0.06 * (high - low)
    floor = 0.0 if finite.size and finite.min() >= 0 else -math.inf
    return max(low - air, floor), high + air + (max(floor - (low - air), 0) if floor == 0 else 0)


def rolling(values: np.ndarray, window: int, points: int = 80) -> tuple[np.ndarray, np.ndarray]:
    """Means of the last `window` episodes: (agents, episodes) -> (episode numbers (points,), (agents, points)).

    NaN after an agent's last episode. Both are empty where nobody finished one.
    """
    values = np.atleast_2d(np.asarray(values, dtype=np.float64))
    episodes = int(np.isfinite(values).sum(axis=1).max(initial=0))
    if not episodes:
        return np.zeros(0, dtype=int), np.zeros((len(values), 0))
    return rolling_means(values[:, :episodes], window, points)
