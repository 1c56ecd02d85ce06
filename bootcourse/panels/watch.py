"""A training while it learns: curves that grow, and the road on which the present agent drives beside its older self.

`Training.run()` shows it in a notebook; `train_panel` has it below its sliders. A click on a curve puts the agent of
that moment at the wheel. The page draws and drives; Python sends two sets of weights now and then, and the curves.
"""

import time
from collections.abc import Sequence
from dataclasses import replace

import numpy as np
import traitlets

from bootcourse import one_per_cell
from bootcourse.learn.agent import Agent
from bootcourse.learn.training import Result, Training
from bootcourse.methods import display_name, style
from bootcourse.plots.svg import INK, QUIET, Drawing, SvgAxes, drawing, line, printed, span, text
from bootcourse.plots.training_curves import MEASURES, draw_training, finished, window_of
from bootcourse.statistics import rolling_means
from bootcourse.web.guests import Guest, alone, guest
from bootcourse.web.widget import World

SHOWN = ("success", "return", "entropy", "xi")  # of the measures
LEFT, TOP, ACROSS, DOWN, WIDE, HIGH = 46, 58, 270, 176, 216, 110  # px, of the small charts
SIZE = (2 * ACROSS + 10, 2 * DOWN + 40)
KEEP, BEFORE = 100, 500  # updates between the agents that are kept, and to the agent beside
AGENTS = 300  # kept at most: of more, every second one goes
SHARE, PAUSE = 0.03, 1.0  # of the training's time, at most; s between two looks, at least
FIRST_ROAD = 1_000_000  # which no agent has trained on
Marks = list[tuple[int, str]]  # (episode, what was changed)


class Watch(World):
    """What a training shows of itself; `look` is its callback, `stopping` whether the reader wants to stop it.

    button: whether it has a button to stop the training.
    """

    chart = traitlets.Unicode().tag(sync=True)
    words = traitlets.Unicode().tag(sync=True)
    running = traitlets.Bool(True).tag(sync=True)

    def __init__(self, training: Training, button: bool = True):
        self.training, self.stopping, self.marks = training, False, []
        methods = [settings.method for settings in training.settings]
        self.number = methods.index(methods[-1])  # of the agent that is watched: of several methods the last's first
        self.kept: list[tuple[int, int, Agent]] = []  # (updates, episodes, the agent)
        self.spent, self._due, self._chosen = 0.0, 0.0, None
        opens = {"road": FIRST_ROAD, "driver": "now", "ghost": "before", "pace": 2, "futures": 0, "view": "above"}
        opens |= {"details": False, "height": SIZE[1] + 40, "watch": True, "run": True, "stop": button}
        super().__init__(self._pair(), opens, training.scenario)
        self._draw()

    def look(self, training: Training) -> None:
        """Called after each decision: now and then, send the curves, and let the present agent drive."""
        now = time.monotonic()
        if training.updates >= (self.kept[-1][0] + KEEP if self.kept else 0):
            self._keep(training)
        if now >= self._due:
            self.show_now(f"{training.updates:,} updates, {training.decisions:,} decisions")
            took = time.monotonic() - now
            self._due = now + max(PAUSE, took / SHARE)
        self.spent += time.monotonic() - now

    def show_now(self, words: str) -> None:
        """Send what there is now."""
        with self.hold_sync():
            self._draw()
            self.words = words
            if self._chosen is None:
                self.offer(**self._pair())

    def ended(self, result: Result) -> None:
        """The training is over: the last agents stay."""
        self._keep(self.training)
        self.running = False
        self.show_now(f"{'Stopped' if result.interrupted else 'Done'} after {self.training.updates:,} updates")

    def change(self, symbol: str, setting: str, value: float) -> None:
        """Let the agents go on with another value, and mark the moment in the curves."""
        self.training.change(**{setting: value})
        self.marks.append((finished(self.training.curves.values), f"{symbol} {value:g}"))

    def _draw(self) -> None:
        training = self.training
        methods = [settings.method for settings in training.settings]
        self.svg = training_chart(methods, training.curves.values, training.episodes, self.marks)
        self.chart = str(self.svg)

    def _keep(self, training: Training) -> None:
        self.kept.append((training.updates, self._episodes(), self._agent()))
        if len(self.kept) > AGENTS:
            del self.kept[1::2]

    def _agent(self) -> Agent:
        """The agent that is watched, without its critics if it drives without."""
        agent = self.training.agent(self.number)
        return replace(agent, critics=[]) if alone(agent) else agent

    def _episodes(self) -> int:
        return int(self.training.curves.finished[self.number])

    def _pair(self) -> dict[str, Guest]:
        """The present agent, or the one that was clicked, and the one of some hundred updates before."""
        chosen = self._chosen or (self.training.updates, 0, self._agent())
        before = [each for each in self.kept if each[0] <= chosen[0] - BEFORE] or self.kept[:1] or [chosen]
        called = {"now": ("the agent now" if self._chosen is None else f"after {chosen[0]:,} updates", chosen),
                  "before": (f"after {before[-1][0]:,} updates", before[-1])}  # fmt: skip
        colour = {"colour": style(chosen[2].settings.method).colour}
        pair = {name: guest(agent, 1, words) for name, (words, (_, _, agent)) in called.items()}
        return {name: each._replace(told=each.told | colour) for name, each in pair.items()}

    def _heard(self, widget, message: dict, buffers) -> None:
        if message.get("kind") == "stop":
            self.stopping = True
        elif message.get("kind") == "choose":
            self._choose(float(message["x"]))
        else:
            super()._heard(widget, message, buffers)

    def _choose(self, x: float) -> None:
        """A click on the curves, at so many pixels from the left: right of their end, the present agent again."""
        episode = ((x - LEFT) % ACROSS) / WIDE * self.training.episodes
        reached = int(self._episodes())
        self._chosen = (
            None if episode > reached else min(self.kept, key=lambda kept: abs(kept[1] - episode), default=None)
        )
        self.offer(**self._pair())

    def _repr_mimebundle_(self, **kwargs) -> tuple[dict, dict]:
        data, metadata = super()._repr_mimebundle_(**kwargs)
        return data | self.picture(printed(self.svg), self.svg.alt), metadata


def training_chart(methods: Sequence[str], curves: dict[str, np.ndarray], episodes: int, marks: Marks = ()) -> Drawing:
    """Four small charts of a training, always of the same size: thin lines are agents, thick ones a method's mean.

    methods: of each agent. curves: as `Result.curves`, each (agents, episodes), NaN where still to come; empty before
    the training.
    """
    names, done, window = dict.fromkeys(methods), finished(curves), window_of([curves])
    called = " and ".join(map(display_name, names))
    words = f"{called}: means of {window} episodes. Thin: an agent." if done else f"{called}: no episode has ended yet."
    parts, ends = [text(12, 18, words, fill=QUIET)], []
    for i, shown in enumerate(SHOWN):
        measure, at, means = MEASURES[shown], np.zeros(0), np.zeros((0, 0))
        if done:
            at, means = rolling_means(curves[shown][:, :done] * measure.factor, window)
        left, top = LEFT + (i % 2) * ACROSS, TOP + (i // 2) * DOWN
        limits = measure.limits or span(means.ravel(), measure.least)
        axes = SvgAxes(left, top, WIDE, HIGH, (0, max(episodes, 1)), limits)
        axes.frame(measure.label, "episode")
        for episode, changed in marks:
            x, y = axes.at(episode, axes.y[1])
            parts += [line(x, y, x, y + HIGH, QUIET, 1, 'stroke-dasharray="3 3"'), text(x + 3, y + 9, changed, size=9)]
        for method in names if done else ():
            own = means[[each == method for each in methods]]
            end = draw_training(axes, at, own, style(method))
            if np.isfinite(end):
                axes.dot(at[np.isfinite(own).all(axis=0)][-1], end, style(method).colour)
                ends.append(f"{display_name(method)} {measure.label} {end:.3g}")
                if len(names) == 1:
                    parts.append(text(left + WIDE, top - 8, f"{end:.3g}", "end", INK, 12, bold=True))
        parts += axes.parts
    ends = f" After {done} episodes: {', '.join(ends)}." if ends else f" {called}: no episode has ended yet."
    return drawing(*SIZE, parts, f"Training curves.{ends}")


_shown: dict[str, tuple[int, list[Watch]]] = {}  # cell: how often it had run, and what it showed then


def watched(training: Training) -> Watch | None:
    """Show a training in the running cell of a notebook; None elsewhere, and off the trap."""
    cell = one_per_cell.this_cell()
    if cell is None or not training.place.is_trap:
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
