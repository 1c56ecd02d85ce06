"""One decision of a drive, and what the soft constraint does to each action while you move p, ξ and α.

`policy_numbers.py` computes the numbers, `policy_view.py` draws them.
"""

import ipywidgets as widgets
import numpy as np

from bootcourse.episodes.rollout import Rollout
from bootcourse.learn.settings import Settings
from bootcourse.methods import display_name, style
from bootcourse.panels.arguments import a_number, one_drive
from bootcourse.panels.number import Number, moment
from bootcourse.panels.panel import Panel, beside
from bootcourse.panels.policy_numbers import check_weights, policy_numbers
from bootcourse.panels.policy_view import COLUMNS, GREEN, HEIGHT, ROAD, WIDTH, marks, policy_chart
from bootcourse.plots.road import road_svg
from bootcourse.plots.svg import QUIET, drawing, text
from bootcourse.road.state import EGO, SPEED
from bootcourse.rule import SENTENCES, Reason, rule
from bootcourse.scenario import ACTION_NAMES, check_p


def missing(rollout: Rollout) -> str:
    """A sentence that names what this drive did not record; empty if it recorded everything."""
    who, remedy = display_name(rollout.label), "let an agent drive with `agent.as_policy(with_q=True)`"
    lacks = [what for what, array in (("policy π", rollout.policy), ("Q", rollout.q_values)) if array is None]
    return f"This drive ({who}) recorded no {' and no '.join(lacks)}: to see them, {remedy}." if lacks else ""


class PolicyPanel(Panel):
    """A view on `policy_numbers` at one decision of a drive; `svg` is what it shows, `seen` the numbers."""

    def __init__(self, rollout: Rollout, p: float, xi: float, alpha: float):
        self.rollout, self.clock = rollout, rollout.scenario.clock
        starts = rollout.cars  # (T, vehicles, 10)
        self.starts, self.decisions = starts, rule(np.ascontiguousarray(starts), rollout.scenario)
        rate = self.clock.decision_rate
        self.moment = moment(len(rollout.actions), rate, "The time of the decision.", "this drive has its")
        self.p = Number("p", p, 0.12, 0.99, 0.01, "Probability that π̃ gives to the rule's own action.", check=check_p)
        self.xi = Number("ξ", xi, 0, 5, 0.05, "Weight of the KL, which pulls π to the rule.",
                         check=lambda xi: check_weights(xi, 1))  # fmt: skip
        self.alpha = Number("α", alpha, -4, 0, 0.05, "Weight of the entropy: how random π may stay.",
                            check=lambda alpha: check_weights(0, alpha), logarithmic=True)  # fmt: skip
        self.view = widgets.HTML()
        numbers = (self.moment, self.p, self.xi, self.alpha)
        super().__init__("What the rule's pull does to each action", beside(*numbers), self.view)
        self.update_with(*numbers)
        self.say(missing(rollout))

    def update(self, change=None) -> None:
        """Compute and draw the present moment."""
        k = int(self.moment.value * self.clock.decision_rate + 1e-9)
        policy, q = (None if a is None else a[k] for a in (self.rollout.policy, self.rollout.q_values))
        settings, by_rule = (self.p.value, self.xi.value, self.alpha.value), int(self.decisions.actions[k])
        self.seen = policy_numbers(policy, q, by_rule, *settings)
        own, scenario = style(self.rollout.label).colour, self.rollout.scenario
        scale = ROAD / (scenario.road.lanes * scenario.road.lane_width)
        parts, _ = road_svg(self.starts[k], scenario, own, WIDTH, scale)
        parts += self._head(k) + policy_chart(self.seen, *settings, display_name(self.rollout.label), own)
        parts += marks(int(self.rollout.actions[k]), by_rule, own)
        inner = ['<g transform="translate(8 0)">', *parts, "</g>"]
        self.svg = self.view.value = drawing(WIDTH + 16, HEIGHT, inner, self._alt(k))

    def _head(self, k: int) -> list[str]:
        """When it is, how fast the car is, why the rule does what it does."""
        why = SENTENCES[Reason(int(self.decisions.reasons[k]))]
        wants = f"It aims at lane {self.decisions.lanes[k]} (0 is the leftmost) and {self.decisions.speeds[k]:g} m/s."
        kl = [] if self.seen.kl is None else [f"KL(π‖π̃) = {self.seen.kl:.2f} nats"]
        return [
            *(text(WIDTH, ROAD + 23, words, "end", size=16, bold=True) for words in kl),
            text(0, ROAD + 22, f"{k / self.clock.decision_rate:g} s", bold=True, size=15),
            text(64, ROAD + 22, f"{self.starts[k, EGO, SPEED]:.1f} m/s", size=13),
            text(COLUMNS[0], ROAD + 22, f"The rule: {why}.", fill=GREEN, size=13, bold=True),
            text(COLUMNS[0], ROAD + 40, wants, fill=QUIET),
        ]

    def _alt(self, k: int) -> str:
        seen, rollout = self.seen, self.rollout
        says, driven = ACTION_NAMES[self.decisions.actions[k]], ACTION_NAMES[rollout.actions[k]]
        told = [f"{k / self.clock.decision_rate:g} s into the drive of the {display_name(rollout.label)}."]
        told.append(f"The rule says {says}; {driven} is driven.")
        if seen.kl is not None:
            told.append(f"The KL from the rule with p = {self.p.value:g} is {seen.kl:.2f} nats.")
        if seen.optimum is not None:
            best = int(seen.optimum.argmax())
            told.append(
                f"With ξ = {self.xi.value:g} and α = {self.alpha.value:g} the best compromise gives "
                f"{seen.optimum[best]:.2f} to {ACTION_NAMES[best]}."
            )
        return " ".join(told)


def policy_panel(rollout: Rollout, p: float | None = None, xi: float = 2.0, alpha: float | None = None) -> PolicyPanel:
    """See π, π̃ and their best compromise at each decision of a drive, while you move p, ξ and α.

    rollout: a recorded drive; only an agent with `with_q=True` records all that is shown. p: the drive's own
    `rule_p` if None. alpha: the paper's start value, 0.01, if None. xi: the paper's 200 α, 2.
    Raises BootcourseError for anything but a recorded drive, and for values out of range.
    """
    one_drive(rollout, "rollout")
    p = rollout.rule_p if p is None else p
    alpha = Settings().alpha_init if alpha is None else alpha
    for called, value in (("p", p), ("xi", xi), ("alpha", alpha)):
        a_number(value, called)
    check_p(p)
    check_weights(xi, alpha)
    return PolicyPanel(rollout, p, xi, alpha)
