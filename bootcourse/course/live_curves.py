"""A training as it happens: the curves of its agents, drawn again and again in one place."""

import time
from collections.abc import Sequence

from bootcourse.learn.curves import by_label
from bootcourse.learn.training import Training
from bootcourse.plots.figure import Picture
from bootcourse.plots.training_curves import training_curves


class LiveCurves:
    """A training's callback: redraws the agents' success and return, at most every `every` seconds.

    labels: one for each agent, those of a label are drawn together; without them, each agent's method. The picture is
    replaced in place, so that the page does not jump. On a busy machine that happens less often, so that the training
    gets most of the time.
    """

    def __init__(self, labels: Sequence[str] = (), every: float = 3.0):
        self.labels, self.every, self.pause = labels, every, every
        self.last, self.output = time.monotonic(), None

    def __call__(self, training: Training) -> None:
        now = time.monotonic()
        if now - self.last < self.pause or training.curves.finished.min() < 2:
            return
        from IPython.display import display

        picture = Picture(self.draw(training))
        if self.output is None:
            self.output = display(picture, display_id=True)
        else:
            self.output.update(picture)
        self.last = time.monotonic()
        self.pause = max(self.every, 5 * (self.last - now))

    def draw(self, training: Training):
        labels = self.labels or [settings.method for settings in training.settings]
        return training_curves(by_label(labels, training.curves.values), title="Training, as it happens")
