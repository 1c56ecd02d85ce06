"""One decision of a drive, and what the soft constraint does to each action while you move p and ξ.

`policy_numbers.py` computes the numbers; `compromise.py` lets the car drive on by them.
"""

import ipywidgets as widgets
import numpy as np
from matplotlib.colors import to_hex

from bootcourse.colours import ALARM
from bootcourse.episodes.lookahead import nine_drives
from bootcourse.episodes.rollout import Rollout
from bootcourse.errors import BootcourseError, require
from bootcourse.learn.agent import Agent
from bootcourse.learn.settings import Settings
from bootcourse.markup import Markup
from bootcourse.methods import display_name, style
from bootcourse.panels import compromise
from bootcourse.panels.number import Number
from bootcourse.panels.panel import Panel, beside
from bootcourse.panels.policy_numbers import PolicyNumbers, check_weights, policy_numbers
from bootcourse.plots.futures import SHADES, in_words, trails
from bootcourse.plots.road import road_svg
from bootcourse.plots.svg import GRID, INK, QUIET, drawing, line, rect, text
from bootcourse.policies import Policy
from bootcourse.road.state import EGO, SPEED
from bootcourse.rule import SENTENCES, Reason
from bootcourse.scenario import ACTION_NAMES, N_ACTIONS, check_p

GREEN = style("rule").colour
WIDTH, ROAD, ROWS, ROW = 1036, 84, 176, 22  # pixels: the drawing, the road's height, where the rows begin, one row
BOTTOM = ROWS + N_ACTIONS * ROW
BAR, COLUMNS = 128, (148, 338, 528)  # a whole bar's length; where the bars of π, π̃ and the optimum begin
SHARE, PER_NAT, MOST_NATS = 738, 17, 8  # the KL's bars: from here, so long for a nat, cut at so many nats
Q, WORTH = 938, 1032  # right ends of the two columns of numbers
ROLLOUTS = 204  # the width of the column of rollouts
BEST = to_hex(SHADES(1.0))


class PolicyPanel(Panel):
    """A view on `policy_numbers` at one decision of a drive; `svg` is what it shows, `seen` the numbers."""

    def __init__(
        self, rollout: Rollout, p: float, xi: float, alpha: float, futures: Policy | None = None,
        agent: Agent | None = None, t: float = 0.0, table: bool = True,
    ):  # fmt: skip
        self.table = table
        self.ways = None if agent is None else compromise.Ways(rollout, agent)
        self.rollout, self.rate = rollout, rollout.scenario.clock.decision_rate
        self.imagined = None if futures is None else nine_drives(rollout.cars, futures, rollout.scenario)
        self.width = WIDTH if futures is None else WIDTH + ROLLOUTS
        self.moment = self._moment(t)
        self.p = Number("p", p, 0.12, 0.99, 0.01, "Probability that π̃ gives to the rule's own action.", check=check_p)
        self.xi = Number("ξ", xi, 0.001, 10, 0.1, "Weight of the KL, which pulls π to the rule; 0 may be typed.",
                         check=lambda xi: check_weights(xi, alpha), logarithmic=True)  # fmt: skip
        self.alpha, self.view, self.under = alpha, widgets.HTML(), widgets.HTML()
        numbers = (self.moment, self.p, self.xi) if table else (self.moment, self.xi)
        title = "What the rule's pull does to each action" if table else "What the rule's pull does to the drive"
        super().__init__(title, beside(*numbers), self.view, self.under)
        self.update_with(*numbers)
        self.say(missing(rollout))

    def _moment(self, t: float) -> Number:
        """The time (s) of the decision that is shown, to be moved; first t."""
        last = (len(self.rollout.actions) - 1) / self.rate

        def check(t: float) -> None:
            if not 0 <= t <= last:
                raise BootcourseError(f"t = {t:g} s: this drive has its decisions from 0 to {last:g} s.")

        step = 1 / self.rate
        check(t)
        return Number("t", t, 0, max(last, step), step, "The time of the decision.", "s", check)

    def update(self, change=None) -> None:
        """Compute and draw the present moment."""
        k = int(self.moment.value * self.rate + 1e-9)
        policy, q = (None if a is None else a[k] for a in (self.rollout.policy, self.rollout.q_values))
        p, xi, alpha = self.p.value, self.xi.value, self.alpha
        self.seen = policy_numbers(policy, q, int(self.rollout.rule_actions[k]), p, xi, alpha)
        scenario, colour = self.rollout.scenario, style(self.rollout.label).colour
        scale = ROAD / (scenario.road.lanes * scenario.road.lane_width)
        ways = {} if self.ways is None else self.ways.at(k, p, xi, alpha)
        ahead = self.ways.trails(ways) if ways else []
        self.below = self.under.value = compromise.in_page(ways, ahead) if ways else Markup("")
        if self.imagined is not None:
            ahead = trails(self.imagined, int(self.rollout.actions[k]), k)
        road, _ = road_svg(self.rollout.cars[k], scenario, colour, self.width, scale, trails=ahead)
        table = []
        if self.table:
            table = action_table(self.seen, p, xi, alpha, display_name(self.rollout.label), colour)
            table += self._marks(k, colour)
        if self.table and self.imagined is not None:
            table += rollout_bars(self.imagined.values[k], self.imagined.accidents[k] > 0)
        inner = ['<g transform="translate(8 0)">', *road, *self._head(k), *table, "</g>"]
        alt = f"{self._alt(k)} {compromise.in_words(ways) if ways else ''}".strip()
        self.svg = self.view.value = drawing(self.width + 16, BOTTOM + 50 if self.table else ROAD + 50, inner, alt)

    def _head(self, k: int) -> list[str]:
        """The time, the car's speed, and why the rule does what it does."""
        why = SENTENCES[Reason(int(self.rollout.rule_reasons[k]))]
        lane, speed = self.rollout.rule_lanes[k], self.rollout.rule_speeds[k]
        aim = f"It aims at lane {lane} (0 is the leftmost) and {speed:g} m/s."
        kl = "" if self.seen.kl is None or not self.table else f"KL(π‖π̃) = {self.seen.kl:.2f} nats"
        return [
            text(0, ROAD + 22, f"{k / self.rate:g} s", bold=True, size=15),
            text(64, ROAD + 22, f"{self.rollout.cars[k, EGO, SPEED]:.1f} m/s", size=13),
            text(COLUMNS[0], ROAD + 22, f"The rule: {why}.", fill=GREEN, size=13, bold=True),
            text(COLUMNS[0], ROAD + 40, aim, fill=QUIET),
            text(WIDTH, ROAD + 23, kl, "end", size=16, bold=True),
        ]

    def _marks(self, k: int, colour: str) -> list[str]:
        """A triangle at the action that was driven, a dot at the rule's own, and what they stand for."""
        driven = ROWS + int(self.rollout.actions[k]) * ROW + 15
        by_rule = ROWS + int(self.rollout.rule_actions[k]) * ROW + 15
        return [
            text(0, driven, "▸", fill=colour, size=14, bold=True),
            f'<circle cx="13" cy="{by_rule - 4}" r="4" fill="{GREEN}"/>',
            text(0, ROWS - 9, "▸", fill=colour, size=13, bold=True),
            text(10, ROWS - 9, "driven", fill=QUIET, size=11),
            f'<circle cx="62" cy="{ROWS - 13}" r="4" fill="{GREEN}"/>',
            text(70, ROWS - 9, "the rule's", fill=QUIET, size=11),
        ]

    def _alt(self, k: int) -> str:
        seen = self.seen
        by_rule, driven = ACTION_NAMES[self.rollout.rule_actions[k]], ACTION_NAMES[self.rollout.actions[k]]
        sentences = [
            f"{k / self.rate:g} s into the drive of the {display_name(self.rollout.label)}.",
            f"The rule says {by_rule}; {driven} is driven.",
        ]
        if self.table and seen.kl is not None:
            sentences.append(f"The KL from the rule with p = {self.p.value:g} is {seen.kl:.2f} nats.")
        if self.table and seen.optimum is not None:
            best = int(seen.optimum.argmax())
            sentences.append(
                f"With ξ = {self.xi.value:g} and α = {self.alpha:g} the best compromise gives "
                f"{seen.optimum[best]:.2f} to {ACTION_NAMES[best]}."
            )
        if self.imagined is not None:
            sentences.append(f"{in_words(self.imagined, k)}.")
        return " ".join(sentences)


def missing(rollout: Rollout) -> str:
    """A sentence that says which numbers this drive does not have; empty if it has them all."""
    lacks = [name for name, numbers in (("π", rollout.policy), ("Q", rollout.q_values)) if numbers is None]
    if not lacks:
        return ""
    return (
        f"This drive ({display_name(rollout.label)}) has no {' and no '.join(lacks)}: let an agent drive with "
        "`agent.as_policy(with_q=True)`. Agents of PPO and behaviour cloning have no Q."
    )


def action_table(seen: PolicyNumbers, p: float, xi: float, alpha: float, who: str, colour: str) -> list[str]:
    """The nine actions as rows of bars and numbers; who drove, in which colour."""
    rows = [ROWS + action * ROW for action in range(N_ACTIONS)]
    parts = [line(0, y, WIDTH, y, GRID) for y in (*rows[::3], BOTTOM)]
    parts += [text(20, y + 15, action, size=12.5) for y, action in zip(rows, ACTION_NAMES, strict=True)]
    columns = (
        (seen.policy, colour, "π", f"the policy: {who}" if seen.policy is not None else "no π"),
        (seen.rule, GREEN, "π̃", f"the rule, p = {p:g}"),
        (seen.optimum, INK, "optimum", f"ξ = {xi:g}, α = {alpha:.3g}" if seen.optimum is not None else "needs Q"),
    )
    for x, (values, bar, symbol, words) in zip(COLUMNS, columns, strict=True):
        parts += heading(x, symbol, words, bar)
        for y, value in zip(rows, values if values is not None else (), strict=values is not None):
            parts.append(rect(x, y + 4, BAR * value, ROW - 8, bar, 'rx="1.5"'))
            parts.append(text(x + BAR * value + 5, y + 15, f"{value:.3f}", fill=QUIET, size=11))
    if seen.shares is not None:
        parts += heading(SHARE - 8, "π log(π/π̃)", "they add up to the KL", colour)
        for y, share in zip(rows, seen.shares, strict=True):
            left, right = (PER_NAT * min(max(part, 0), MOST_NATS) for part in (-share, share))
            parts.append(rect(SHARE - left, y + 4, left + right, ROW - 8, colour if share >= 0 else GREEN))
            parts.append(text(SHARE + right + 5, y + 15, two_digits(share), fill=QUIET, size=11))
        parts.append(line(SHARE, ROWS, SHARE, BOTTOM, QUIET))
    for x, symbol, values, otherwise in ((Q, "Q", seen.q, "no Q"), (WORTH, "Q + ξ log π̃", seen.worth, "needs Q")):
        parts.append(text(x, ROWS - 25, symbol, "end", bold=True, size=13))
        if values is None:
            parts.append(text(x, ROWS - 9, otherwise, "end", QUIET, 11))
            continue
        parts += [text(x, y + 15, two_digits(value), "end", size=12) for y, value in zip(rows, values, strict=True)]
    own, other = seen.price.min(), seen.price.max()
    price = f"Price of an action, −log π̃: {own:.2f} nats for the rule's own, {other:.2f} nats for any other."
    formula = "optimum: the policy with the most Q + α·entropy − ξ·KL."
    return [*parts, text(0, BOTTOM + 20, price, bold=True), text(0, BOTTOM + 39, formula, fill=QUIET)]


def rollout_bars(values: np.ndarray, hurt: np.ndarray) -> list[str]:
    """The values of nine imagined drives, (9,), as bars from the least of those without an accident; hurt in red."""
    parts = heading(WIDTH + 40, "rollouts", "bold: driven; red: accident", BEST)
    rows = [ROWS + action * ROW for action in range(N_ACTIONS)]
    parts += [line(WIDTH, y, WIDTH + ROLLOUTS, y, GRID) for y in (*rows[::3], BOTTOM)]
    safe = values[~hurt]
    low, spread = (safe.min(), max(float(np.ptp(safe)), 1e-9)) if len(safe) else (0.0, 1.0)
    for y, value, end in zip(rows, values, hurt, strict=True):
        part = 0.0 if end else float(value - low) / spread
        length = 4.0 + (BAR - 30) * part
        parts.append(rect(WIDTH + 40, y + 4, length, ROW - 8, ALARM if end else to_hex(SHADES(part)), 'rx="1.5"'))
        parts.append(text(WIDTH + 45 + length, y + 15, f"{value:.1f}".replace("-", "−"), fill=QUIET, size=11))
    return parts


def heading(x: float, symbol: str, words: str, colour: str) -> list[str]:
    """A column's symbol, and below it what the symbol stands for."""
    square = rect(x, ROWS - 35, 10, 10, colour, 'rx="1.5"')
    return [square, text(x + 15, ROWS - 25, symbol, size=13, bold=True), text(x, ROWS - 9, words, fill=QUIET, size=11)]


def two_digits(value: float) -> str:
    words = f"{round(float(value), 2) + 0.0:.2f}" if abs(value) < 1e4 else f"{value:.1e}"
    return words.replace("-", "−")


def policy_panel(
    rollout: Rollout,
    p: float | None = None,
    xi: float = 2.0,
    alpha: float | None = None,
    futures: Policy | None = None,
    agent: Agent | None = None,
    t: float = 0.0,
    table: bool = True,
) -> PolicyPanel:
    """See π, π̃ and their best compromise at each decision of a drive, while you move p and ξ.

    rollout: a recorded drive; only an agent with Q and `with_q=True` gives all that is shown. p: the drive's own
    `rule_p` if None. alpha: the paper's start value, 0.01, if None. xi: the paper's 200 α, 2. futures: the base policy
    of nine imagined drives at each decision, which are drawn on the road with their values. agent: the driver, with
    critics: the car drives on by the compromise, beside the agent's own way and the rule's. t: the decision's time (s).
    table: False shows the road alone, without the nine actions and p.
    Raises BootcourseError for anything but a recorded drive, and for values out of range.
    """
    if not isinstance(rollout, Rollout):
        given = f"a {type(rollout).__name__}"
        raise BootcourseError(f"rollout is {given}: give one recorded drive, such as bc.record(driver, [0])[0].")
    p = rollout.rule_p if p is None else p
    alpha = Settings().alpha_init if alpha is None else alpha
    check_p(p)
    check_weights(xi, alpha)
    if agent is not None:
        require(bool(agent.critics), "This agent has no Q to compromise with: give one of SAC.")
    return PolicyPanel(rollout, p, xi, alpha, futures, agent, t, table)
