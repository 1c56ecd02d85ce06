"""Diagrams of boxes and arrows, as SVG. `bootcourse.show` displays them as it does figures, in light and in dark."""

import math
from collections.abc import Sequence

from bootcourse.colours import INK
from bootcourse.markup import html
from bootcourse.plots.figure import Picture
from bootcourse.plots.svg import FONT
from bootcourse.terminal import printable

TINTS = {"world": "#009E73", "learned": "#0072B2", "stored": "#E69F00"}  # of a box's border and, faintly, of its inside
TIP = 9  # length of an arrow's head, pixels


class Diagram:
    """A drawing that a notebook shows; alt is what a screen reader says."""

    def __init__(self, width: int, height: int, parts: Sequence[str], alt: str):
        self.alt, self.width, look = alt, width, f'font-family="{FONT}" font-size="14" color="{INK}"'
        size = f'viewBox="0 0 {width} {height}" width="{width}" height="{height}"'
        self.svg = f'<svg xmlns="http://www.w3.org/2000/svg" {size} {look}>{"".join(parts)}</svg>'

    def _repr_mimebundle_(self, include=None, exclude=None) -> dict[str, str]:
        return Picture(self)._repr_mimebundle_()

    def __repr__(self) -> str:
        return printable(self.alt)


def box(x: float, y: float, width: float, height: float, lines: Sequence[str], tint: str) -> str:
    """A box with lines of words in its middle, the first in bold; tint: a name in `TINTS`."""
    colour = TINTS[tint]
    look = f'fill="{colour}" fill-opacity="0.12" stroke="{colour}" stroke-width="2" rx="8"'
    parts = [f'<rect x="{x}" y="{y}" width="{width}" height="{height}" {look}/>']
    for i, words in enumerate(lines):
        down = y + height / 2 + 5 + 18 * (i - (len(lines) - 1) / 2)
        parts.append(label(x + width / 2, down, words, bold=i == 0))
    return "".join(parts)


def label(x: float, y: float, words: str, anchor: str = "middle", bold: bool = False) -> str:
    """Words whose base line is at y."""
    page = '<text x="{:g}" y="{:g}" text-anchor="{}" fill="currentColor" font-weight="{}">{}</text>'
    return str(html(page, x, y, anchor, 650 if bold else 400, words))


def line(x1: float, y1: float, x2: float, y2: float) -> str:
    return f'<line x1="{x1:g}" y1="{y1:g}" x2="{x2:g}" y2="{y2:g}" stroke="currentColor" stroke-width="1.5"/>'


def arrow(x1: float, y1: float, x2: float, y2: float, dashed: bool = False) -> str:
    """An arrow from the first point to the second."""
    dash, long = ' stroke-dasharray="5 4"' if dashed else "", math.hypot(x2 - x1, y2 - y1)
    across, down = TIP * (x2 - x1) / long, TIP * (y2 - y1) / long
    neck_x, neck_y = x2 - across, y2 - down
    head = (x2, y2), (neck_x - down / 2, neck_y + across / 2), (neck_x + down / 2, neck_y - across / 2)
    points = " ".join(f"{x:.1f},{y:.1f}" for x, y in head)
    ends = f'x1="{x1:g}" y1="{y1:g}" x2="{neck_x:.1f}" y2="{neck_y:.1f}"'
    return (
        f'<line {ends} stroke="currentColor" stroke-width="1.5"{dash}/><polygon points="{points}" fill="currentColor"/>'
    )
