"""Drawing for panels: SVG as text, which reaches the page in a fraction of the time that a picture takes.

Lengths are pixels of a drawing that shrinks with its column. Ink and paper follow JupyterLab's theme,
light or dark; outside it they are the colours of the figures.
"""

import re
from collections.abc import Sequence
from html import escape

INK, QUIET, GRID = (
    "var(--jp-ui-font-color1, #1F2933)",
    "var(--jp-ui-font-color2, #5F6B77)",
    "var(--jp-border-color2, #E3E7EB)",
)
FONT = "system-ui, -apple-system, 'Segoe UI', sans-serif"


def drawing(width: float, height: float, parts: Sequence[str], alt: str) -> str:
    """A whole SVG; alt is what a screen reader says."""
    return (
        f'<svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 {width:g} {height:g}" width="{width:g}" '
        f'height="{height:g}" role="img" aria-label="{escape(alt)}" font-family="{FONT}" font-size="12">'
        f"<title>{escape(alt)}</title>{''.join(parts)}</svg>"
    )


def printed(svg: str) -> bytes:
    """The same for a reader outside JupyterLab: on white, in the figures' colours."""
    plain = re.sub(r"var\(--[\w-]+, (#\w+)\)", r"\1", svg)
    return plain.replace("</title>", '</title><rect width="100%" height="100%" fill="white"/>', 1).encode()


def text(
    x: float, y: float, words: str, anchor: str = "start", fill: str = INK, size: float = 12, bold: bool = False
) -> str:
    """Words whose base line is at y; anchor: "start", "middle" or "end"."""
    weight = 650 if bold else 400
    look = f'text-anchor="{anchor}" fill="{fill}" font-size="{size:g}" font-weight="{weight}"'
    return f'<text x="{x:.1f}" y="{y:.1f}" {look}>{escape(words)}</text>'


def rect(x: float, y: float, width: float, height: float, fill: str, more: str = "") -> str:
    width, height = max(width, 0), max(height, 0)
    return f'<rect x="{x:.2f}" y="{y:.2f}" width="{width:.2f}" height="{height:.2f}" fill="{fill}" {more}/>'


def line(x1: float, y1: float, x2: float, y2: float, stroke: str = GRID, width: float = 1, more: str = "") -> str:
    ends = f'x1="{x1:.2f}" y1="{y1:.2f}" x2="{x2:.2f}" y2="{y2:.2f}"'
    return f'<line {ends} stroke="{stroke}" stroke-width="{width:g}" {more}/>'


def path(points: Sequence[tuple[float, float]], stroke: str, width: float = 1.5, more: str = "") -> str:
    """A polyline."""
    d = "M" + "L".join(f"{x:.1f} {y:.1f}" for x, y in points)
    return f'<path d="{d}" fill="none" stroke="{stroke}" stroke-width="{width:g}" {more}/>'
