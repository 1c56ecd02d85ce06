"""What the bonus c does: the critic's target along a demonstration and along a trapped drive, while you move c.

`bonus_numbers.py` computes the targets, `bonus_view.py` draws them.
"""

from dataclasses import replace

import ipywidgets as widgets

from bootcourse.colours import Style
from bootcourse.episodes.record import record
from bootcourse.episodes.rollout import Rollout
from bootcourse.errors import BootcourseError
from bootcourse.learn.settings import Settings
from bootcourse.methods import style
from bootcourse.panels.arguments import an_instance, one_drive, whole_number
from bootcourse.panels.bonus_numbers import bonus_numbers
from bootcourse.panels.bonus_view import bonus
from bootcourse.panels.number import Number, moment
from bootcourse.panels.panel import Panel, beside
from bootcourse.plots.svg import QUIET
from bootcourse.policies import idle_policy, rule_policy
from bootcourse.scenario import DEFAULT


class BonusPanel(Panel):
    """A view on `bonus_numbers` of two drives; `svg` is what it shows, `seen` the numbers."""

    def __init__(self, demonstration: Rollout, trapped: Rollout, settings: Settings):
        self.demonstration, self.trapped, self.settings = demonstration, trapped, settings
        rate = demonstration.scenario.clock.decision_rate
        decisions = min(len(demonstration.actions), len(trapped.actions))
        self.c = Number("c", settings.bonus, 0, 5, 0.05, "Bonus on every reward of a demonstration.",
                        check=lambda c: replace(settings, bonus=c))  # fmt: skip
        help = "Discount: how far the critic sees, 1/(1 − γ) decisions."
        self.gamma = Number("γ", settings.gamma, 0, 0.98, 0.01, help,
                            check=lambda gamma: check_finite_worth(replace(settings, gamma=gamma)))  # fmt: skip
        help = "The time at which the two drives are compared."
        self.moment = moment(decisions, rate, help, "both drives have their")
        most, help = settings.beta_episodes, "Episodes trained: β, the demonstrations' share, fades."
        self.episode = Number("episode", 0, 0, 1.5 * most, max(1, most // 100), help,
                              check=whole_number("episode", 0, 10**9))  # fmt: skip
        self.view = widgets.HTML()
        numbers = (self.c, self.gamma, self.moment, self.episode)
        super().__init__("What the bonus makes of a demonstration", beside(*numbers), self.view)
        self.update_with(*numbers)

    def update(self, change=None) -> None:
        """Compute and draw."""
        settings = replace(self.settings, bonus=self.c.value, gamma=self.gamma.value)
        self.seen = bonus_numbers(self.demonstration, self.trapped, settings, int(self.episode.value))
        rate = self.demonstration.scenario.clock.decision_rate
        k = int(self.moment.value * rate + 1e-9)
        own, other = style(self.demonstration.label), style(self.trapped.label)
        other = Style(QUIET) if other.colour == own.colour else other
        self.svg = self.view.value = bonus(self.seen, k, rate, settings, int(self.episode.value), own, other)


def check_finite_worth(settings: Settings) -> None:
    """Raise BootcourseError for a discount of 1."""
    if settings.gamma == 1:
        raise BootcourseError("γ = 1: the return of a drive that never ends would be infinite, give less than 1.")


def bonus_panel(
    demonstration: Rollout | None = None, trapped: Rollout | None = None, settings: Settings | None = None
) -> BonusPanel:
    """See what the bonus c adds to the targets of a demonstration while you move c, γ and the episode of training.

    demonstration: a recorded drive, the rule's if None. trapped: a drive that stays behind the trap; if None, the
    idle policy's on the same road. settings: an agent's c, γ and β (the paper's if None).

    The panel draws, at each decision t of both drives, the critic's target y = r' + γ (1 - terminated) y_next,
    that is Σ_k γ^k r'_{t+k}, without the entropy and the KL. r' = r + c on the demonstration (Section IV-B,
    "Demonstration-Guided Reward Augmentation"), r on the trapped drive. After a drive that ran out of time, the
    mean reward of its last ten decisions goes on for ever; after an accident nothing follows.
    Raises BootcourseError for anything but recorded drives, and for two drives of different scenarios.
    """
    settings = Settings() if settings is None else an_instance(settings, Settings, "settings")
    if demonstration is None:
        scenario, seed = (DEFAULT, 0) if trapped is None else (one_drive(trapped, "trapped").scenario, trapped.seed)
        demonstration = record(rule_policy(scenario), [seed], scenario, "rule")[0]
    one_drive(demonstration, "demonstration")
    if trapped is None:
        trapped = record(idle_policy, [demonstration.seed], demonstration.scenario, "idle")[0]
    one_drive(trapped, "trapped")
    if trapped.scenario != demonstration.scenario:
        raise BootcourseError("The two drives are of different scenarios: record both in one.")
    check_finite_worth(settings)
    return BonusPanel(demonstration, trapped, settings)
