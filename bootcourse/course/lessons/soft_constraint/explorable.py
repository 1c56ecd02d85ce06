"""To drag in this lesson: the temperature α, with ξ = 200 α and with a ξ that stays."""

import math
from collections.abc import Callable

import numpy as np
import torch

from bootcourse.colours import QUIET
from bootcourse.course import own_code
from bootcourse.learn.bootstrap import log_stochastic_rule
from bootcourse.learn.settings import Settings
from bootcourse.methods import style
from bootcourse.panels.explorable import CHART, HEIGHT, WIDTH, Explorable
from bootcourse.panels.number import Number
from bootcourse.plots.svg import INK, Drawing, SvgAxes, drawing, text
from bootcourse.scenario import ACTION_NAMES

RULE, BETTER, LEAD = 3, 7, 1.0  # the action of the rule, another one, and what that is worth more
POWERS = np.linspace(-1, -5, 161)  # of 10: the picture's α, which falls from left to right
MOST = 10.0  # nats that the picture has room for


def one_state(lead: float) -> tuple[torch.Tensor, torch.Tensor]:
    """Q, in which another action is worth so much more than all others, and log π̃ with the paper's p: (1, 9) each."""
    log_rule = log_stochastic_rule(torch.tensor([RULE]), torch.tensor(Settings().rule_p, dtype=torch.float64))
    q = torch.zeros(1, len(ACTION_NAMES), dtype=torch.float64)
    q[0, BETTER] = lead
    return q, log_rule


def leads(best: Callable[..., torch.Tensor], alpha: float, xi: float) -> tuple[float, float]:
    """The rule's head start where all Q are equal, and what Q's lead takes from it: nats of the best policy."""
    even, ahead = (best(*one_state(lead), alpha, xi)[0].log() for lead in (0.0, LEAD))
    start = float(even[RULE] - even[BETTER])
    return start, start - float(ahead[RULE] - ahead[BETTER])


def pull() -> Explorable:
    """The rule's head start and Q's lead in the best compromise, while α falls and ξ = 200 α with it.

    The best compromise is the student's `regularised_policy`, if it passed its check.
    """
    best, settings = own_code.yours_or_ours("regularised_policy", doing="Drawing"), Settings()
    multiplier = settings.xi_multiplier
    start, lead = np.array([leads(best, 10**power, multiplier * 10**power) for power in POWERS]).T
    alone = np.array([leads(best, 10**power, 2.0)[1] for power in POWERS])
    crossing = POWERS[np.argmax(lead > start)]
    green, blue = style("rule").colour, style("soft").colour

    def draw(alpha: float) -> Drawing:
        now = leads(best, alpha, multiplier * alpha)
        says = f"α = {alpha:.6f}".rstrip("0") + f", ξ = {multiplier * alpha:.2g}: "
        says += f"the rule's head start is {now[0]:.2f} nats, Q's lead {now[1]:.2f}."
        chart = SvgAxes(*CHART, (POWERS[0], POWERS[-1]), (0.0, MOST))
        chart.scale("nats")
        for power in range(-1, -6, -1):
            across, floor = chart.at(power, 0)
            where = "end" if power == -5 else "middle"
            chart.parts.append(text(across, floor + 16, f"{10.0**power:.5f}".rstrip("0"), where, QUIET, 10.5))
        chart.parts.append(text(CHART[0] + CHART[2] / 2, CHART[1] + CHART[3] + 34, "α falls →", "middle", QUIET, 12))
        chart.line([crossing, crossing], (0, MOST), QUIET, 0.6, ":")
        for values, colour in ((alone, QUIET), (start, green), (lead, blue)):
            chart.line(POWERS, np.where(values <= MOST, values, np.nan), colour, 1.8)
        chart.words(-1.03, start[0] + 0.6, "the rule's head start", green)
        chart.words(-3.4, 9.2, "Q's lead, ξ = 200 α", blue)
        chart.words(-4.97, 1.1, "Q's lead, ξ stays at 2", QUIET, "end")
        chart.words(crossing + 0.04, 7, "the rule's action wins", INK, "end")
        chart.words(-3.4, 7, "the other action wins", INK)
        mark = math.log10(alpha)
        chart.line([mark, mark], (0, MOST), INK, 0.8, "--")
        for value, colour in zip(now, (green, blue), strict=True):
            if value <= MOST:
                chart.dot(mark, value, colour)
        return drawing(WIDTH, HEIGHT, [text(4, 20, says, size=14, bold=True), *chart.parts], says)

    help_text = f"The temperature; it starts at {settings.alpha_init:g}, and falls while the agent learns."
    alpha = Number("α", settings.alpha_init, 1e-5, 0.1, 0.05, help_text, logarithmic=True)
    return Explorable("Another action is worth more than the rule's. When is it taken?", draw, alpha=alpha)
