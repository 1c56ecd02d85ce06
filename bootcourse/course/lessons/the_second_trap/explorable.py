"""To drag in this lesson: how far a speed swings around that of the traps; λ and how long a car falls back."""

from collections.abc import Callable

import numpy as np

from bootcourse.colours import GRID, INK, OTHER, QUIET
from bootcourse.learn.settings import settings_for
from bootcourse.methods import style
from bootcourse.panels.explorable import HEIGHT, WIDTH, Curve, Explorable, legend
from bootcourse.panels.number import Number, whole_number
from bootcourse.plots.svg import Drawing, SvgAxes, drawing, text
from bootcourse.road.formulas import speed_reward
from bootcourse.scenario import DEFAULT

SLOW, FAST = 5.0, 15.0  # m/s, where the speed reward begins and is largest
MEAN, MOST = DEFAULT.traps.speed, 5.0  # m/s
SECONDS, HALF = 40.0, 10  # of a drive that is shown; so long it keeps each speed
DATA = settings_for("ppo").horizon  # decisions on a road, after which PPO's data end; one a second


def paid(reward: Callable[[float], float], swing: float) -> tuple[float, float]:
    """What a second pays on average at two speeds in turn, `swing` below and above the mean, and at the mean."""
    return (reward(MEAN - swing) + reward(MEAN + swing)) / 2, reward(MEAN)


def picture(says: str, reward: Callable[[float], float], swing: float) -> Drawing:
    """The two speeds and the mean on the reward's curve, beside the two drives' speeds over time."""
    slow, fast, colour = MEAN - swing, MEAN + swing, style("ppo").colour
    turns, steady = paid(reward, swing)
    left = SvgAxes(52, 78, 300, 176, (SLOW, FAST), (0.0, 1.0))
    left.frame("speed reward of a second", "speed, m/s")
    v = np.linspace(SLOW, FAST, 101)
    left.line(v, [reward(each) for each in v], INK, 1.6)
    left.line([slow, fast], [reward(slow), reward(fast)], colour, 1.4, "--")
    left.line([MEAN, MEAN], [steady, turns], GRID, 1.2)
    for v_x, pays in ((slow, reward(slow)), (fast, reward(fast)), (MEAN, turns)):
        left.dot(v_x, pays, colour)
    left.dot(MEAN, steady, INK)
    right = SvgAxes(436, 78, 306, 176, (0.0, SECONDS), (SLOW - 1, FAST + 1))
    right.frame("speed, m/s", "time, s")
    right.line([0, SECONDS], [MEAN, MEAN], INK, 1.2)
    changes = np.arange(0, SECONDS + 1, HALF)  # s
    right.line(np.repeat(changes, 2)[1:-1], np.repeat([slow, fast, slow, fast], 2), colour, 1.6)
    named = {
        f"{slow:g} and {fast:g} m/s in turn: {turns:.2f} a second": Curve([], colour),
        f"a steady {MEAN:g} m/s: {steady:.2f}": Curve([], INK),
    }
    words = [text(4, 20, says, size=14, bold=True), *legend(named)]
    return drawing(WIDTH, HEIGHT, [*words, *left.parts, *right.parts], says)


def sprints() -> Explorable:
    """The road's own speed reward, while the two speeds move apart."""

    def draw(swing: float) -> Drawing:
        turns, steady = paid(speed_reward, swing)
        more = f"pay {turns / steady:.1f} times as much as" if turns > steady + 1e-9 else "pay the same as"
        why = ": r_v is a straight line between them" if 0 < swing and more.endswith("same as") else ""
        says = f"{MEAN - swing:g} and {MEAN + swing:g} m/s in turn {more} a steady {MEAN:g}{why}."
        return picture(says, speed_reward, swing)

    swing = Number("swing", MOST, 0, MOST, 0.5, "So far below and above 10 m/s the two speeds lie.", "m/s")
    return Explorable("What does changing pay?", draw, swing=swing)


def surprises(half: int = HALF) -> np.ndarray:
    """r_v of each second less that of a steady 10 m/s; a car falls back and then sprints, half seconds each."""
    turn = [MEAN - MOST] * half + [MEAN + MOST] * half
    return np.array([speed_reward(v) for v in turn]) - speed_reward(MEAN)


def weighted(lam: float, half: int = HALF) -> np.ndarray:
    """The terms of the first second's advantage, (seconds,), with PPO's γ: 0 where the data have ended."""
    seconds = np.arange(2 * half)
    return surprises(half) * (settings_for("ppo").gamma * lam) ** seconds * (seconds < DATA)


def later() -> Explorable:
    """What each later second adds to the advantage of falling back, while λ grows, or both parts of the drive."""

    def draw(lam: float, half: float) -> Drawing:
        terms, fulls, end = weighted(lam, int(half)), surprises(int(half)), 2.0 * half
        looks = "better" if terms.sum() > 0 else "worse"
        says = f"λ = {lam:g}: A = {terms.sum():.2f}. Falling back looks {looks} than a steady {MEAN:g} m/s."
        chart = SvgAxes(52, 62, 690, 190, (0.0, end), (-0.25, 1.1))
        chart.frame("surprise of a second: filled, as it counts; outlined, in full", "time, s")
        for second, (term, full) in enumerate(zip(terms, fulls, strict=True)):
            x = [second + 0.12, second + 0.88, second + 0.88, second + 0.12]
            if second < DATA:
                chart.fill(x, [0, 0, term, term], style("ppo").colour if term > 0 else OTHER.colour)
            chart.fill(x, [0, 0, full, full], "none", edge=QUIET)
        chart.line([0, end], [0, 0], INK, 0.8)
        if end > DATA:
            chart.line([DATA, DATA], [-0.25, 1.1], INK, 1.2, "--")
            chart.words(DATA - 0.4, -0.21, f"the data end here, at {DATA} s", INK, "end", 8)
        chart.words(half / 2, 0.12, f"falls back, {MEAN - MOST:g} m/s", INK, "middle", 8)
        chart.words(half + 0.1, 0.97, f"sprints, {MEAN + MOST:g} m/s", INK, "start", 8)
        says = says.replace("-", "−")
        return drawing(WIDTH, HEIGHT, [text(4, 20, says, size=14, bold=True), *chart.parts], says)

    lam = Number("λ", 0.95, 0, 1, 0.05, "Each surprise counts γλ times as much as the one before it.")
    says, check = "So long the car falls back, and so long it sprints.", whole_number("seconds", 5, 40)
    half = Number("seconds", HALF, 5, 40, 1, says, "s", check=check)
    return Explorable("Which later surprises count?", draw, lam=lam, half=half)
