"""Curves that grow in a notebook while a training runs."""

import time

from bootcourse.learn.curves import by_method
from bootcourse.learn.training import Training
from bootcourse.plots.figure import Picture


class LiveCurves:
    """A training's callback: redraws the methods' success and return, at most every `every` seconds.

    The picture is replaced in place, so that the page does not jump.
    """

    def __init__(self, every: float = 3.0):
        self.every, self.last, self.output = every, time.monotonic(), None

    def __call__(self, training: Training) -> None:
        now = time.monotonic()
        if now - self.last < self.every or training.curves.finished.min() < 2:
            return
        self.last = now
        from IPython.display import display

        picture = Picture(self.draw(training))
        if self.output is None:
            self.output = display(picture, display_id=True)
        else:
            self.output.update(picture)

    @staticmethod
    def draw(training: Training):
        from bootcourse.plots import training_curves

        curves = by_method(training.settings, training.curves.values)
        return training_curves(curves, title="Training, as it happens")
