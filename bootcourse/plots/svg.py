"""Drawing for panels: SVG as text, which reaches the page in a fraction of the time that a matplotlib picture takes.

Lengths are pixels of a drawing that shrinks with its column. `SvgAxes` is one of the two canvases (see canvas.py).
"""

import math
import re
from collections.abc import Sequence

import numpy as np

from bootcourse.colours import ASPHALT, EDGE, GRID, INK, PAINT, QUIET
from bootcourse.markup import html

FONT = "system-ui, -apple-system, 'Segoe UI', sans-serif"
POINT = 1.5  # pixels
LEAST = 0.86  # of its width, at which letters of a drawing can still be read
DASHES = {"-": "", "--": "7 4", ":": "2 3", "-.": "7 3 2 3"}
THEME = {  # what follows JupyterLab's theme, light or dark; outside it, it has the colours of the figures
    INK: "--jp-ui-font-color1",
    QUIET: "--jp-ui-font-color2",
    GRID: "--jp-border-color2",
    ASPHALT: "--jp-layout-color2",
    EDGE: "--jp-ui-font-color2",
    PAINT: "--jp-ui-font-color3",
    "#FFFFFF": "--jp-layout-color0",
}


class Drawing(str):
    """A whole SVG. `alt` is what a screen reader says."""

    alt: str


def drawing(width: float, height: float, parts: Sequence[str], alt: str) -> Drawing:
    themed, escaped = "".join(parts), html("{}", alt)
    for colour, variable in THEME.items():
        themed = themed.replace(f'"{colour}"', f'"var({variable}, {colour})"')
    drawn = Drawing(
        f'<svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 {width:g} {height:g}" width="{width:g}" '
        f'height="{height:g}" role="img" aria-label="{escaped}" font-family="{FONT}" font-size="12" '
        f'style="--least:{LEAST * width:.0f}px">'
        f"<title>{escaped}</title>{themed}</svg>"
    )
    drawn.alt = alt
    return drawn


def printed(svg: str) -> bytes:
    """The same for a reader outside JupyterLab: on white, in the figures' colours."""
    plain = re.sub(r"var\(--[\w-]+, (#\w+)\)", r"\1", re.sub(r' style="--least:\w+"', "", svg))
    return plain.replace("</title>", '</title><rect width="100%" height="100%" fill="white"/>', 1).encode()


def text(
    x: float, y: float, words: str, anchor: str = "start", fill: str = INK, size: float = 12, bold: bool = False
) -> str:
    """Words whose base line is at y; anchor: "start", "middle" or "end"."""
    page = '<text x="{:.1f}" y="{:.1f}" text-anchor="{}" fill="{}" font-size="{:g}" font-weight="{}">{}</text>'
    return str(html(page, x, y, anchor, fill, size, 650 if bold else 400, words))


def over(words: str, rim: float = 3) -> str:
    """A `text` with a rim of the page's colour, so that it can be read over curves."""
    return words.replace("<text ", f'<text stroke="#FFFFFF" stroke-width="{rim:g}" paint-order="stroke" ', 1)


def rect(x: float, y: float, width: float, height: float, fill: str, more: str = "") -> str:
    width, height = max(width, 0), max(height, 0)
    return f'<rect x="{x:.2f}" y="{y:.2f}" width="{width:.2f}" height="{height:.2f}" fill="{fill}" {more}/>'


def line(x1: float, y1: float, x2: float, y2: float, stroke: str = GRID, width: float = 1, more: str = "") -> str:
    ends = f'x1="{x1:.2f}" y1="{y1:.2f}" x2="{x2:.2f}" y2="{y2:.2f}"'
    return f'<line {ends} stroke="{stroke}" stroke-width="{width:g}" {more}/>'


class SvgAxes:
    """A rectangle of a drawing (pixels) that shows the numbers x and y, each (low, high); `parts` is what was drawn."""

    def __init__(self, left: float, top: float, width: float, height: float, x: tuple, y: tuple):
        self.left, self.top, self.width, self.height, self.x, self.y = left, top, width, height, x, y
        self.parts: list[str] = []

    def at(self, x, y):
        """The pixels of a point, or of points."""
        across, up = (x - self.x[0]) / (self.x[1] - self.x[0]), (y - self.y[0]) / (self.y[1] - self.y[0])
        return self.left + across * self.width, self.top + (1 - up) * self.height

    def scale(self, title: str, rows: int = 3) -> None:
        """Title above, and grid lines with their numbers at round places of y."""
        self.parts.append(text(self.left, self.top - 8, title, size=12, bold=True))
        for y in ticks(*self.y, rows):
            _, down = self.at(self.x[0], y)
            self.parts.append(line(self.left, down, self.left + self.width, down))
            self.parts.append(text(self.left - 5, down + 3.5, number(y), "end", QUIET, 10.5))

    def frame(self, title: str, x_name: str = "", rows: int = 3) -> None:
        """The same, with numbers at round places of x and `x_name` below."""
        self.scale(title, rows)
        for x in ticks(*self.x, 4):
            across, down = self.at(x, self.y[0])
            self.parts.append(line(across, down, across, down + 3))
            self.parts.append(text(across, down + 14, number(x), "middle", QUIET, 10.5))
        if x_name:
            middle = self.left + self.width / 2
            self.parts.append(text(middle, self.top + self.height + 28, x_name, "middle", QUIET, 11))

    def line(self, xs, ys, colour: str, width: float = 1, dash="-", opacity: float = 1.0) -> None:
        across, down = self.at(np.asarray(xs, float), np.clip(ys, *sorted(self.y)))
        dashes = DASHES.get(dash, "9 5")
        more = f' stroke-dasharray="{dashes}"' if dashes else ""
        d = "".join(_path(across[run], down[run]) for run in _runs(np.isfinite(across + down)))
        look = f'stroke="{colour}" stroke-width="{POINT * width:g}" opacity="{opacity:g}"{more}'
        self.parts.append(f'<path d="{d}" fill="none" stroke-linejoin="round" {look}/>' if d else "")

    def fill(self, xs, ys, colour: str, opacity: float = 1.0, edge: str = "none", gid: str = "") -> None:
        name = f' class="{gid}"' if gid else ""
        look = f'fill="{colour}" stroke="{edge}" opacity="{opacity:g}"{name}'
        self.parts.append(f'<path d="{_path(*self.at(np.asarray(xs), np.asarray(ys)))}Z" {look}/>')

    def words(self, x: float, y: float, words: str, colour: str, anchor: str = "start", size: float = 7.5) -> None:
        across, down = self.at(x, y)
        self.parts.append(text(across, down + 0.5 * size, words, anchor, colour, POINT * size))

    def dot(self, x: float, y: float, colour: str) -> tuple[float, float]:
        """A dot at a point; returns its place in the drawing."""
        across, down = self.at(x, float(np.clip(y, *sorted(self.y))))
        self.parts.append(f'<circle cx="{across:.1f}" cy="{down:.1f}" r="3.5" fill="{colour}" stroke="white"/>')
        return across, down


def _path(xs: np.ndarray, ys: np.ndarray) -> str:
    if len(xs) == 1:  # a dash shows where a single point is
        xs, ys = np.append(xs, xs + 1.5), np.append(ys, ys)
    return "M" + "L".join(f"{x:.1f} {y:.1f}" for x, y in zip(xs.tolist(), ys.tolist(), strict=True))


def _runs(holds: np.ndarray) -> list[slice]:
    """The stretches of True, as slices."""
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
