"""To drag in this lesson: three values, the temperature and the policy that they make; two targets; how many estimates
err; a target entropy.
"""

import math

import numpy as np
import torch
from scipy.stats import norm

from bootcourse.colours import INK, OTHER
from bootcourse.learn import sac
from bootcourse.methods import style
from bootcourse.panels.explorable import WIDTH, Axes, Curve, Explorable, curves, legend
from bootcourse.panels.number import Number
from bootcourse.plots.svg import Drawing, SvgAxes, drawing, text

ACTIONS = ("left", "straight", "right")
START, ALPHA = (0.9, 1.0, 0.5), 0.3  # Q of these actions and α, as the panel opens
CHANCES, STACK = (52, 62, 370, 190), (478, 62, 264, 190)  # left, top, width and height of the charts, pixels


def undecided() -> Explorable:
    """π ∝ exp(Q / α) of three actions, its entropy and what the state is worth with it, while Q and α move."""

    def draw(alpha: float, **values: float) -> Drawing:
        q, temperature = torch.tensor([list(values.values())], dtype=torch.float64), torch.tensor([alpha])
        log_pi = sac.log_policy(q / alpha)
        entropy, value = float(sac.entropy(log_pi)), float(sac.soft_value(log_pi, q, temperature))
        says = f"Its entropy is {entropy:.2f} nats, and the state is worth {value:.2f}."
        chances, best = SvgAxes(*CHANCES, (0.0, 3.0), (0.0, 1.0)), float(q.max())
        chances.scale("probability of each action, by the best policy")
        for place, chance in enumerate(log_pi.exp()[0].tolist()):
            _bar(chances, place + 0.15, place + 0.85, 0, chance, style("sac").colour)
        worth = SvgAxes(*STACK, (0.0, 1.0), (0.0, 1.5 * max(1.0, best, value / 1.4)))
        worth.scale("what the state is worth")
        _bar(worth, 0.1, 0.45, 0, value - alpha * entropy, style("sac").colour)
        _bar(worth, 0.1, 0.45, value - alpha * entropy, value, OTHER.colour)
        worth.line([0.0, 0.52], [best, best], INK, 1.2, "--")
        names = (
            ("mean of Q", style("sac").colour),
            ("pay, α · entropy", OTHER.colour),
            (f"dashed: {best:g}, if it is", INK),
        )
        downs = (82, 102, 148)  # between the grid lines
        key = [text(STACK[0] + 0.56 * STACK[2], down, words, "start", colour, 12)
               for down, (words, colour) in zip(downs, names, strict=True)]  # fmt: skip
        key.append(text(STACK[0] + 0.56 * STACK[2], 162, "sure of the best", "start", INK, 12))
        under = [text(chances.at(place + 0.5, 0)[0], CHANCES[1] + CHANCES[3] + 16, name, "middle", INK, 12)
                 for place, name in enumerate(ACTIONS)]  # fmt: skip
        parts = [text(4, 20, says, size=14, bold=True), *chances.parts, *worth.parts, *key, *under]
        return drawing(WIDTH, CHANCES[1] + CHANCES[3] + 30, parts, says)

    values = {
        name: Number(f"Q({name})", start, 0, 2, 0.05, f"What it is worth to go {name} now.")
        for name, start in zip(ACTIONS, START, strict=True)
    }
    help = "The temperature: what one nat of indecision is worth."
    alpha = Number("α", ALPHA, 0.03, 3, 0.05, help, logarithmic=True)  # 0.3 is one of the page's positions
    return Explorable("What does an agent do that is paid for being undecided?", draw, alpha=alpha, **values)


def _bar(chart: SvgAxes, left: float, right: float, low: float, high: float, colour: str) -> None:
    chart.fill([left, right, right, left], [low, low, high, high], colour)


NEXT, REWARD, GAMMA = (1.0, 3.0), 1.0, 0.9  # Q of two actions in s', the reward before it, the discount
TARGETS = Axes("π(right) in s'", "target", (1.5, 4.5))


def backup() -> Explorable:
    """The target of a decision by the plain and by the soft Bellman equation, over the policies of the next state."""
    right = np.linspace(0, 1, 101)
    pi = torch.tensor(np.stack([1 - right, right], axis=-1))
    log_pi, q = pi.clamp(min=1e-12).log(), torch.tensor(NEXT, dtype=torch.float64).expand(101, 2)
    plain = REWARD + GAMMA * max(NEXT)

    def draw(right_now: float, alpha: float) -> Drawing:
        value = sac.soft_value(log_pi, q, torch.tensor(alpha, dtype=torch.float64))
        soft = (REWARD + GAMMA * value).numpy()
        named = {
            "plain: r + γ max Q": Curve(np.full(101, plain), OTHER.colour, "--"),
            "soft: r + γ V": Curve(soft, style("sac").colour),
        }
        says = f"The plain target is {plain:.2f}, the soft one {np.interp(right_now, right, soft):.2f}."
        return curves(says, TARGETS, right, named, mark=right_now)

    numbers = {
        "right_now": Number("π(right)", 0.5, 0, 1, 0.01, "How probable going right is in s'. Its Q is 3, left's 1."),
        "alpha": Number("α", 1, 0, 2, 0.1, "The temperature: what one nat of indecision is worth."),
    }
    return Explorable("What is the critic's target? (r = 1, γ = 0.9)", draw, **numbers)


MOST = 20  # actions, all worth the same


def highest_estimates() -> tuple[np.ndarray, np.ndarray]:
    """The highest estimate of 1 to MOST actions, on average: of one critic, and of the smaller of two."""
    x = np.linspace(-8, 8, 4001)
    found = []
    for below in (norm.cdf(x), 1 - norm.sf(x) ** 2):  # how probable it is that one action's estimate is below x
        found.append([np.trapezoid(x * np.gradient(below**n, x), x) for n in range(1, MOST + 1)])
    of_one, of_two = np.round(found, 9) + 0.0  # no −0
    return of_one, of_two


def overestimated() -> Explorable:
    """The highest estimate of some actions that are all worth 0, by one critic and by the smaller of two."""
    of_one, of_two = highest_estimates()
    counts, limits = np.arange(1, MOST + 1), (-1.5, 4.0)

    def draw(actions: float, error: float) -> Drawing:
        one, two = error * of_one, error * of_two + 0.0  # no −0
        seems, less = (float(np.interp(actions, counts, each)) for each in (one, two))
        named = {
            "one critic": Curve(one, style("sac").colour),
            "for each action the smaller of two critics": Curve(two, OTHER.colour, "--"),
        }
        axes = Axes(
            f"actions, each worth 0 (errors of standard deviation {error:g})", "highest estimate, on average", limits
        )
        says = f"The highest of {actions:g}: {seems:.2f} by one critic, {less:.2f} by the smaller of two."
        return curves(says.replace("-", "−"), axes, counts, named, mark=actions)

    numbers = {
        "actions": Number("actions", 9, 1, MOST, 1, "How many actions there are; all are worth 0."),
        "error": Number("error", 1, 0, 2, 0.1, "How much an estimate errs: the standard deviation."),
    }
    return Explorable("How good does the best-looking action seem to be?", draw, **numbers)


UPDATES, TURN = 400, 0.02  # of the thermostat; what each changes in log α
NATS, POWERS, TALL = (-1.6, 2.6), (-4.0, 4.0), 396  # the two charts' heights, and the picture's in pixels
ABOVE, BELOW = (52, 74, 690, 120), (52, 236, 690, 120)  # left, top, width and height of the charts, pixels


def thermostat() -> Explorable:
    """The entropy of nine actions' best policy beside the target entropy that one drags, and α, which follows its loss.

    Each update moves log α by one step down the loss, of a size that stays, much as Adam does.
    """
    q = torch.linspace(0, 1, 9, dtype=torch.float64)[None]

    def draw(target: float) -> Drawing:
        log_alpha, entropies, powers, falls = torch.zeros((), dtype=torch.float64), [], [], []
        for _ in range(UPDATES + 1):
            entropy = sac.entropy(sac.log_policy(q / log_alpha.exp()))
            slope = sac.temperature_loss(log_alpha, entropy, torch.tensor(target))  # the loss is its own slope in log α
            entropies.append(entropy.item())
            powers.append(log_alpha.item() / math.log(10))
            falls.append(slope.item() > 0)
            log_alpha -= TURN * slope.sign()
        alpha = float(f"{log_alpha.exp().item():.2g}")
        course = "falls at each update" if all(falls) else "comes to rest" if any(falls) else "rises at each update"
        named = {
            "entropy of the policy": Curve(entropies, style("sac").colour),
            "target entropy η": Curve(np.full(UPDATES + 1, target), OTHER.colour, "--"),
        }
        says = f"With η = {target:g}, α {course}, here from 1 to {alpha:,g}.".replace("-", "−")
        nats, below = SvgAxes(*ABOVE, (0, UPDATES), NATS), SvgAxes(*BELOW, (0, UPDATES), POWERS)
        updates = np.arange(UPDATES + 1)
        nats.scale("nats", 5)
        for curve in named.values():
            nats.line(updates, curve.values, curve.colour, 1.6, curve.dash)
        below.frame("log₁₀ α", "update", 4)
        below.line(updates, powers, INK, 1.6)
        parts = [text(4, 20, says, size=14, bold=True), *legend(named), *nats.parts, *below.parts]
        return drawing(WIDTH, TALL, parts, says)

    help = (
        "The target entropy. Each update changes α by 2 %; "
        "the policy is the softmax of nine Q, spaced evenly from 0 to 1, for this α."
    )
    target = Number("η", -1, -1.5, 2.5, 0.1, help)
    return Explorable("Nine actions, Q from 0 to 1: does the thermostat come to rest?", draw, target=target)
