"""Diagrams of boxes and arrows, as SVG text: what talks to what. `bootcourse.show` displays them as it does figures."""

from dataclasses import dataclass, field
from html import escape

from bootcourse.colours import ASPHALT, EDGE, INK, QUIET
from bootcourse.plots.svg import drawing, rect, text

HEAD = 8  # pixels, the length of an arrow's head


@dataclass
class Diagram:
    """A drawing of width x height pixels; alt is what it says to somebody who cannot see it."""

    width: float
    height: float
    alt: str
    parts: list[str] = field(default_factory=list)

    def box(self, x: float, y: float, width: float, height: float, title: str, *rows: str, colour: str = EDGE) -> None:
        """A box with its top left corner at (x, y): a title, and rows of smaller words below it."""
        self.parts.append(rect(x, y, width, height, ASPHALT, f'stroke="{colour}" stroke-width="1.6" rx="7"'))
        top = y + height / 2 - 8.5 * len(rows) + 5
        self.parts.append(text(x + width / 2, top, title, "middle", INK, 14, bold=True))
        for i, row in enumerate(rows, start=1):
            self.parts.append(text(x + width / 2, top + 17 * i, row, "middle", QUIET, 12))

    def arrow(self, *points: tuple[float, float], colour: str = INK, dash: str = "") -> None:
        """A line through the points, horizontal or vertical pieces, with a head at the last one."""
        (x0, y0), (x1, y1) = points[-2:]
        dx, dy = (x1 > x0) - (x1 < x0), (y1 > y0) - (y1 < y0)
        back = (x1 - HEAD * dx, y1 - HEAD * dy)
        path = "L".join(f"{x:g} {y:g}" for x, y in (*points[:-1], back))
        dashes = f' stroke-dasharray="{dash}"' if dash else ""
        self.parts.append(f'<path d="M{path}" fill="none" stroke="{colour}" stroke-width="1.8"{dashes}/>')
        sides = [(back[0] + s * 4.5 * dy, back[1] + s * 4.5 * dx) for s in (-1, 1)]
        head = " ".join(f"{x:g},{y:g}" for x, y in ((x1, y1), *sides))
        self.parts.append(f'<polygon points="{head}" fill="{colour}"/>')

    def words(self, x: float, y: float, *rows: str, anchor: str = "middle", colour: str = INK) -> None:
        """Rows of words; (x, y) is where the base line of the first is anchored."""
        self.parts += [text(x, y + 16 * i, row, anchor, colour, 12.5) for i, row in enumerate(rows)]

    @property
    def svg(self) -> str:
        return drawing(self.width, self.height, self.parts, self.alt)

    def html_image(self) -> tuple[str, bytes, float]:
        """Kind, content and width in pixels, for an <img>."""
        return "image/svg+xml", self.svg.encode(), self.width

    def __repr__(self) -> str:
        return escape(self.alt)


def agent_loop(observation: str, action: str, reward: str) -> Diagram:
    """The loop of an agent and its environment, with a few words about what goes through it each second."""
    alt = (
        "The agent and the road in a loop. Each second the road gives the agent an observation and a reward, and the "
        f"agent gives the road an action. Observation: {observation}. Reward: {reward}. Action: {action}."
    )
    diagram = Diagram(560, 232, alt)
    diagram.box(195, 12, 170, 58, "Agent", "its policy chooses")
    diagram.box(195, 162, 170, 58, "Road", "goes on for one second")
    diagram.arrow((365, 41), (430, 41), (430, 191), (365, 191))
    diagram.arrow((195, 180), (130, 180), (130, 30), (195, 30))
    diagram.arrow((195, 202), (108, 202), (108, 52), (195, 52), dash="5 4")
    diagram.words(442, 112, "action", action, anchor="start")
    diagram.words(142, 96, "observation", observation, anchor="start")
    diagram.words(98, 122, "reward", reward, anchor="end")
    return diagram
