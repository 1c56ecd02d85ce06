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


METHODS = {
    "sac": Style("#0072B2"),
    "bootstrapped": Style("#D55E00", width=2.5),  # the paper's method: drawn last and thickest
    "soft": Style("#56B4E9", "--"),
    "demos": Style("#E69F00", "--"),
    "margin": Style("#CC79A7", ":"),
    "margin_soft": Style("#CC79A7", "-."),
    "rule": Style("#009E73", width=1.0),
    "bc": Style("#444444", marker="o"),
    "cql": Style("#777777", marker="s"),
    "cql_sac": Style("#777777", "--", marker="s"),
    "gail": Style("#AAAAAA", marker="^"),
    "planner": Style("#000000", (0, (8, 4))),
}
OTHER = Style("#6F4FA0")  # any other driver: your own, idle, random

TRAP = "#7A1F1F"  # the two slow cars
TRAFFIC = "#B8BEC6"  # all other cars
ALARM = "#E8112D"  # an accident


def style(label: str) -> Style:
    """The style of a method, or of a drive whose label begins with one ("sac, seed 3" is "sac")."""
    words = label.lower().replace(",", " ").replace(":", " ").split()
    return METHODS.get(words[0] if words else "", OTHER)


def rgb(colour: str) -> tuple[int, int, int]:
    """Red, green and blue, 0..255 each, of "#rrggbb"."""
    return int(colour[1:3], 16), int(colour[3:5], 16), int(colour[5:7], 16)
