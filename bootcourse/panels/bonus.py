"""What the bonus c does: the discounted return along the rule's drive and along a trapped one, while you move c.

The bonus is r'(s, a_E) = r(s, a_E) + c (Section IV-B, "Demonstration-Guided Reward Augmentation"); it and the target
are computed in `bootcourse.learn`.
"""

from dataclasses import dataclass, replace

import ipywidgets as widgets
import numpy as np

from bootcourse.episodes.record import record
from bootcourse.episodes.rollout import Rollout
from bootcourse.errors import BootcourseError
from bootcourse.learn import sac
from bootcourse.learn.bootstrap import augmented_reward
from bootcourse.learn.settings import Settings
from bootcourse.methods import style
from bootcourse.panels.number import Number
from bootcourse.panels.panel import Panel, beside
from bootcourse.plots.svg import INK, QUIET, SvgAxes, drawing, line, span, text
from bootcourse.policies import idle_policy, rule_policy
from bootcourse.scenario import DEFAULT

LAST = 10  # decisions whose mean reward goes on for ever after a drive that ran out of time
WIDTH, HEIGHT = 760, 416
WORTH, NEEDED = (44, 92, 700, 150), (44, 300, 700, 76)  # left, top, width and height of a chart, pixels
STEPS = (0.25, 0.5, 1.0, 2.5, 5.0)  # the axes have room for one of these bonuses, so they stay where they are in a drag
SHOWN = 40  # s of the drive that the charts show: it gets out in them
ROAD = 10  # its seed, the road of the lessons' examples


@dataclass(frozen=True)
class BonusNumbers:
    """The targets of two drives at each decision, each array (T,), up to the end of the shorter drive."""

    plain: np.ndarray  # of the demonstration without a bonus
    augmented: np.ndarray  # with c on every reward
    trapped: np.ndarray  # of the drive that stays behind
    crossing: np.ndarray  # the c above which the demonstration's target is higher; below 0: higher without a bonus
    weight: np.ndarray  # what a bonus of 1 adds to the demonstration's target


def targets(rewards: np.ndarray, gamma: float, bonus: float = 0.0, terminated: bool = False) -> np.ndarray:
    """y_t = Σ_k γ^k (r_{t+k} + c), computed backwards from the end of a drive: (T,) -> (T,).

    terminated: nothing follows (an accident); otherwise the mean of the last ten rewards goes on for ever.
    Raises BootcourseError for a gamma outside [0, 1), with which that would be infinite.
    """
    if not 0 <= gamma < 1:
        raise BootcourseError(f"γ = {gamma!r}: give a discount of 0 or more, below 1.")
    rewards = augmented_reward(np.asarray(rewards, dtype=np.float64), 1.0, bonus)
    following = float(rewards[-LAST:].mean() / (1 - gamma))
    worth = np.empty(len(rewards))
    for k in range(len(rewards) - 1, -1, -1):
        following = worth[k] = sac.critic_target(rewards[k], terminated and k == len(rewards) - 1, following, gamma)
    return worth


def bonus_numbers(demonstration: Rollout, trapped: Rollout, settings: Settings) -> BonusNumbers:
    """The targets of both drives with the settings' γ and c.

    y is linear in c: a bonus of 1 adds the target of a drive that earns 1 at each decision.
    """
    gamma, crashed = settings.gamma, bool(demonstration.accident)
    length = min(len(demonstration.rewards), len(trapped.rewards))
    plain, augmented = (targets(demonstration.rewards, gamma, c, crashed)[:length] for c in (0.0, settings.bonus))
    behind = targets(trapped.rewards, gamma, 0.0, bool(trapped.accident))[:length]
    weight = targets(np.ones(len(demonstration.rewards)), gamma, 0.0, crashed)[:length]
    return BonusNumbers(plain, augmented, behind, (behind - plain) / weight, weight)


class BonusPanel(Panel):
    """A view on `bonus_numbers` of two drives; `svg` is what it shows, `seen` the numbers."""

    def __init__(self, demonstration: Rollout, trapped: Rollout, c: float):
        self.demonstration, self.trapped, settings = demonstration, trapped, Settings()
        self.c = Number("c", c, 0, 5, 0.05, "Bonus on every reward of a demonstration.",
                        check=lambda c: replace(settings, bonus=c))  # fmt: skip
        self.gamma = Number("γ", settings.gamma, 0, 0.98, 0.01, "Discount: the critic sees 1/(1 − γ) decisions ahead.",
                            check=lambda gamma: targets(demonstration.rewards, gamma))  # fmt: skip
        self.view = widgets.HTML()
        super().__init__("What the bonus makes of a demonstration", beside(self.c, self.gamma), self.view)
        self.update_with(self.c, self.gamma)

    def update(self, change=None) -> None:
        """Compute and draw."""
        c = self.c.value
        settings = replace(Settings(), bonus=c, gamma=self.gamma.value)
        self.seen = bonus_numbers(self.demonstration, self.trapped, settings)
        (title, added), own, other = self._sentences(c), style("rule").colour, style("idle").colour
        legend = [(4, "staying behind, r", other, 2, ""), (160, "the rule's drive, r + c", own, 3, "")]
        if c:
            legend.append((345, "the rule's drive, r alone", own, 1.6, 'stroke-dasharray="6 4"'))
        parts = [text(4, 20, title, size=14, bold=True), text(WIDTH - 4, 54, added, "end")]
        for x, name, colour, width, dashes in legend:
            parts += [line(x, 50, x + 26, 50, colour, width, dashes), text(x + 32, 54, name)]
        parts += [part for axes in self._charts(own, other) for part in axes.parts]
        self.svg = self.view.value = drawing(WIDTH, HEIGHT, parts, f"{title} {added}")

    def _charts(self, own: str, other: str) -> tuple[SvgAxes, SvgAxes]:
        """The targets of both drives over time, and the bonus that each moment needs."""
        seen, rate = self.seen, self.demonstration.scenario.clock.decision_rate
        parts = (seen.plain, seen.augmented, seen.trapped, seen.crossing, seen.weight)
        plain, augmented, trapped, crossing, weight = (each[: SHOWN * rate] for each in parts)
        times, room = np.arange(len(plain)) / rate, next((step for step in STEPS if step >= self.c.value), 0.0)
        highest = plain + max(room, self.c.value) * weight
        worth = SvgAxes(*WORTH, (0, times[-1]), span([*plain, *trapped, *highest, 0.0], 0.1))
        worth.frame("discounted sum of the rewards from here on")
        if self.c.value:
            worth.line(times, plain, own, 1.1, "--")
        worth.line(times, trapped, other, 1.4)
        worth.line(times, augmented, own, 2)

        crossing = np.maximum(crossing, 0.0)  # where it is below 0 the drive is worth more without a bonus
        needed = SvgAxes(*NEEDED, worth.x, (0.0, 1.1 * max(0.05, crossing.max())))
        needed.frame("the smallest c with which the rule's drive is worth more; 0: it needs none", "time (s)", 3)
        needed.fill([*times, times[-1], times[0]], [*crossing, 0.0, 0.0], other, 0.15)
        needed.line(times, crossing, INK, 1.2)
        needed.line([0, times[-1]], [0, 0], QUIET, 0.8)
        return worth, needed

    def _sentences(self, c: float) -> tuple[str, str]:
        """In how many of the seconds shown the rule's drive is worth less, and what the bonus adds to it."""
        augmented, trapped = (each[: SHOWN * self.demonstration.scenario.clock.decision_rate]
                              for each in (self.seen.augmented, self.seen.trapped))  # fmt: skip
        less, added = int((augmented < trapped).sum()), c * self.seen.weight[0]
        worth = f"With c = {c:g} the rule's drive is worth"
        title = f"{worth} less than staying behind in {less} of {len(trapped)} seconds."
        if not less:
            title = f"{worth} more than staying behind in each of these {len(trapped)} seconds."
        return title, f"The bonus adds c / (1 − γ) = {added:.3g}."


def bonus_panel(c: float = Settings().bonus) -> BonusPanel:
    """See what the bonus c adds to the targets of a demonstration while you move c and γ. c: where it begins.

    The panel draws, at each decision t of the rule's drive and of one that stays behind the trap, the critic's target
    y = r' + γ (1 - terminated) y_next, that is Σ_k γ^k r'_{t+k}, without the entropy and the KL. r' = r + c on the
    rule's drive, r on the other. After the end, the mean reward of the last ten decisions goes on for ever.
    """
    drivers = ((rule_policy(DEFAULT), "rule"), (idle_policy, "idle"))
    return BonusPanel(*(record(driver, [ROAD], DEFAULT, label)[0] for driver, label in drivers), c)
