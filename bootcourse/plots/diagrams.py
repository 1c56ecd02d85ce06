"""Diagrams of boxes and arrows, as SVG. `bootcourse.show` displays them as it does figures, in light and in dark."""

import math
from collections.abc import Mapping, Sequence

from bootcourse.colours import INK
from bootcourse.markup import html
from bootcourse.plots.figure import Picture
from bootcourse.plots.svg import FONT

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
        return self.alt


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


def agent_loop(observation: str, action: str, reward: str) -> Diagram:
    """The loop of an agent and its environment, with a few words about what passes between them each second."""
    parts = [
        box(195, 8, 170, 60, ("agent", "its policy chooses"), "learned"),
        box(195, 152, 170, 60, ("road", "one second passes"), "world"),
        *(line(365, 38, 440, 38), line(440, 38, 440, 182), arrow(440, 182, 366, 182)),
        *(line(195, 170, 130, 170), line(130, 170, 130, 26), arrow(130, 26, 194, 26)),
        *(line(195, 194, 108, 194), line(108, 194, 108, 50), arrow(108, 50, 194, 50)),
        *(label(452, 106, "action", "start", bold=True), label(452, 124, action, "start")),
        *(label(142, 106, "observation", "start", bold=True), label(142, 124, observation, "start")),
        *(label(98, 106, "reward", "end", bold=True), label(98, 124, reward, "end")),
    ]
    alt = (
        "The agent and the road in a loop. Each second the road gives the agent an observation and a reward, and the "
        f"agent gives the road an action. Observation: {observation}. Reward: {reward}. Action: {action}."
    )
    return Diagram(560, 220, parts, alt)


SAC_PARTS: Mapping[str, tuple] = {  # name -> left, top, lines, tint; each 140 wide and 64 high
    "world": (8, 30, ("world", "road or pole"), "world"),
    "actor": (230, 30, ("actor π", "chooses actions"), "learned"),
    "temperature": (452, 30, ("temperature α", "worth of a nat"), "learned"),
    "buffer": (8, 220, ("replay buffer", "what happened"), "stored"),
    "critics": (230, 220, ("critics Q₁, Q₂", "judge actions"), "learned"),
    "targets": (452, 220, ("target critics", "slow copies"), "stored"),
}


def sac_diagram() -> Diagram:
    """Soft actor-critic: what acts, what is learned, what is stored, and what passes between them."""
    parts = [box(left, top, 140, 64, lines, tint) for left, top, lines, tint in SAC_PARTS.values()]
    parts += [
        arrow(230, 50, 150, 50), label(190, 42, "action"),
        arrow(150, 76, 228, 76), label(190, 96, "state"),
        arrow(78, 96, 78, 218), label(86, 150, "s, a, r, s′,", "start"), label(86, 168, "terminated", "start"),
        arrow(150, 252, 228, 252), label(190, 272, "batch"),
        line(190, 252, 190, 170), arrow(190, 170, 250, 97), label(198, 190, "batch", "start"),
        arrow(300, 218, 300, 97), label(292, 196, "min Q", "end"),
        arrow(370, 50, 450, 50), label(411, 42, "entropy"),
        arrow(452, 76, 372, 76), label(411, 96, "α"),
        arrow(452, 240, 372, 240), label(411, 232, "target y"),
        arrow(370, 268, 450, 268, dashed=True), label(411, 290, "share τ"),
        arrow(366, 96, 470, 218), label(426, 150, "π(s′), for V(s′)", "start"),
    ]  # fmt: skip
    alt = (
        "A diagram of soft actor-critic. The actor sends actions to the world and sees its states. The world's "
        "transitions go into the replay buffer. Batches from the buffer train two critics and the actor, which makes "
        "the smaller of the critics' values large. Slow copies of the critics, the target critics, give the critics "
        "their target, together with the actor's policy in the next state. The temperature α follows the actor's "
        "entropy."
    )
    return Diagram(600, 296, parts, alt)
