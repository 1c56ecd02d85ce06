"""What every figure shares: its paper, ink and letters, its alt text, and how it is shown and saved.

A figure is a `matplotlib.figure.Figure` made without pyplot, so nothing is shown twice and nothing
stays in memory. `finish` gives it a title and `figure.alt`: the sentences for those who cannot see it.
"""

import base64
import io
import re
import textwrap
from pathlib import Path

import numpy as np
import scipy
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from PIL import Image
from PIL.PngImagePlugin import PngInfo

from bootcourse.colours import GRID, INK, QUIET, STRANGERS, Style
from bootcourse.files import check_replaceable, write_bytes
from bootcourse.markup import html
from bootcourse.methods import has_style, style
from bootcourse.terminal import printable

DPI = 110
WIDTH = 7.0  # inches
TITLE, TEXT, SMALL = 11.5, 8.5, 7.5  # points
TIES = re.compile(  # the spaces of a title at which no line ends
    r"(?<=\btrap) (?=\d)|(?<=\d) (?=%|(?:s|m|m/s|nats|of \d+)\b)|(?<=\d of) (?=\d)| (?=[=/−] )|(?<= [=/−]) "
)


def styles(labels: list[str]) -> list[Style]:
    """The style of each label: a method's or driver's own, else another colour for each; if alike, another line."""
    strangers = [label for label in dict.fromkeys(labels) if not has_style(label)]
    chosen, taken = [], {}
    for label in labels:
        own = STRANGERS[strangers.index(label) % len(STRANGERS)] if label in strangers else style(label)
        lines = [*dict.fromkeys((own.line, "-", "--", "-.", ":"))]
        used = taken.setdefault(own.colour, {})
        line = used.setdefault(label, lines[len(used) % len(lines)])
        chosen.append(own._replace(line=line))
    return chosen


def in_front(label: str) -> float:
    """The drawing order of a method: the paper's own comes last."""
    return 3.0 if style(label) == style("bootstrapped") else 2.5


def new_figure(height: float = 4.0, width: float = WIDTH) -> Figure:
    """An empty figure; inches."""
    return Figure(figsize=(width, height), dpi=DPI, facecolor="white")


def axes_at(figure: Figure, left: float, top: float, width: float, height: float) -> Axes:
    """New axes of that size in a figure, their top left corner at (left, top) from the figure's; inches."""
    whole_width, whole_height = figure.get_size_inches()
    below = 1 - (top + height) / whole_height
    return figure.add_axes((left / whole_width, below, width / whole_width, height / whole_height))


def finish(figure: Figure, title: str, alt: str) -> Figure:
    """Write the title at the top left and attach the alt text. Each line of the title is a sentence."""
    top = 1 - 0.1 / figure.get_figheight()
    figure.suptitle(wrapped(title), x=0.012, y=top, ha="left", va="top", fontsize=TITLE, fontweight="bold", color=INK)
    sentences = [line if line.endswith((".", "!", "?")) else f"{line}." for line in title.splitlines()]
    figure.alt = " ".join([*sentences, *alt.splitlines()])
    return figure


def wrapped(title: str, longest: int = 68) -> str:
    """A title that is too long for one line gets two, of about the same length. "trap 1" and "γ = 0.8" stay whole."""
    if len(title) <= longest or "\n" in title:
        return title
    spaces = {i for i, letter in enumerate(title) if letter == " "} - {tie.start() for tie in TIES.finditer(title)}
    middle = min(spaces, key=lambda i: abs(i - len(title) / 2), default=0)
    return title[:middle] + "\n" + title[middle + 1 :] if middle else title


def plain_axes(ax, label: str, grid: str = "y") -> None:
    """Thin axes with their label written above, horizontally."""
    for side in ("top", "right", "left"):
        ax.spines[side].set_visible(False)
    ax.spines["bottom"].set_color(GRID)
    ax.tick_params(labelsize=SMALL, labelcolor=QUIET, color=GRID, length=3)
    ax.tick_params(axis="y", length=0)
    if grid:
        ax.grid(axis=grid, color=GRID, linewidth=0.7)
    ax.set_axisbelow(True)
    ax.set_ylabel(label, rotation=0, ha="left", va="bottom", fontsize=TEXT, color=INK)
    ax.yaxis.set_label_coords(0.0, 1.03)


def one_axes(height: float, title: str, x_label: str, y_label: str, width: float = 0.89) -> tuple[Figure, Axes]:
    """A figure of one axes with its labels, below the room that the title takes; `width`: its share of the figure."""
    figure, top = new_figure(height), 0.46 + 0.2 * len(wrapped(title).splitlines())
    ax = figure.add_axes((0.085, 0.56 / height, width, 1 - (0.56 + top) / height))
    plain_axes(ax, y_label)
    ax.set_xlabel(x_label, fontsize=TEXT, color=INK)
    return figure, ax


def label_ends(
    ax, ends: list[tuple[float, str, str]], size: float = TEXT, wrap: int = 20, gap: float = 0.015
) -> np.ndarray:
    """Direct labels: write each (y, text, colour) to the right of the axes, moved apart where they meet.

    The axes must have their final limits and position. Returns where the labels are, in shares of the axes' height.
    """
    if not ends:
        return np.zeros(0)
    figure = ax.get_figure(root=True)
    pixels = ax.get_window_extent().height
    rows = [textwrap.fill(text.replace(" = ", "\u00a0=\u00a0"), wrap) for _, text, _ in ends]  # "c = 2" stays
    heights = np.array([(text.count("\n") + 1) * size * 1.25 * figure.dpi / 72 / pixels for text in rows])
    low, high = ax.get_ylim()
    wanted = np.clip([(y - low) / (high - low) for y, _, _ in ends], 0, 1)
    places = _apart(wanted, heights)
    for place, text, (_, _, colour) in zip(places, rows, ends, strict=True):
        look = {"color": colour, "fontsize": size, "va": "center", "ha": "left", "linespacing": 1.1}
        ax.text(1 + gap, place, text, transform=ax.transAxes, **look)
    return places


def _apart(wanted: np.ndarray, heights: np.ndarray) -> np.ndarray:
    """Places as near to the wanted ones as labels of these heights allow, in the same order, the lowest at 0 or above.

    A label lower than 0 would touch the last number of the x axis.
    """
    order = np.argsort(wanted, kind="stable")
    sizes = heights[order]
    stacked = np.append(0, np.cumsum((sizes[:-1] + sizes[1:]) / 2))  # the labels one on the other, from 0 on
    places = np.empty(len(wanted))
    places[order] = stacked + np.maximum(scipy.optimize.isotonic_regression(wanted[order] - stacked).x, 0)
    return places


def png(figure: Figure) -> bytes:
    """The figure as a PNG whose description is its alt text."""
    buffer = io.BytesIO()
    as_written(figure).savefig(buffer, format="png", metadata={"Description": figure.alt, "Software": "bootcourse"})
    return buffer.getvalue()


def with_fewer_colours(data: bytes) -> bytes:
    """The same PNG with its words and 256 colours, of a third of the size: more of them are shades at lines' edges."""
    picture, words, buffer = Image.open(io.BytesIO(data)), PngInfo(), io.BytesIO()
    for name, text in picture.text.items():
        words.add_text(name, text)
    reduced = picture.convert("RGB").quantize(256, Image.Quantize.MEDIANCUT, dither=Image.Dither.NONE)
    reduced.save(buffer, "PNG", optimize=True, pnginfo=words)
    return buffer.getvalue()


def as_written(figure: Figure) -> Figure:
    """Draw a $ in a driver's label as a $, not as the start of a formula; our own formulas are on the axes."""
    for words in (*figure.texts, *(words for ax in figure.axes for words in ax.texts)):
        words.set_parse_math(False)
    return figure


def save(figure: Figure, path: Path) -> Path:
    """Write the figure, all or nothing: .png, .pdf or .svg by its name. Returns the path.

    Raises BootcourseError for another name, for a file that is not such a picture, or if the disk refuses.
    """
    path = check_replaceable(path, ".png", ".pdf", ".svg")
    if path.suffix.lower() == ".png":
        data = with_fewer_colours(png(figure))
    else:
        buffer = io.BytesIO()
        as_written(figure).savefig(buffer, format=path.suffix.lstrip(".").lower())
        data = buffer.getvalue()
    write_bytes(path, data)
    return path


# In JupyterLab's dark theme a figure turns dark: light and dark change places, and the colours stay what they are.
# On a narrow page it stays wide enough to be read, and the page scrolls. (The book says both in its style.css.)
DARK = '<style>body[data-jp-theme-light="false"] .bc-figure { filter: invert(0.93) hue-rotate(180deg); }</style>'
READABLE = "max-width: max(100%, 600px)"
FOLDED = "<!-- a figure -->\n"  # the first line, which JupyterLab shows of a folded output


class Picture:
    """A figure or a diagram as a notebook displays it: an <img> with its alt text.

    JupyterLab drops the alt text of a plain PNG output (nbconvert keeps it), and both leave an HTML
    output's <img alt="..."> as it is. So the output is HTML, the picture inside it; where there are no
    pictures at all, in a terminal or a diff, the alt text stands alone.
    """

    def __init__(self, figure: "Figure | Diagram"):  # noqa: F821 (diagrams.py, which draws without matplotlib)
        self.figure = figure

    def _repr_mimebundle_(self, include=None, exclude=None) -> dict[str, str]:
        if isinstance(self.figure, Figure):
            kind, data, width = "image/png", png(self.figure), round(self.figure.get_figwidth() * DPI)
        else:
            kind, data, width = "image/svg+xml", self.figure.svg.encode(), self.figure.width
        img = '<img src="data:{};base64,{}" class="bc-figure" width="{}" style="{}" alt="{}">'
        img = html(img, kind, base64.b64encode(data).decode(), width, READABLE, self.figure.alt)
        return {"text/html": f"{FOLDED}{DARK}{img}", "text/plain": self.figure.alt}

    def __repr__(self) -> str:
        return printable(self.figure.alt)


def show(figure: "Figure | Diagram") -> None:  # noqa: F821
    """Display a figure or a diagram in a notebook, with its alt text (see `Picture`), anywhere in a cell."""
    from IPython.display import display

    display(Picture(figure))
