"""The colours of figures, panels and the 3D replay; the methods' colours are in `methods.py`.

They are distinguishable for colour-blind readers and in grey print; line styles differ as well.
"""

from typing import NamedTuple


class Style(NamedTuple):
    """The line of a method in figures."""

    colour: str  # "#rrggbb"
    line: str | tuple = "-"  # a matplotlib line style
    width: float = 1.5  # points
    marker: str | None = None  # a matplotlib marker


OTHER = Style("#6F4FA0")  # other drivers: you, idle, random
STRANGERS = (  # names that are neither a method nor a driver, in the order in which a figure meets them
    OTHER, Style("#117733", "--"), Style("#D9668A", "-."), Style("#661100", ":"),
)  # fmt: skip

TRAP = "#7A1F1F"  # the two slow cars
TRAFFIC = "#B8BEC6"  # all other cars
ALARM = "#E8112D"  # an accident
PALE = "#A9CFE6"  # a light tint of plain SAC's blue

INK, QUIET, GRID = "#1F2933", "#5F6B77", "#E3E7EB"  # text and axes; secondary text; grid lines
ASPHALT, PAINT, EDGE = "#F1F3F5", "#B6BEC7", "#7C8792"  # the road from above: surface, lane lines, edges


def rgb(colour: str) -> tuple[int, int, int]:
    """Red, green and blue, 0..255 each, of "#rrggbb"."""
    return int(colour[1:3], 16), int(colour[3:5], 16), int(colour[5:7], 16)
