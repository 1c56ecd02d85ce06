"""A training while it learns: curves that grow, and the road on which the present agent drives beside its older self.

`Training.run()` shows it in a notebook; `train_panel` has it below its sliders. A click on a curve puts the agent of
that moment at the wheel. Python sends the weights of the present agent and the curves now and then; the page drives,
and keeps the agents (web/watched.js).
"""

import secrets
import time
from collections.abc import Sequence

import numpy as np
import traitlets

from bootcourse import one_per_cell
from bootcourse.learn.training import Result, Training
from bootcourse.methods import METHODS, display_name, style
from bootcourse.plots.svg import INK, QUIET, Drawing, SvgAxes, drawing, line, over, printed, span, text
from bootcourse.plots.training_curves import MEASURES, draw_training, finished, in_unit, window_of
from bootcourse.statistics import rolling_means
from bootcourse.web.guests import Guest, alone, guest
from bootcourse.web.widget import World

SHOWN = ("success", "return", "entropy")  # of the measures; a fourth says what the method has of its own
LEFT, TOP, ACROSS, DOWN, WIDE, HIGH = 46, 58, 270, 176, 216, 110  # px, of the small charts
SIZE = (2 * ACROSS + 10, 2 * DOWN + 40)
SHARE, PAUSE = 0.03, 1.0  # of the training's time, at most; s between two looks, at least
FIRST_ROAD = 10  # as in `world`; agents train on roads from 2**33 on
Marks = list[tuple[int, str]]  # (episode, what was changed)


class Watch(World):
    """What a training shows of itself; `look` is its callback, `stopping` whether the reader wants to stop it.

    button: whether it has a button to stop the training.
    """

    chart = traitlets.Unicode().tag(sync=True)
    words = traitlets.Unicode().tag(sync=True)
    running = traitlets.Bool(True).tag(sync=True)
    reach = traitlets.Int(1).tag(sync=True)  # the last episode on the curves' axis
    handle = None  # of its display in a notebook's cell

    def __init__(self, training: Training, button: bool = True):
        self.training, self.stopping, self.marks = training, False, []
        self.methods = [settings.method for settings in training.settings]
        self.number = self.methods.index(self.methods[-1])  # of the agent that is watched: the last method's first
        self.spent, self._due = 0.0, 0.0
        opens = {"road": FIRST_ROAD, "driver": "now", "ghost": "before", "pace": 2, "futures": 0, "view": "above"}
        opens |= {"details": False, "height": SIZE[1] + 40, "watch": True, "run": True, "button": button}
        opens |= {"training": secrets.token_hex(8)}
        opens["axis"] = {"first": LEFT, "across": ACROSS, "wide": WIDE, "top": TOP, "down": DOWN, "high": HIGH}
        super().__init__({"now": self._now()}, opens, training.scenario)
        self._draw()

    def look(self, training: Training) -> None:
        """Called after each decision: now and then, send the curves and the present agent."""
        now = time.monotonic()
        if now >= self._due:
            self.show_now(f"{training.updates:,} updates, {training.decisions:,} decisions.")
            took = time.monotonic() - now
            self._due = now + max(PAUSE, took / SHARE)
            self.spent += took

    def show_now(self, words: str) -> None:
        """Send what there is now."""
        with self.hold_sync():
            self._draw()
            self.words = words
            self.offer(now=self._now())

    def ended(self, result: Result, by_hand: bool = False) -> None:
        """The training is over: the last agent stays. by_hand: the reader interrupted it."""
        self.running = False
        how = "You stopped it" if by_hand or self.stopping else "Done"
        self.show_now(f"{how} after {self.training.updates:,} updates.")
        if self.handle is not None:
            self.handle.update(self)  # so that the notebook's file holds the whole curves

    def change(self, symbol: str, setting: str, value: float, unit: str = "") -> None:
        """Let the agents go on with another value, and mark the moment in the curves; the drag of a slider gets one."""
        self.training.change(**{setting: value})
        now = finished(self.training.curves.values)
        if self.marks and self.marks[-1][1].startswith(f"{symbol} ") and now - self.marks[-1][0] < 0.1 * self.reach:
            now, _ = self.marks.pop()
        self.marks.append((now, f"{symbol} {value:g} {unit}".strip()))

    def _draw(self) -> None:
        training = self.training
        self.reach = reach(finished(training.curves.values), training.episodes)
        self.svg = training_chart(self.methods, training.curves.values, self.reach, self.marks)
        self.chart = str(self.svg)

    def _now(self) -> Guest:
        """The present agent, for the page."""
        training = self.training
        now = guest(training.agent(self.number), 1)
        more = {"updates": training.updates, "episodes": int(training.curves.finished[self.number])}
        return now._replace(told=now.told | more)

    def _heard(self, widget, message: dict, buffers) -> None:
        if message.get("kind") == "stop":
            self.stopping = True
        else:
            super()._heard(widget, message, buffers)

    def _repr_mimebundle_(self, **kwargs) -> tuple[dict, dict]:
        data, metadata = super()._repr_mimebundle_(**kwargs)
        return data | self.picture(printed(self.svg), self.svg.alt), metadata


def reach(done: int, episodes: int) -> int:
    """Where the axis of the episodes ends: at the first of 50, 100, 200, 500, 1,000 ... that is beyond those done."""
    ends = (step * 10**power for power in range(1, 9) for step in (1, 2, 5))
    return min(next(end for end in ends if end > max(done, 20)), episodes)


def training_chart(methods: Sequence[str], curves: dict[str, np.ndarray], episodes: int, marks: Marks = ()) -> Drawing:
    """Four small charts of a training, always of the same size: thin lines are agents, thick ones a method's mean.

    Success, return, entropy, and ξ, or accidents where no method has a soft constraint.

    methods: of each agent. curves: as `Result.curves`, each (agents, episodes), NaN where still to come; empty before
    the training.
    """
    names, done, window = dict.fromkeys(methods), finished(curves), window_of([curves])
    called = " and ".join(map(display_name, names))
    thin = " Thin: an agent." if len(methods) > len(names) else ""
    words = f"Means of {window} episodes.{thin}" if done else "No episode has ended yet."
    parts, ends, x = [], [], 12.0
    for method in names:
        parts.append(text(x, 18, display_name(method), fill=style(method).colour, bold=True))
        x += 7.4 * len(display_name(method)) + 12
    parts.append(text(x, 18, words, fill=QUIET))
    pulled = any(METHODS[method].settings.get("xi_multiplier") != 0 for method in names)  # by the soft constraint
    for i, shown in enumerate((*SHOWN, "xi" if pulled else "accident")):
        measure, at, means = MEASURES[shown], np.zeros(0), np.zeros((0, 0))
        if done:
            at, means = rolling_means(in_unit(shown, curves[shown][:, :done]), window)
        left, top = LEFT + (i % 2) * ACROSS, TOP + (i // 2) * DOWN
        limits = measure.limits or span(means.ravel(), measure.least)
        axes = SvgAxes(left, top, WIDE, HIGH, (0, max(episodes, 1)), limits)
        axes.frame(measure.label.split(",")[0], "episode")
        labels = []
        for row, (episode, changed) in enumerate(marks):
            (x, y), down = axes.at(episode, axes.y[1]), 9 + 12 * (row % 4)  # so that two close ones can be read
            parts.append(line(x, y, x, y + HIGH, QUIET, 1, 'stroke-dasharray="3 3"'))
            side = (x + 3, "start") if episode < 0.6 * max(episodes, 1) else (x - 3, "end")  # inside the chart
            labels.append(over(text(side[0], y + down, changed, side[1], size=10)))
        for method in names if done else ():
            own = means[[each == method for each in methods]]
            end = draw_training(axes, at, own, style(method))
            if np.isfinite(end):
                axes.dot(at[np.isfinite(own).all(axis=0)][-1], end, style(method).colour)
                ends.append(f"{display_name(method)} {measure.label} {end:.3g}")
                if len(names) == 1:
                    parts.append(text(left + WIDE, top - 8, f"{end:.3g}".replace("-", "−"), "end", INK, 12, bold=True))
        parts += [*axes.parts, *labels]
    nothing = f"{called}: no episode has ended yet."
    says = f"At most {done} episodes; at each line's end: {', '.join(ends)}." if ends else nothing
    return drawing(*SIZE, parts, f"Training curves. {says}")


_shown: dict[str, tuple[int, list[Watch]]] = {}  # cell: how often it had run, and what it showed then


def watched(training: Training) -> Watch | None:
    """Show a training in the running cell of a notebook; None elsewhere, off the trap, and for agents that need Python
    to drive, because it is busy."""
    cell = one_per_cell.this_cell()
    if cell is None or not training.place.is_trap or not alone(training.agent(0)):
        return None
    from IPython import get_ipython
    from IPython.display import display

    count, before = get_ipython().execution_count, _shown.get(cell, (-1, []))
    if before[0] != count:
        for old in before[1]:
            old.close()
        _shown[cell] = before = (count, [])
    watch = Watch(training)
    before[1].append(watch)
    watch.handle = display(watch, display_id=True)
    return watch
