"""Every colour of the course, in one place: figures, panels and the 3D replay take them from here.

The colours stay apart for colour-blind eyes and in grey print; a line's style says the same once
more. A drive is coloured by its label, which names who drove: "sac", "rule", "bootstrapped" ...
"""

from typing import NamedTuple


class Style(NamedTuple):
    """How a method is drawn."""

    colour: str  # "#rrggbb"
    line: str | tuple = "-"  # a matplotlib line style
    width: float = 1.5  # points
    marker: str | None = None  # a matplotlib marker


OTHER = Style("#6F4FA0")  # any other driver: your own, idle, random

TRAP = "#7A1F1F"  # the two slow cars
TRAFFIC = "#B8BEC6"  # all other cars
ALARM = "#E8112D"  # an accident

INK, QUIET, GRID = "#1F2933", "#5F6B77", "#E3E7EB"  # words and axes; less important words; grid lines
ASPHALT, PAINT, EDGE = "#F1F3F5", "#B6BEC7", "#7C8792"  # the road from above: its face, lane lines, edges


def rgb(colour: str) -> tuple[int, int, int]:
    """Red, green and blue, 0..255 each, of "#rrggbb"."""
    return int(colour[1:3], 16), int(colour[3:5], 16), int(colour[5:7], 16)
