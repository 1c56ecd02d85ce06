"""To drag in this lesson: votes of alike states on MountainCar, and what a loop is worth beside the way to a goal."""

from functools import cache

import numpy as np

from bootcourse.colours import INK, QUIET
from bootcourse.methods import style
from bootcourse.panels.explorable import WIDTH, Explorable
from bootcourse.panels.number import Number, whole_number
from bootcourse.plots.svg import Drawing, SvgAxes, drawing, number, rect, text
from bootcourse.research.problems import PROBLEMS

SIDE = 36  # squares of the map in each direction: position 0.1 and speed 0 are at edges of squares
POSITIONS, SPEEDS = (-1.2, 0.6), (-0.07, 0.07)
FLAG, LONGEST, STARTS = 0.5, 200, np.linspace(-0.6, -0.4, 20)
SQUARES = {"as the good teacher": "#E3E8EE", "an error": "#D9604F"}  # the second is darker in grey print, too
GAMMA = PROBLEMS["doorkey"].gamma


@cache
def labels(right: float) -> dict[str, np.ndarray]:
    """The actions of two teachers in each square, (speeds, positions): random errors, and wrong above position 0.1."""
    x, speed = (low + (high - low) * (np.arange(SIDE) + 0.5) / SIDE for low, high in (POSITIONS, SPEEDS))
    good = np.broadcast_to(np.where(speed > 0, 2, 0)[:, None], (SIDE, SIDE))
    rng = np.random.default_rng(0)
    wrong = rng.random((SIDE, SIDE)) >= right
    random = (good + wrong * rng.integers(1, 3, (SIDE, SIDE))) % 3
    return {"good": good, "random": random, "systematic": (good + (x > 0.1)) % 3}


def voted(actions: np.ndarray, reach: int) -> np.ndarray:
    """What most labels say of the squares at most so far away; at a tie a square's own counts."""
    votes = np.zeros((3, *actions.shape))
    for action in range(3):
        padded = np.pad(actions == action, reach).astype(float)
        windows = np.lib.stride_tricks.sliding_window_view(padded, (2 * reach + 1, 2 * reach + 1))
        votes[action] = windows.sum((-2, -1)) + 0.5 * (actions == action)
    return votes.argmax(0)


def drives(actions: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """(positions and speeds, decisions) of 20 drives of MountainCar by a map, (decisions + 1, 2, 20) and (20,)."""
    x, speed, spent, way = STARTS.copy(), np.zeros_like(STARTS), np.zeros(len(STARTS)), []
    for _ in range(LONGEST):
        way.append((x, speed))
        column = np.clip((x - POSITIONS[0]) / np.ptp(POSITIONS) * SIDE, 0, SIDE - 1).astype(int)
        row = np.clip((speed - SPEEDS[0]) / np.ptp(SPEEDS) * SIDE, 0, SIDE - 1).astype(int)
        running = x < FLAG
        spent += running
        faster = np.clip(speed + 0.001 * (actions[row, column] - 1) - 0.0025 * np.cos(3 * x), *SPEEDS)
        to = np.clip(x + faster, *POSITIONS)
        faster = np.where((to == POSITIONS[0]) & (faster < 0), 0.0, faster)
        x, speed = np.where(running, to, x), np.where(running, faster, speed)
    return np.array([*way, (x, speed)]), spent


def reached(teacher: str, right: float, reach: int) -> int:
    """How many of 20 drives by the voted map of a teacher, right in so many squares of a hundred, reach the flag."""
    return int((drives(voted(labels(right / 100)[teacher], reach))[0][-1, 0] >= FLAG).sum())


def votes() -> Explorable:
    """What alike states vote with two teachers, as maps of MountainCar, with a drive by each."""

    def draw(right: float, reach: float) -> Drawing:
        parts, said, count = [], [], int(2 * reach + 1) ** 2
        taught = labels(right / 100)
        for place, teacher in enumerate(("random", "systematic")):
            actions = voted(taught[teacher], int(reach))
            way, spent = drives(actions)
            correct = 100 * (actions == taught["good"]).mean()
            chart = SvgAxes(52 + 350 * place, 84, 300, 160, POSITIONS, SPEEDS)
            parts += squares(chart, actions != taught["good"])
            chart.line(*way[:, :, len(STARTS) // 2].T, INK, 1.1)
            chart.line([FLAG, FLAG], SPEEDS, INK, 1.2, "--")
            up = int((way[-1, 0] >= FLAG).sum())
            parts += [
                text(chart.left, 56, f"{teacher} teacher: right in {correct:.0f} % of the squares", bold=True),
                text(chart.left, 74, f"{up} of 20 drives reach the flag; mean {spent.mean():.0f} decisions"),
                *chart.parts,
                text(chart.left + 150, 262, "position (dashes: the flag)", "middle", QUIET, 11),
            ]
            said.append(f"{teacher}: right in {correct:.0f} %, {up} of 20 up in {spent.mean():.0f} decisions")
        parts += [text(46, y, words, "end", QUIET, 11) for y, words in ((94, "speed"), (168, "0"))]
        for place, (words, colour) in enumerate(SQUARES.items()):
            parts += [rect(52 + 170 * place, 276, 14, 14, colour, f'stroke="{QUIET}"')]
            parts += [text(72 + 170 * place, 288, words)]
        says = "Each square does what its teacher says of it." if count == 1 else f"Each square asks {count}."
        return drawing(WIDTH, 300, [text(4, 20, says, size=14, bold=True), *parts], f"{says} {'; '.join(said)}.")

    numbers = {
        "right": Number("right", 70, 40, 100, 5, "The random teacher is right in so many squares of a hundred.", "%"),
        "reach": Number("reach", 0, 0, 4, 1, "A square does what most squares say that are at most so far away.",
                        check=whole_number("reach", 0, 4)),
    }  # fmt: skip
    return Explorable("What do alike states say together?", draw, **numbers)


def squares(chart: SvgAxes, wrong: np.ndarray) -> list[str]:
    """A map in a frame: a path for the errors, made of their runs of squares in a row, on the colour of the others."""
    across, up = chart.width / SIDE, chart.height / SIDE
    right, error = SQUARES.values()
    d = ""
    for row, here in enumerate(wrong):
        edges = np.flatnonzero(np.diff(np.concatenate([[0], here.astype(int), [0]])))
        for begin, end in zip(edges[::2], edges[1::2], strict=True):
            x, y = chart.left + begin * across, chart.top + (SIDE - 1 - row) * up
            d += f"M{x:.1f} {y:.1f}h{(end - begin) * across:.1f}v{up:.1f}H{x:.1f}Z"
    frame = rect(chart.left, chart.top, chart.width, chart.height, right, f'stroke="{QUIET}" stroke-width="0.8"')
    return [frame, f'<path d="{d}" fill="{error}" shape-rendering="crispEdges"/>']


def worths(bonus: float, decisions: int, gamma: float = GAMMA) -> tuple[float, float, float]:
    """What is worth, discounted: a loop that pays the bonus for ever; the bonuses on the way to the goal; the goal, 1.

    The whole way is in the demonstrations, so each of its decisions pays the bonus.
    """
    return bonus / (1 - gamma), bonus * (1 - gamma**decisions) / (1 - gamma), gamma ** (decisions - 1)


def loop_or_goal() -> Explorable:
    """The worth of a loop and of the way to the goal as two bars, while the bonus and the way's length move."""
    colour, goal_colour = style("demos").colour, style("rule").colour

    def draw(bonus: float, way: float) -> Drawing:
        loop, paid, goal = worths(bonus, int(way))
        better = "the loop is worth more" if loop > paid + goal else "the goal is worth more"
        says = f"c = {number(bonus)}, {way:g} decisions to the goal: {better}."
        scale, parts = 560 / max(loop, paid + goal), []
        bars = {"the loop, for ever": (loop, 0.0), "the way to the goal": (paid, goal)}
        for place, (words, (bonuses, last)) in enumerate(bars.items()):
            y = 60 + 62 * place
            parts += [text(52, y - 6, words, bold=True), rect(52, y, scale * bonuses, 26, colour)]
            parts += [rect(52 + scale * bonuses, y, scale * last, 26, goal_colour)]
            parts += [text(60 + scale * (bonuses + last), y + 18, f"{bonuses + last:.3g}", bold=True)]
        for place, (words, look) in enumerate({"bonuses": colour, "the goal, 1": goal_colour}.items()):
            parts += [rect(52 + 110 * place, 170, 14, 14, look), text(72 + 110 * place, 182, words)]
        parts.append(text(300, 182, f"worth now, discounted by γ = {GAMMA:g}", fill=QUIET))
        alt = f"{says} Loop: {loop:.3g}; way: {paid:.3g} of bonuses and {goal:.3g} of the goal."
        return drawing(WIDTH, 196, [text(4, 20, says, size=14, bold=True), *parts], alt)

    numbers = {
        "bonus": Number("c", 0.3, 0.001, 2, 0.05, "Each decision of a demonstration pays so much.", logarithmic=True),
        "way": Number("way", 12, 2, 90, 1, "So many decisions lead to the goal, all in the demonstrations.",
                      check=whole_number("way", 2, 90)),
    }  # fmt: skip
    return Explorable("A loop or the goal?", draw, **numbers)
