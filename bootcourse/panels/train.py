"""Train while you watch: choose a method and its settings, start, stop, compare, watch in 3D, save.

    train_panel()                                   # trains for real, in the background
    train_panel(drives=mine.demonstrations)         # bootstrap from your own drives (see drive_panel)

The training runs in `background.py`, the drawing is `training_chart.py`; this file joins them.
"""

import os
import threading
import time
from collections.abc import Callable, Sequence
from pathlib import Path

import ipywidgets as widgets
import numpy as np

from bootcourse.episodes.evaluate import held_out_seeds
from bootcourse.episodes.record import record
from bootcourse.episodes.rollout import Rollout
from bootcourse.errors import BootcourseError
from bootcourse.learn.settings import Settings, settings_for, with_seeds
from bootcourse.learn.training import Result, Training
from bootcourse.markup import html
from bootcourse.methods import METHODS, display_name
from bootcourse.panels.arguments import whole_number
from bootcourse.panels.background import Background
from bootcourse.panels.number import Number
from bootcourse.panels.panel import Panel
from bootcourse.panels.train_controls import CONTROLLED, numbers_for, without
from bootcourse.panels.training_chart import Drawn, label_of, training_chart
from bootcourse.plots.svg import Drawing
from bootcourse.scenario import DEFAULT, Scenario
from bootcourse.storage.runs import save_runs

SEEDS, EPISODES = 64, 20_000  # at most, of one training
# Scrolls to what stands beside it, below the curves. Text that is put into a page runs no <script>, but this.
SHOW = """<img src="data:," alt="" style="display:none"
  onerror="const stage = this.parentElement; this.remove(); stage.scrollIntoView({block: 'nearest'})">"""
HELD_OUT = 1  # the block of roads that no agent has trained on


class TrainPanel(Panel):
    """`.result` is the last training's `Result`, `.close()` ends everything.

    Two threads write here: the main thread when a button is pressed, and the training's thread when it looks and
    when it has ended. Each holds `_lock` while it writes.
    """

    background: Background | None = None
    replay = None

    def __init__(self, method: str, seeds: int, episodes: int, scenario: Scenario, drives, changes: dict):
        self.scenario, self.drives = scenario, drives
        self.others = {name: value for name, value in changes.items() if name not in CONTROLLED}
        self.result: Result | None = None
        self.drawn: list[Drawn] = []  # trainings that are over
        self._lock = threading.RLock()
        self.method = widgets.Dropdown(options=[(display_name(method), method) for method in METHODS], value=method)
        self.method.layout.width = "300px"
        label = widgets.HTML("<b>method</b>", layout={"width": "92px"})
        about = widgets.HTML('<div class="bc-quiet">Who learns, and from what.</div>')
        chooser = widgets.VBox(
            [widgets.HBox([label, self.method], layout={"align_items": "center"}), about], layout={"width": "420px"}
        )
        self.numbers, self._usual_gamma = numbers_for(changes), Settings().gamma
        episodes, self._usual_episodes = episodes or METHODS[method].episodes, METHODS[method].episodes
        self.seeds = Number("seeds", seeds, 1, 10, 1, "Agents that learn side by side, each with its own seed.",
                            check=whole_number("seeds", 1, SEEDS))  # fmt: skip
        self.episodes = Number("episodes", episodes, 50, EPISODES, 50,
                               "Drives of each agent: 150 s, or until an accident.",
                               check=whole_number("episodes", 1, EPISODES))  # fmt: skip
        grid = widgets.GridBox(
            [chooser, *self.numbers.values(), self.seeds, self.episodes],
            layout={"grid_template_columns": "repeat(auto-fit, minmax(420px, 1fr))", "grid_gap": "2px 24px"},
        )
        self.train = self.make_button("Train", "play", "Train for real, in the background", self._train, "primary")
        self.stop = self.make_button("Stop", "stop", "Stop, and keep what was learned", self._stop)
        help = "Replay in 3D how the best agent drives a road that it was not trained on"
        self.watch = self.make_button("Watch", "eye", help, self._watch)
        self.save = self.make_button("Save", "save", "Write a run's folder for each agent", self._save)
        self.path = widgets.Text("", placeholder="folder", tooltip="Where Save writes", layout={"width": "320px"})
        buttons = widgets.HBox([self.train, self.stop, self.watch, self.save, self.path])
        self.progress, self.chart, self.stage = widgets.HTML(), widgets.HTML(), widgets.HTML()
        super().__init__("Train while you watch", grid, buttons, self.progress, self.chart, self.stage)
        self.says.layout.min_height = "22px"  # messages stand above the curves, and the curves stay where they are
        self.children = (*self.children[:4], self.says, *self.children[4:-1])
        self.method.observe(lambda change: self._choose(), "value")
        self._choose()
        self._show_progress("Ready.", 0.0)
        self._buttons(running=False)
        self._draw()

    @property
    def training(self) -> bool:
        return self.background is not None and self.background.running

    def settings(self) -> Settings:
        """The settings that the controls show. Raises BootcourseError if they do not fit together."""
        method = self.method.value
        chosen = {each: number.value for each, number in self.numbers.items() if each not in without(method)}
        return settings_for(method, **(self.others | chosen))

    def close(self) -> None:
        if not self.closed:
            if self.background is not None:
                self.background.stop()
                self.background.wait(5.0)
            self._close_replay()
        super().close()

    def picture(self) -> Drawing:
        return training_chart(self.drawn)

    def handle(self, does: Callable[[], None]) -> None:
        with self._lock:
            super().handle(does)

    def _choose(self) -> None:
        reasons, gamma, own = without(self.method.value), self.numbers["gamma"], settings_for(self.method.value).gamma
        if gamma.value == self._usual_gamma:  # untouched: it is the method's
            gamma.value = own
        self._usual_gamma = own
        if self._usual_episodes != METHODS[self.method.value].episodes:  # 1,000 are too few for one update of PPO
            self.episodes.value = self._usual_episodes = METHODS[self.method.value].episodes
        for setting, control in self.numbers.items():
            control.lock(reasons.get(setting, ""))

    def _train(self) -> None:
        settings = self.settings()
        agents = with_seeds(settings, int(self.seeds.value))
        episodes = int(self.episodes.value)
        mine = list(self.drives or ()) if settings.needs_demonstrations else []

        def make() -> Training:
            return Training(agents, episodes, self.scenario, demonstrations=mine or None)

        label = f"{len(self.drawn) + 1} {label_of(settings)}" + (f", {len(mine)} own drives" if mine else "")
        background = Background(
            make,
            look=lambda training: self._look(training, label),
            ended=lambda background: self._ended(background, label),
            say=self._say_from_thread,
        )
        background.start()
        self.background = background
        self._show_progress("Preparing: roads, networks, demonstrations …", 0.0)
        self._buttons(running=True)

    def _stop(self) -> None:
        if not self.training:
            raise BootcourseError("No training runs in this panel.")
        self.background.stop()
        self._show_progress("Stopping …", 0.0)

    def _look(self, training: Training, label: str) -> None:
        """In the training's thread, a few times a second; left out while a button is handled."""
        if not self._lock.acquire(blocking=False):
            return
        try:
            if self.background.stopping:
                return
            driven, total = _driven(training)
            left = training.seconds * (total - driven) / driven if driven else 0.0
            speed = training.decisions / max(training.seconds, 1e-9)
            words = f"{driven:,} of {total:,} episodes · {speed:,.0f} decisions/s"
            self._show_progress(words + (f" · about {_duration(left)} left" if driven else ""), driven / total)
            curves = {curve: values.copy() for curve, values in training.curves.values.items()}
            self._draw(Drawn(label, training.settings[0].method, curves, training.episodes))
        finally:
            self._lock.release()

    def _ended(self, background: Background, label: str) -> None:
        """In the training's thread, when it is over."""
        with self._lock:
            try:
                self._show_end(background, label)
            finally:
                self._buttons(running=False)

    def _show_end(self, background: Background, label: str) -> None:
        result, wrong = background.result, [background.error] if background.error else []
        if result is None:
            self._show_progress("Nothing was trained.", 0.0)
        else:
            self.result, method = result, result.agents[0].settings.method
            self.path.value = f"runs/{method}-{time.strftime('%Y%m%d-%H%M%S')}"
            driven, total = _driven(background.training)
            how = "Stopped" if result.interrupted else "Done"
            words = f"{how} after {driven:,} of {total:,} episodes, {_duration(result.seconds)}."
            self._show_progress(words, driven / total)
            for i, decision in sorted(result.stopped.items()):
                agent = result.agents[i].settings
                wrong.append(
                    f"{display_name(agent.method)}, seed {agent.seed}, diverged: its loss was not finite at decision "
                    f"{decision}. Its last finite snapshot is kept."
                )
            self.drawn = [*self.drawn, Drawn(label, method, result.curves, background.training.episodes)]
        if wrong:
            self.say(" ".join(wrong), wrong=True)
        self._draw()

    def _say_from_thread(self, sentence: str) -> None:
        with self._lock:
            self.say(sentence, wrong=True)

    def _watch(self) -> None:
        if self.background is None:
            raise BootcourseError("Nothing was trained yet: press Train first.")
        result = self.background.peek()
        agent = result.agents[max(range(len(result.agents)), key=lambda i: _last_return(result, i))]
        road = held_out_seeds(HELD_OUT, 1)[0]
        label = f"{agent.settings.method}, seed {agent.settings.seed}"
        rollout = record(agent.as_policy(with_q=True), [road], self.scenario, label)[0]
        self._close_replay()
        self.replay = _replay(rollout)
        self.stage.value = SHOW + self.replay._repr_mimebundle_()["text/html"]
        self.say(
            f"The best of {len(result.agents)} so far, {display_name(label)}, on road {road}, which no agent has seen."
        )

    def _save(self) -> None:
        if self.training or self.result is None:
            raise BootcourseError("There is nothing to save: train first, or stop what runs.")
        if not self.path.value.strip():
            raise BootcourseError("Name a folder to save to, such as runs/mine.")
        folders = save_runs(self.result, Path(os.path.expanduser(self.path.value.strip())))
        self.say(f"Saved {len(folders)} run{'s' * (len(folders) > 1)} to {folders[0].parent.resolve()}.")

    def _close_replay(self) -> None:
        if self.replay is not None:
            self.replay.close()
            self.replay, self.stage.value = None, ""

    def _buttons(self, running: bool) -> None:
        self.train.disabled, self.stop.disabled = running, not running
        self.watch.disabled = self.background is None
        self.save.disabled = self.path.disabled = running or self.result is None

    def _show_progress(self, words: str, share: float) -> None:
        bar = html('<progress max="1" value="{:.4f}" style="width:300px;vertical-align:middle"></progress>', share)
        self.progress.value = html('<div class="bc-quiet" role="status">{}&ensp;{}</div>', bar, words)

    def _draw(self, *now: Drawn) -> None:
        """Draw the trainings that are over, and the present one's curves over them."""
        self.chart.value = training_chart([*self.drawn, *now])


def _replay(rollout: Rollout):
    """A replay that the panel closes, not the notebook cell."""
    from bootcourse.replay3d import scene, stage, viewer

    return viewer.Replay(scene.timelines_of(rollout), stage.Options(), height=560)


def _driven(training: Training) -> tuple[int, int]:
    """Episodes driven so far, and episodes in all, of all agents together."""
    driven = int(training.curves.finished.clip(max=training.episodes).sum())
    return driven, training.n_agents * training.episodes


def _last_return(result: Result, i: int) -> float:
    """Agent i's mean over its last 50 episodes; minus infinity before its first."""
    returns = result.curves["return"][i]
    returns = returns[np.isfinite(returns)][-50:]
    return float(returns.mean()) if returns.size else float("-inf")


def _duration(seconds: float) -> str:
    minutes, seconds = divmod(round(seconds), 60)
    return f"{minutes} min {seconds:02} s" if minutes else f"{seconds} s"


def train_panel(
    method: str = "bootstrapped",
    seeds: int = 4,
    episodes: int = 0,
    scenario: Scenario = DEFAULT,
    drives: Sequence[Rollout] | None = None,
    **changes,
) -> TrainPanel:
    """Choose, train for real, watch the curves grow, stop, compare, save.

    episodes: of each agent; 0: the method's own number, as after each choice of a method that has another one.
    drives: demonstrations to learn from instead of the rule's, if there is at least one when Train is pressed.
    changes: values of any settings (see `bootcourse.learn.settings.Settings`); a setting that has a control starts
    there. Raises BootcourseError for a method or a setting that does not exist, and for a value out of range.
    """
    settings_for(method, **changes)
    return TrainPanel(method, seeds, episodes, scenario, drives, changes)
