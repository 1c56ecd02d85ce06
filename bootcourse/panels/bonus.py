"""What the bonus c does: the critic's target along a demonstration and along a trapped drive, while you move c.

`bonus_numbers.py` computes the targets.
"""

from dataclasses import replace

import ipywidgets as widgets
import numpy as np

from bootcourse.colours import Style
from bootcourse.episodes.record import record
from bootcourse.episodes.rollout import Rollout
from bootcourse.errors import BootcourseError
from bootcourse.learn.bootstrap import demonstration_share
from bootcourse.learn.settings import Settings
from bootcourse.methods import style
from bootcourse.panels.arguments import one_drive, whole_number
from bootcourse.panels.bonus_numbers import bonus_numbers
from bootcourse.panels.number import Number, moment
from bootcourse.panels.panel import Panel, beside
from bootcourse.plots.svg import INK, QUIET, SvgAxes, drawing, line, span, text
from bootcourse.policies import idle_policy, rule_policy
from bootcourse.scenario import DEFAULT

WIDTH, HEIGHT = 1052, 416
WORTH, NEEDED = (44, 92, 600, 140), (44, 290, 600, 84)  # left, top, width and height of a chart, pixels
AGAINST_C, FADING = (720, 92, 318, 140), (720, 290, 318, 84)
STEPS = (0.25, 0.5, 1.0, 2.5, 5.0)  # the axes have room for one of these bonuses, so they stay where they are in a drag


class BonusPanel(Panel):
    """A view on `bonus_numbers` of two drives; `svg` is what it shows, `seen` the numbers."""

    def __init__(self, demonstration: Rollout, trapped: Rollout, settings: Settings):
        self.demonstration, self.trapped, self.settings = demonstration, trapped, settings
        self.rate = demonstration.scenario.clock.decision_rate
        self.own, self.other = style(demonstration.label), style(trapped.label)
        if self.other.colour == self.own.colour:
            self.other = Style(QUIET)
        self.c = Number("c", settings.bonus, 0, 5, 0.05, "Bonus on every reward of a demonstration.",
                        check=lambda c: replace(settings, bonus=c))  # fmt: skip
        help = "Discount: how far the critic sees, 1/(1 − γ) decisions."
        self.gamma = Number("γ", settings.gamma, 0, 0.98, 0.01, help,
                            check=lambda gamma: check_finite_worth(replace(settings, gamma=gamma)))  # fmt: skip
        help = "The time at which the two drives are compared."
        decisions = min(len(demonstration.actions), len(trapped.actions))
        self.moment = moment(decisions, self.rate, help, "both drives have their")
        most, help = settings.beta_episodes, "Episodes trained: β, the demonstrations' share, fades."
        self.episode = Number("episode", 0, 0, 1.5 * most, max(1, most // 100), help,
                              check=whole_number("episode", 0, 10**9))  # fmt: skip
        self.view = widgets.HTML()
        numbers = (self.c, self.gamma, self.moment, self.episode)
        super().__init__("What the bonus makes of a demonstration", beside(*numbers), self.view)
        self.update_with(*numbers)

    def update(self, change=None) -> None:
        """Compute and draw."""
        c, episode = self.c.value, int(self.episode.value)
        settings = replace(self.settings, bonus=c, gamma=self.gamma.value)
        self.seen = bonus_numbers(self.demonstration, self.trapped, settings, episode)
        k = int(self.moment.value * self.rate + 1e-9)
        room = max(next((step for step in STEPS if step >= c), c), 0.25)
        charts = [*self._along_the_drive(k, room), self._against_c(k, c, room), self._fading(settings, episode)]
        now, whole = self._sentences(k, c)
        head = [text(4, 16, now, size=14, bold=True), text(4, 36, whole, fill=QUIET), *self._legend(c)]
        parts = [*head, *(part for axes in charts for part in axes.parts)]
        self.svg = self.view.value = drawing(WIDTH, HEIGHT, parts, f"{now} {whole} β is {self.seen.beta:.2g}.")

    def _along_the_drive(self, k: int, room: float) -> tuple[SvgAxes, SvgAxes]:
        """The targets of both drives over time, and the bonus that each moment needs. k: the marked decision."""
        seen, own, other = self.seen, self.own, self.other
        times = np.arange(len(seen.plain)) / self.rate
        highest = seen.plain + room * seen.weight
        everything = np.concatenate([seen.plain, seen.trapped, seen.augmented, [0.0], highest])
        worth = SvgAxes(*WORTH, (0, max(times[-1], 1 / self.rate)), span(everything, 0.1))
        worth.frame("the critic's target along the drive (discounted sum of rewards)")
        worth.line(times, seen.plain, own.colour, 1.1, "--")
        worth.line(times, seen.shared, own.colour, 1, opacity=0.75)
        worth.line(times, seen.trapped, other.colour, 1.4, other.line)
        worth.line(times, seen.augmented, own.colour, 2)

        needed = SvgAxes(*NEEDED, worth.x, span(np.append(seen.crossing, 0.05), 0.1))
        title = "the bonus c from which the demonstration is worth more: below 0, it is so without one"
        needed.frame(title, "time (s)", 3)
        base = max(needed.y[0], 0.0)
        needed.fill([*times, times[-1], times[0]], [*np.maximum(seen.crossing, base), base, base], other.colour, 0.15)
        needed.line(times, seen.crossing, INK, 1.2)
        needed.line([0, times[-1]], [0, 0], QUIET, 0.8)
        for axes, y, colour in ((worth, seen.augmented[k], own.colour), (needed, seen.crossing[k], INK)):
            axes.line([times[k]] * 2, axes.y, QUIET, 0.7, ":")
            axes.dot(times[k], y, colour)
        return worth, needed

    def _against_c(self, k: int, c: float, room: float) -> SvgAxes:
        """Both targets at one moment against c: one rises, the other does not, and they cross once."""
        seen, ends = self.seen, np.array([min(0.0, c), room])
        rising = seen.plain[k] + ends * seen.weight[k]
        axes = SvgAxes(*AGAINST_C, tuple(ends), span([*rising, seen.trapped[k], 0.0], 0.1))
        axes.frame(f"the same at {k / self.rate:g} s, against c")
        axes.line(ends, np.full(2, seen.trapped[k]), self.other.colour, 1.4, self.other.line)
        axes.line(ends, rising, self.own.colour, 2)
        words = (
            "the demonstration leads throughout" if seen.crossing[k] < ends[0] else "staying behind leads throughout"
        )
        if ends[0] <= seen.crossing[k] <= ends[1]:
            axes.dot(seen.crossing[k], seen.trapped[k], INK)
            words = f"they cross at c = {seen.crossing[k]:.2g}"
        axes.parts.append(text(axes.left + 8, axes.top + 10, words.replace("-", "−"), size=11.5))
        axes.line([c, c], axes.y, QUIET, 0.7, ":")
        axes.dot(c, seen.augmented[k], self.own.colour)
        return axes

    def _fading(self, settings: Settings, episode: int) -> SvgAxes:
        """β c over the training."""
        c, most = settings.bonus, max(1.5 * settings.beta_episodes, episode)
        episodes = np.linspace(0, most, 151)
        values = c * demonstration_share(episodes, settings.beta_start, settings.beta_episodes)
        axes = SvgAxes(*FADING, (0, most), span([*(1.3 * values), 0.0], 0.1))
        axes.frame("β·c, the mean bonus in a batch", "episode of the training", 2)
        axes.line(episodes, values, self.own.colour, 1, opacity=0.75)
        x, y = axes.dot(episode, c * self.seen.beta, self.own.colour)
        anchor, aside = ("end", -8) if episode > 0.6 * most else ("start", 8)
        words = f"β = {self.seen.beta:.2g}, β·c = {c * self.seen.beta:.2g}"
        axes.parts.append(text(x + aside, y - 6, words, anchor, bold=True))
        return axes

    def _sentences(self, k: int, c: float) -> tuple[str, str]:
        """What the numbers say at one moment, and about the whole drive."""
        seen = self.seen
        crossing, highest = float(seen.crossing[k]), float(seen.crossing.max())
        leads = f"it leads from c = {crossing:.2g}" if crossing > 0 else "it leads even without a bonus"
        now = (
            f"At {k / self.rate:g} s the demonstration is worth {seen.augmented[k]:.2f} with c = {c:g}, "
            f"{seen.plain[k]:.2f} without; staying behind {seen.trapped[k]:.2f}: {leads}."
        )
        leads = f"From c = {highest:.2g} on it leads" if highest > 0 else "Even without a bonus it leads"
        how = "c / (1 − γ)" if np.ptp(seen.weight) < 1e-9 else "less towards the accident that ends it"
        whole = f"{leads} at every moment. A bonus of {c:g} adds {c * seen.weight[0]:.3g} to the target, {how}."
        return now.replace("-", "−"), whole.replace("-", "−")

    def _legend(self, c: float) -> list[str]:
        """Four lines do not end where there is room for their names, so these stand above."""
        own, other = self.own.colour, self.other.colour
        entries = (
            (4, f"demonstration, r + c, c = {c:g}", own, 3, ""),
            (250, f"r + β·c, β = {self.seen.beta:.2g}: once the agent drives alike", own, 1.4, ""),
            (590, "r alone", own, 1.6, 'stroke-dasharray="6 4"'),
            (720, "staying behind, r", other, 2, ""),
        )
        return [
            part
            for x, words, colour, width, dashes in entries
            for part in (line(x, 58, x + 26, 58, colour, width, dashes), text(x + 32, 62, words))
        ]


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
    settings = Settings() if settings is None else settings
    if not isinstance(settings, Settings):
        raise BootcourseError(f"settings = {settings!r:.80}: give Settings, such as settings_for('bootstrapped').")
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
