"""To drag in this lesson: three values and the temperature, and the policy that they make."""

import torch

from bootcourse.learn import sac
from bootcourse.methods import style
from bootcourse.panels.explorable import Axes, Curve, Explorable, bars
from bootcourse.panels.number import Number
from bootcourse.plots.svg import Drawing

ACTIONS = ("left", "straight", "right")
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
        for name, start in zip(ACTIONS, (0.9, 1.0, 0.5), strict=True)
    }
    help = "The temperature: what one nat of indecision is worth."
    alpha = Number("α", 0.2, 0.01, 10, 0.05, help, logarithmic=True)
    return Explorable("What does an agent do that is paid for being undecided?", draw, alpha=alpha, **values)
