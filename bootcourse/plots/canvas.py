"""What the road and training curves are drawn on: matplotlib axes in a figure, `svg.SvgAxes` in a panel.

Both have `line`, `fill` and `words`, take the numbers of their axes (metres, episodes), widths and sizes in points, and
draw in the order of the calls. A gap in a line is a NaN.
"""

from matplotlib.axes import Axes

from bootcourse.plots.svg import SvgAxes


class MplAxes:
    """The canvas of a figure."""

    def __init__(self, ax: Axes):
        self.ax = ax

    def line(self, xs, ys, colour: str, width: float = 1, dash="-", opacity: float = 1.0) -> None:
        look = {"color": colour, "linewidth": width, "linestyle": dash, "alpha": opacity}
        self.ax.plot(xs, ys, solid_capstyle="butt", dash_capstyle="butt", zorder=2, **look)

    def fill(self, xs, ys, colour: str, opacity: float = 1.0, edge: str = "none", gid: str = "") -> None:
        self.ax.fill(xs, ys, facecolor=colour, edgecolor=edge, linewidth=0.7, alpha=opacity, gid=gid or None, zorder=2)

    def words(self, x: float, y: float, words: str, colour: str, anchor: str = "start", size: float = 7.5) -> None:
        align = {"start": "left", "middle": "center", "end": "right"}[anchor]
        self.ax.text(x, y, words, color=colour, ha=align, va="center", fontsize=size, clip_on=True, zorder=2)


Canvas = MplAxes | SvgAxes
