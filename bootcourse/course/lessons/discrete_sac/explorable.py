"""To drag in this lesson: three values, the temperature and the policy that they make; how many estimates err; a target
entropy.
"""

import numpy as np
import torch

from bootcourse.colours import OTHER
from bootcourse.learn import sac
from bootcourse.methods import style
from bootcourse.panels.explorable import Axes, Curve, Explorable, bars, curves
from bootcourse.panels.number import Number
from bootcourse.plots.svg import Drawing

ACTIONS = ("left", "straight", "right")
START, ALPHA = (0.9, 1.0, 0.5), 0.2  # Q of these actions and α, as the panel opens
AXES = Axes("", "probability of each action", (0.0, 1.0))


def undecided() -> Explorable:
    """π ∝ exp(Q / α) of three actions, its entropy and what the state is worth with it, while Q and α move."""

    def draw(alpha: float, **values: float) -> Drawing:
        q, temperature = torch.tensor([list(values.values())], dtype=torch.float64), torch.tensor([alpha])
        log_pi = sac.log_policy(q / alpha)
        entropy, value = float(sac.entropy(log_pi)), float(sac.soft_value(log_pi, q, temperature))
        says = f"It is undecided by {entropy:.2f} nats, and the state is worth {value:.2f}."
        return bars(
            says, AXES, ACTIONS, {"the best policy for these numbers": Curve(log_pi.exp()[0], style("sac").colour)}
        )

    values = {
        name: Number(f"Q({name})", start, 0, 2, 0.05, f"What it is worth to go {name} now.")
        for name, start in zip(ACTIONS, START, strict=True)
    }
    help = "The temperature: what one nat of indecision is worth."
    alpha = Number("α", ALPHA, 0.01, 10, 0.05, help, logarithmic=True)
    return Explorable("What does an agent do that is paid for being undecided?", draw, alpha=alpha, **values)


MOST, DRAWS = 20, 4000  # actions, and states in which all of them are worth the same


def overestimated() -> Explorable:
    """The highest estimate of some actions that are all worth 0, by one critic and by the smaller of two."""
    errors = np.random.default_rng(0).normal(size=(2, DRAWS, MOST))
    of_one, of_two = (np.maximum.accumulate(each, axis=-1).mean(0) for each in (errors[0], errors.min(0)))
    counts, limits = np.arange(1, MOST + 1), (-1.5, 4.0)

    def draw(actions: float, error: float) -> Drawing:
        one, two = error * of_one, error * of_two + 0.0  # no −0
        seems, less = (float(np.interp(actions, counts, each)) for each in (one, two))
        named = {
            "one critic": Curve(one, style("sac").colour),
            "for each action the smaller of two critics": Curve(two, OTHER.colour, "--"),
        }
        axes = Axes("actions, each worth 0", "highest estimate, on average", limits)
        says = f"The highest of {actions:g}: {seems:.2f} by one critic, {less:.2f} by the smaller of two."
        return curves(says.replace("-", "−"), axes, counts, named, mark=actions)

    numbers = {
        "actions": Number("actions", 2, 1, MOST, 1, "How many actions there are; all are worth 0."),
        "error": Number("error", 1, 0, 2, 0.1, "How much an estimate errs: the standard deviation."),
    }
    return Explorable("How good does the best-looking action seem to be?", draw, **numbers)


UPDATES, TURN = 400, 0.02  # of the thermostat; what each changes in log α
NATS = Axes("update", "nats", (-1.6, 2.6))


def thermostat() -> Explorable:
    """The entropy of nine actions' best policy while α follows its loss, beside the target entropy that one drags.

    Each update moves log α by one step down the loss, of a size that stays, much as Adam does.
    """
    q = torch.linspace(0, 1, 9, dtype=torch.float64)[None]

    def draw(target: float) -> Drawing:
        log_alpha, entropies, falls = torch.zeros((), dtype=torch.float64), [], []
        for _ in range(UPDATES + 1):
            entropy = sac.entropy(sac.log_policy(q / log_alpha.exp()))
            slope = sac.temperature_loss(log_alpha, entropy, torch.tensor(target))  # the loss is its own slope in log α
            entropies.append(entropy.item())
            falls.append(slope.item() > 0)
            log_alpha -= TURN * slope.sign()
        alpha = float(f"{log_alpha.exp().item():.2g}")
        course = "falls at each update" if all(falls) else "falls and rises" if any(falls) else "rises at each update"
        named = {
            "entropy of the policy": Curve(entropies, style("sac").colour),
            "target entropy η": Curve(np.full(UPDATES + 1, target), OTHER.colour, "--"),
        }
        says = f"With η = {target:g}, α {course}: from 1 to {alpha:,g}.".replace("-", "−")
        return curves(says, NATS, np.arange(UPDATES + 1), named)

    help = "The target entropy. Each update moves α by 2 %; the policy is the best one for its α."
    target = Number("η", -1, -1.5, 2.5, 0.1, help)
    return Explorable("Nine actions, Q from 0 to 1: does the thermostat come to rest?", draw, target=target)
