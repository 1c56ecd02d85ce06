"""A training as it happens: the curves of its agents over their updates, drawn again and again in one place."""

import time
from collections.abc import Sequence

import numpy as np
from matplotlib.figure import Figure

from bootcourse.learn.curves import by_label
from bootcourse.learn.training import Training
from bootcourse.methods import display_name
from bootcourse.plots.figure import Picture
from bootcourse.plots.training_curves import WINDOW, training_curves

MEASURES = ("success", "return")
EVERY = 10  # updates between the points of a curve


class LiveCurves:
    """A training's callback: redraws the agents' success and return, at most every `every` seconds.

    drawn: of `training_curves`, such as measures=("return",) or constants.

    The agents of a training have the same number of updates, and not of episodes: those that crash early have more of
    these. labels: one for each agent, those of a label are drawn together; without them, each agent's method. The
    picture is replaced in place, so that the page does not jump. On a busy machine that happens less often, so that the
    training gets most of the time. `show` draws at once: call it after the training.
    """

    def __init__(self, labels: Sequence[str] = (), every: float = 3.0, **drawn):
        self.labels, self.every, self.pause, self.drawn = labels, every, every, drawn
        self.last, self.output = time.monotonic(), None
        self.updates, self.means = [], []  # of each point; {measure: (agents,)}, the means of the last episodes

    def __call__(self, training: Training) -> None:
        if training.curves.finished.min() < 2:
            return
        if not self.updates or training.updates >= self.updates[-1] + EVERY:
            self.note(training)
        if time.monotonic() - self.last >= self.pause:
            self.show(training)

    def note(self, training: Training) -> None:
        """Add a point to each curve."""
        self.updates.append(training.updates)
        self.means.append({measure: training.curves.recent(measure, WINDOW) for measure in MEASURES})

    def show(self, training: Training) -> None:
        """Draw the picture, in the place of the one before."""
        from IPython.display import display

        began, picture = time.monotonic(), Picture(self.draw(training))
        if self.output is None:
            self.output = display(picture, display_id=True)
        else:
            self.output.update(picture)
        self.last = time.monotonic()
        self.pause = max(self.every, 5 * (self.last - began))

    def draw(self, training: Training) -> Figure:
        """The figure of what was noted so far, with the present in its title."""
        if not self.updates:
            self.note(training)
        labels = self.labels or [settings.method for settings in training.settings]
        curves = {measure: np.stack([means[measure] for means in self.means], axis=1) for measure in MEASURES}
        each = by_label(labels, curves)
        if self.drawn.get("measures") == ("return",):
            now = [f"{np.nanmean(of['return'][:, -1]):.1f}".replace("-", "−") for of in each.values()]
            verb, word, unit = "earns", "", "an episode"
        else:
            now = [f"{100 * np.nanmean(of['success'][:, -1]):.0f} %" for of in each.values()]
            verb, word, unit = "succeeds", "in ", "of its episodes"
        names = [display_name(label).replace(", ", " with ") for label in each]
        others = "".join(f", {name} {word}{share}" for name, share in zip(names[1:], now[1:], strict=True))
        title = f"After {training.updates:,} updates {names[0]} {verb} {word}{now[0]} {unit}{others}"
        return training_curves(each, title, updates=np.array(self.updates), **self.drawn)
