"""A training as it happens: the curves of its agents over their updates, drawn again and again in one place."""

import time
from collections.abc import Mapping, Sequence

import numpy as np
from matplotlib.figure import Figure

from bootcourse.colours import QUIET
from bootcourse.course.dots import dots, name_rows
from bootcourse.learn.curves import by_label
from bootcourse.learn.training import Training
from bootcourse.methods import display_name
from bootcourse.plots.figure import Picture, axes_at, finish, label_ends, new_figure, plain_axes
from bootcourse.plots.training_curves import WINDOW, training_curves
from bootcourse.statistics import IN_A_ROW

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


class LiveWayOut(LiveCurves):
    """Of the last 50 episodes, how many two agents end ahead, while they learn; below, when trained ones found the way.

    looks: {what tells one of the two from the other: its colour}. trained: a row of dots for each kind of agents that
    trained, {its name: (colour, the episodes after which they found the way out, (agents,))}; a_dot: who they are.
    """

    def __init__(self, looks: Mapping[str, str], trained: Mapping[str, tuple[str, np.ndarray]], a_dot: str):
        super().__init__()
        self.looks, self.trained, self.a_dot = looks, trained, a_dot

    def show(self, training: Training) -> None:
        if training.curves.finished.min() >= 2:  # a line has two points
            super().show(training)

    def draw(self, training: Training) -> Figure:
        done = np.minimum(training.curves.finished, training.episodes)
        success = training.curves.values["success"]
        lines = [_ahead(each[:count]) for each, count in zip(success, done, strict=True)]
        title = f"Ahead in the last {min(*done, IN_A_ROW)} episodes: "
        title += ", ".join(f"{line[-1]:.0f} {name}" for line, name in zip(lines, self.looks, strict=True))
        tall, most = 0.45 * len(self.trained), 400  # inches; episodes: by then the agents that trained have found it
        figure = new_figure(3.3 + tall)
        ax, below = axes_at(figure, 1.6, 0.9, 3.7, 1.4), axes_at(figure, 1.6, 2.65, 3.7, tall)
        plain_axes(ax, f"of the last {IN_A_ROW} training episodes, ended ahead: one agent each")
        for line, colour in zip(lines, self.looks.values(), strict=True):
            ax.plot(np.arange(1, len(line) + 1), line, color=colour, linewidth=2)
            ax.plot(len(line), line[-1], "o", color=colour, markersize=5, clip_on=False)
        ax.axhline(IN_A_ROW / 2, color=QUIET, linewidth=1, linestyle=(0, (2, 2)), zorder=1)
        ax.set(xlim=(0, most), ylim=(0, IN_A_ROW))
        ends = [(line[-1], *look) for line, look in zip(lines, self.looks.items(), strict=True)]
        label_ends(ax, [*ends, (IN_A_ROW / 2, "above: it finds the way out", QUIET)])
        for place, (colour, episodes) in enumerate(self.trained.values()):
            dots(below, episodes, place, colour)
        name_rows(below, list(self.trained), f"episode; a dot: {self.a_dot} finds the way out")
        below.set_xlim(0, most)
        said = (f"{name}, after {episodes.min():.0f} to {episodes.max():.0f} episodes"
                for name, (_, episodes) in self.trained.items())  # fmt: skip
        alt = f"Lines over {done[0]} and {done[1]} episodes. A dot: {self.a_dot} finds the way out: {'; '.join(said)}."
        return finish(figure, title, alt)


def _ahead(success: np.ndarray) -> np.ndarray:
    """Of each episode and the 49 before it, how many ended ahead: 0/1 (episodes,) -> (episodes,)."""
    ahead = np.cumsum(success)
    ahead[IN_A_ROW:] -= ahead[:-IN_A_ROW].copy()
    return ahead
