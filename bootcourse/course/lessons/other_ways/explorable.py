"""To drag in this lesson: when the rule's action is taken."""

import torch

from bootcourse.colours import QUIET
from bootcourse.learn.ibrl import better_of_two
from bootcourse.methods import style
from bootcourse.panels.explorable import Axes, Curve, Explorable, bars
from bootcourse.panels.number import Number
from bootcourse.plots.svg import Drawing


def which_of_two() -> Explorable:
    """How the better of two actions is distributed, while Q of the rule's action rises."""
    pi, rule, axes = torch.tensor([0.5, 0.3, 0.2]), torch.tensor(1), Axes("", "probability", (0.0, 1.0))

    def draw(q_rule: float) -> Drawing:
        chosen = better_of_two(pi, torch.tensor([1.0, q_rule, 3.0]), rule)
        labels = ["brake Q=1", f"hold Q={q_rule:g} (rule's)", "accelerate Q=3"]
        named = {"π, the agent's own": Curve(pi, QUIET), "the better of two": Curve(chosen, style("ibrl").colour)}
        return bars(f"The rule's action is taken with probability {chosen[rule]:.1f}.", axes, labels, named)

    help = "Q of the rule's action. The other actions keep theirs."
    return Explorable("Which of the two is taken?", draw, q_rule=Number("Q", 0.0, 0.0, 4.0, 0.1, help))
