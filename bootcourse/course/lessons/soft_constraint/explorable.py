"""To drag in this lesson: the temperature α, with ξ = 200 α and with a ξ that stays."""

import numpy as np
import torch

from bootcourse.colours import QUIET
from bootcourse.course import own_code
from bootcourse.learn.bootstrap import log_stochastic_rule
from bootcourse.learn.settings import Settings
from bootcourse.methods import style
from bootcourse.panels.explorable import Axes, Curve, Explorable, bars
from bootcourse.panels.number import Number
from bootcourse.plots.svg import Drawing
from bootcourse.scenario import ACTION_NAMES

RULE, BETTER, LEAD = 3, 7, 1.0  # the action of the rule, another one, and what that is worth more
AXES = Axes("", "probability of each action", (0.0, 1.0))


def head_start(log_rule: np.ndarray, alpha: float, xi: float) -> float:
    """How much the rule's action leads in the logits of the best policy before Q says anything: nats."""
    return float((log_rule[RULE] - log_rule[BETTER]) * xi / (alpha + xi))


def one_state() -> tuple[torch.Tensor, torch.Tensor]:
    """Q, in which another action is worth more than the rule's, and log π̃ with the paper's p: (1, 9) each."""
    log_rule = log_stochastic_rule(torch.tensor([RULE]), torch.tensor(Settings().rule_p, dtype=torch.float64))
    q = torch.zeros(1, len(ACTION_NAMES), dtype=torch.float64)
    q[0, BETTER] = LEAD
    return q, log_rule


def pull() -> Explorable:
    """The best compromise between Q, in which another action is worth more, and the rule, while α falls.

    With ξ = 200 α its logits are Q / 201α + (200/201) log π̃. It is the student's `regularised_policy`, if it passed its
    check.
    """
    best = own_code.yours_or_ours("regularised_policy", doing="Drawing")
    settings, (q, log_rule) = Settings(), one_state()
    multiplier = settings.xi_multiplier

    def draw(alpha: float) -> Drawing:
        together, alone = (best(q, log_rule, alpha, xi)[0] for xi in (multiplier * alpha, 2.0))
        lead = head_start(log_rule[0].numpy(), alpha, multiplier * alpha)
        q_lead = LEAD / ((1 + multiplier) * alpha)
        says = f"α = {alpha:.6f}".rstrip("0") + f", ξ = {multiplier * alpha:.2g}: "
        says += f"the rule's head start is {lead:.2f} nats, Q's lead {q_lead:.2f}."
        named = {
            "the best policy, ξ = 200 α": Curve(together, style("soft").colour),
            "the same with ξ = 2 for ever": Curve(alone, QUIET),
        }
        return bars(says, AXES, ACTION_NAMES, named)

    help_text = f"The temperature; it starts at {settings.alpha_init:g}, and falls while the agent learns."
    alpha = Number("α", settings.alpha_init, 1e-5, 0.1, 0.05, help_text, logarithmic=True)
    return Explorable("Another action is worth more than the rule's. When is it taken?", draw, alpha=alpha)
