"""The nine imagined drives of a look-ahead on the road from above: thin, accidents red, the chosen one bold."""

from typing import NamedTuple

import numpy as np
from matplotlib.colors import Colormap, LinearSegmentedColormap, to_hex

from bootcourse.colours import ALARM
from bootcourse.episodes.lookahead import Imagined
from bootcourse.scenario import ACTION_NAMES

# From the worst safe drive to the best: on a light road and on that of a dark theme; on the grey road of the 3D replay.
SHADES = LinearSegmentedColormap.from_list("value", ["#AFC6D8", "#1B79C4"])
BRIGHT = LinearSegmentedColormap.from_list("value in 3D", ["#A3B1BE", "#35C4FF"])
LEGEND = "bluer: worth more; red: ends in an accident"


class Trail(NamedTuple):
    """An imagined drive, to be drawn on the road."""

    x: np.ndarray  # (points,) m along the road
    y: np.ndarray  # (points,) m, to the right of the leftmost lane's centre
    colour: str
    chosen: bool
    action: int  # the first
    hurt: bool  # ends in an accident


def trails(imagined: Imagined, chosen: int, road: int = 0, shades: Colormap = SHADES) -> list[Trail]:
    """The nine drives of one road: those of less value first, so that the best lie on top, and the chosen one last."""
    values, hurt, paths = imagined.values[road], imagined.accidents[road] > 0, imagined.paths[road]
    safe = values[~hurt]
    spread = np.ptp(safe) if len(safe) > 1 and np.ptp(safe) > 0 else 1.0
    order = sorted(range(len(values)), key=lambda action: (action == chosen, values[action]))
    colours = [
        ALARM if end else to_hex(shades((value - safe.min()) / spread)) for value, end in zip(values, hurt, strict=True)
    ]
    return [Trail(*paths[i].T, colours[i], i == chosen, i, bool(hurt[i])) for i in order]


def in_words(imagined: Imagined, road: int = 0) -> str:
    """ "3 of 9 imagined drives end in an accident; the best begins with keep straight"."""
    values, hurt = imagined.values[road], imagined.accidents[road] > 0
    best = ACTION_NAMES[values.argmax()]
    return f"{hurt.sum()} of {len(values)} imagined drives end in an accident; the best begins with {best}"
