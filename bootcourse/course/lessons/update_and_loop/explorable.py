"""To drag in this lesson: poles, push by push; and γ, for what the last pushes are worth before a fall and before the
end of the time.
"""

from collections.abc import Sequence

import numpy as np

from bootcourse.colours import INK, OTHER, QUIET, STRANGERS, Style
from bootcourse.course.lessons.update_and_loop import numbers
from bootcourse.learn import sac
from bootcourse.panels.explorable import WIDTH, Axes, Curve, Explorable, curves
from bootcourse.panels.number import Number
from bootcourse.plots.svg import Drawing, drawing, line, rect, text
from bootcourse.research.experiments import checks

LAST = 40  # pushes before the fall that are shown
AXES = Axes("pushes from the end (−1: the last push)", "Q of a push, once learned", (0.0, 55.0))


def the_end() -> Explorable:
    """What the last pushes before a fall, or before the end of the time, are worth: each pays 1, while γ moves."""

    def draw(gamma: float) -> Drawing:
        knows, following = np.empty(LAST), 0.0
        for left in range(LAST):  # the last push is the one that ends the episode
            following = knows[left] = sac.critic_target(1.0, left == 0, following, gamma)
        forgets = np.full(LAST, 1 / (1 - gamma))
        knows = knows[::-1]  # in the order of time
        named = {
            "the pole falls": Curve(knows, STRANGERS[1].colour, "--"),
            "only the time is up: the pole stands on": Curve(forgets, OTHER.colour),
        }
        says = f"γ = {gamma:g}: Q of the last push is {knows[-1]:.3g} and {forgets[-1]:.3g}."
        return curves(says, AXES, np.arange(-LAST, 0), named, mark=-1)

    gamma = Number("γ", 0.97, 0.5, 0.98, 0.01, "What a reward one push later is worth, as a share of one now.")
    return Explorable("Does the critic know that the pole will fall?", draw, gamma=gamma)


BUG = Style(STRANGERS[3].colour, "--")  # an agent in whose rows no fall is marked

# Two poles -----------------------------------------------------------------------------------------------

SHOWN = 30  # pushes that can be looked at
METRE, LENGTH, GROUND = 70, 130, 180  # pixels: of a metre, of a pole, and of the track's height in the picture


PUSHES = {  # two agents of the experiment `pole` with seed 1, after one block: what they do first from one start
    "agent 1": "010101010011010011001100101010",
    "agent 2": "11111111",  # in its rows no fall is marked
}


def episode(pushes: str) -> np.ndarray:
    """The states (T + 1, 4) that these pushes lead through, as gymnasium scales them."""
    env = checks.cartpole()
    states = [env.reset(seed=0)[0], *(env.step(int(push))[0] for push in pushes)]
    return np.array(states) * checks.CARTPOLE_SCALES


def two_poles() -> Explorable:
    """The poles of two agents, while the push moves."""
    return beside({name: episode(pushes) for name, pushes in PUSHES.items()}, (OTHER, BUG))


def beside(drives: dict[str, np.ndarray], looks: Sequence[Style]) -> Explorable:
    """Two poles beside each other. At first the push is shown at which one has fallen.

    drives: {name: the states of an episode, until the pole falls or `SHOWN` pushes are made}.
    """
    first = min(SHOWN, *(len(states) - 1 for states in drives.values()))

    def draw(push: float) -> Drawing:
        parts, says, done = [], [], round(push)
        for middle, (name, states), look in zip((190, 570), drives.items(), looks, strict=True):
            last = len(states) - 1
            x, _, angle, _ = states[min(done, last)]
            fell = done >= last and last < SHOWN
            leans = f"{abs(np.degrees(angle)):.0f}°"
            words = f"fell at push {last} ({leans})" if fell else f"leans by {leans}"
            says.append(f"{name} {words}")
            parts += [text(middle, GROUND + 20, name, "middle"), *cart(middle, x, angle, look.colour)]
        sentence = f"Push {done}: {', '.join(says)}."
        return drawing(WIDTH, GROUND + 30, [text(4, 20, sentence, size=14, bold=True), *parts], sentence)

    push = Number("push", first, 0, SHOWN, 1, "How many pushes have been made.")
    return Explorable("Who balances the pole?", draw, push=push)


def cart(middle: float, x: float, angle: float, colour: str) -> list[str]:
    """A cart x m from the middle of its track, its pole, and dashed where a pole counts as fallen. angle: rad."""
    place, top, limit = middle + METRE * x, GROUND - 18, np.radians(numbers.fallen_at())

    def pole(angle: float, colour: str, width: float, more: str = "") -> str:
        return line(place, top, place + LENGTH * np.sin(angle), top - LENGTH * np.cos(angle), colour, width, more)

    return [
        line(middle - 2.4 * METRE, GROUND, middle + 2.4 * METRE, GROUND, QUIET),
        rect(place - 25, top, 50, 18, INK),
        pole(angle, colour, 6),
        *(pole(side * limit, QUIET, 1, 'stroke-dasharray="4 4"') for side in (-1, 1)),
    ]
