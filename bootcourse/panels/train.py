"""Train while you watch: choose a method, p, ξ and c, start, stop, and see in 3D what the best agent drives.

trainer = train_panel()
trainer.result                                  # of the last training: bc.save_runs(trainer.result, "runs/mine")
train_panel(drives=world.attempts)              # bootstrap from your own drives (see `bc.world`)
"""

import math
import threading
import time
from collections.abc import Callable, Sequence

import ipywidgets as widgets
import numpy as np
import torch

from bootcourse.episodes.evaluate import held_out_seeds
from bootcourse.episodes.record import record
from bootcourse.episodes.rollout import Rollout
from bootcourse.errors import BootcourseError, described
from bootcourse.learn.settings import Settings, settings_for, with_seeds
from bootcourse.learn.training import Result, Training, one_torch_thread
from bootcourse.markup import html
from bootcourse.methods import METHODS, display_name, style
from bootcourse.panels.number import Number, whole_number
from bootcourse.panels.panel import Panel, beside
from bootcourse.plots.svg import INK, QUIET, Drawing, SvgAxes, drawing, span, text
from bootcourse.plots.training_curves import MEASURES, draw_training, finished, window_of
from bootcourse.scenario import DEFAULT, Scenario
from bootcourse.statistics import rolling_means

SLIDERS = {  # setting: symbol, low, high, step, help, unit
    "rule_p": ("p", 0.12, 0.999, 0.001, "How sure the stochastic rule π̃ is of its own action.", ""),
    "xi_multiplier": ("ξ", 0, 2000, 10, "Strength of the pull towards the rule.", "× α"),
    "bonus": ("c", 0, 10, 0.1, "Bonus on a demonstrated action's reward.", ""),
}
SEEDS, EPISODES = 64, 20_000  # at most, of one training
LOOKS, SHARE = 5.0, 0.15  # drawings a second, and their share of the thread's time, at most
SHOWN = ("success", "return", "speed", "entropy", "alpha", "xi")  # of the measures
WIDTH, HEIGHT, COLUMNS = 1040, 398, 3
NOTHING = np.full((1, 1), np.nan)  # the curve of an agent before its first episode
HELD_OUT = 1  # the block of roads that no agent has trained on


class TrainPanel(Panel):
    """`.result` is what the last training learned, None before its end. The training runs in a thread of its own."""

    thread: threading.Thread | None = None
    replay = None

    def __init__(self, method: str, seeds: int, episodes: int, scenario: Scenario, drives, changes: dict):
        self.scenario, self.drives = scenario, drives
        self.others = {name: value for name, value in changes.items() if name not in SLIDERS}
        self.result: Result | None = None
        self._stopping = threading.Event()
        self.method = widgets.Dropdown(
            options=[(display_name(name), name) for name in METHODS], value=method, description="method"
        )
        self.numbers = {}
        for name, (symbol, low, high, step, help, unit) in SLIDERS.items():
            start = changes.get(name, getattr(Settings(), name))
            self.numbers[name] = Number(symbol, start, low, high, step, help, unit, check_of(name))
        self.seeds = Number("seeds", seeds, 1, 10, 1, "Agents that learn side by side, each with its own seed.",
                            check=whole_number("seeds", 1, SEEDS))  # fmt: skip
        self.episodes = Number("episodes", episodes or METHODS[method].episodes, 50, EPISODES, 50,
                               "Drives of each agent: 150 s, or until an accident.",
                               check=whole_number("episodes", 1, EPISODES))  # fmt: skip
        self.train = self.make_button("Train", "play", "Train for real, in the background", self._train, "primary")
        self.stop = self.make_button("Stop", "stop", "Stop, and keep what was learned", self._stopping.set)
        help = "Replay in 3D how the best agent drives a road that it was not trained on"
        self.watch = self.make_button("Watch", "eye", help, self._watch)
        self.progress, self.chart, self.stage = widgets.HTML(), widgets.HTML(), widgets.HTML()
        buttons = widgets.HBox([self.train, self.stop, self.watch])
        numbers = beside(*self.numbers.values(), self.seeds, self.episodes)
        shown = (self.progress, self.stage, self.chart)  # the replay opens below its button, where you look
        super().__init__("Train while you watch", self.method, numbers, buttons, *shown)
        self.method.observe(self._choose, "value")
        self._lock_unused()
        self._draw(method, {}, 1000)
        self._buttons(running=False)

    def settings(self) -> Settings:
        """The settings that the controls show. Raises BootcourseError if they do not fit together."""
        chosen = {name: number.value for name, number in self.numbers.items() if not number.field.disabled}
        return settings_for(self.method.value, **(self.others | chosen))

    def close(self) -> None:
        """Stop the training and the replay, and remove the panel."""
        if self.thread is not None and not self.closed:
            self._stopping.set()
            self.thread.join(5.0)
        self._close_replay()
        super().close()

    def _choose(self, change=None) -> None:
        self.episodes.value = METHODS[self.method.value].episodes  # 1,000 are too few for one update of PPO
        self._lock_unused()

    def _lock_unused(self) -> None:
        """Switch off the numbers that the method does not use."""
        own = METHODS[self.method.value].settings
        without_kl, without_demonstrations = own.get("xi_multiplier") == 0, own.get("beta_start") == 0
        unused = {"rule_p", "xi_multiplier"} if without_kl else set()
        unused |= {"bonus"} if without_demonstrations or own.get("bonus") == 0 else set()
        for name, number in self.numbers.items():
            number.lock(f"Without use in {display_name(self.method.value)}." if name in unused else "")

    def _train(self) -> None:
        settings = self.settings()
        agents, episodes = with_seeds(settings, int(self.seeds.value)), int(self.episodes.value)
        drives = list(self.drives or ()) if settings.needs_demonstrations else []
        self._stopping.clear()
        self._close_replay()
        self._buttons(running=True)
        self.progress.value = progress("Preparing: roads, networks, demonstrations …", 0.0)
        arguments = (agents, episodes, drives or None, begun := threading.Event())
        self.thread = threading.Thread(target=self._run, args=arguments, name="bootcourse training", daemon=True)
        with one_torch_thread():
            self.thread.start()
            begun.wait()

    def _run(self, agents: list[Settings], episodes: int, drives: list[Rollout] | None, begun) -> None:
        """In the training's thread, where an error would be shown nowhere else."""
        torch.get_num_threads()  # takes over the one thread that is set now; several are slower on small matrices
        begun.set()
        try:
            training = Training(agents, episodes, self.scenario, demonstrations=drives)
            self._next_look = 0.0
            self.result = training.run(progress=False, callback=self._look, stop=self._stopping.is_set)
            self._show(training, "Stopped" if self.result.interrupted else "Done")
            if self.result.stopped:
                seeds = ", ".join(str(agents[i].seed) for i in sorted(self.result.stopped))
                self.say(f"Diverged, and kept as last finite: seed {seeds}.", wrong=True)
        except Exception as error:
            sentence = str(error) if isinstance(error, BootcourseError) else described(error)
            self.say(f"The training broke off. {sentence}", wrong=True)
        finally:
            self._buttons(running=False)

    def _look(self, training: Training) -> None:
        """In the training's thread, after each decision: now and then, show how far it is."""
        started = time.monotonic()
        if started >= self._next_look and not self._stopping.is_set():
            self._show(training, "Training")
            ended = time.monotonic()
            self._next_look = ended + max(1 / LOOKS, (ended - started) * (1 / SHARE - 1))

    def _show(self, training: Training, how: str) -> None:
        driven = int(training.curves.finished.clip(max=training.episodes).sum())
        total, seconds = training.n_agents * training.episodes, training.seconds
        words = f"{how}: {driven:,} of {total:,} episodes in {seconds:.0f} s, "
        words += f"{training.decisions / max(seconds, 1e-9):,.0f} decisions/s"
        if how == "Training" and driven:
            words += f", about {seconds * (total - driven) / driven:.0f} s left"
        self.progress.value = progress(words, driven / total)
        self._draw(training.settings[0].method, training.curves.values, training.episodes)

    def _draw(self, method: str, curves: dict[str, np.ndarray], episodes: int) -> None:
        self.svg = self.chart.value = training_chart(method, curves, episodes)

    def _watch(self) -> None:
        from bootcourse.replay3d.viewer import Replay

        returns = self.result.curves["return"]
        last = [agent[np.isfinite(agent)][-50:] for agent in returns]
        best = max(range(len(last)), key=lambda i: last[i].mean() if last[i].size else -math.inf)
        agent, road = self.result.agents[best], held_out_seeds(HELD_OUT, 1)[0]
        label = f"{agent.settings.method}, seed {agent.settings.seed}"
        drive = record(agent.as_policy(with_q=True), [road], self.scenario, label)[0]
        self._close_replay()
        self.replay = Replay([drive], height=560)  # the panel closes it, not the notebook's cell
        self.stage.value = self.replay._repr_mimebundle_()["text/html"]
        self.say(f"The best of {len(last)}, {display_name(label)}, on road {road}, which no agent has seen.")

    def _close_replay(self) -> None:
        if self.replay is not None:
            self.replay.close()
            self.replay, self.stage.value = None, ""

    def _buttons(self, running: bool) -> None:
        self.train.disabled, self.stop.disabled = running, not running
        self.watch.disabled = running or self.result is None


def check_of(setting: str) -> Callable[[float], Settings]:
    """A check of a number: does the library take it for this setting?"""
    return lambda value: settings_for("bootstrapped", **{setting: value})


def progress(words: str, share: float) -> str:
    """A bar, filled to a share, and words beside it."""
    bar = html('<progress max="1" value="{:.4f}" style="width:300px;vertical-align:middle"></progress>', share)
    return html('<div class="bc-quiet" role="status">{}&ensp;{}</div>', bar, words)


def training_chart(method: str, curves: dict[str, np.ndarray], episodes: int) -> Drawing:
    """Six small charts of a training, always of the same size: thin lines are agents, the thick one their mean.

    curves: as `Result.curves`, each (agents, episodes), NaN where still to come; empty before the training.
    """
    name, done, window = display_name(method), finished(curves), window_of([curves])
    words = f"{name}: means of {window} episodes. Thin: an agent. Thick: the agents' interquartile mean."
    parts = [text(12, 18, words if done else "No episode has ended yet.", fill=QUIET)]
    ends = []
    for i, measure in enumerate(MEASURES[each] for each in SHOWN):
        at, means = (
            rolling_means(curves[SHOWN[i]] * measure.factor, window) if done else (np.zeros(0), np.zeros((0, 0)))
        )
        left, top = 50 + (i % COLUMNS) * 340, 62 + (i // COLUMNS) * 180
        axes = SvgAxes(left, top, 280, 112, (0, max(episodes, 1)), measure.limits or span(means.ravel(), measure.least))
        axes.frame(measure.label, "episode")
        end = draw_training(axes, at, means, style(method))
        if np.isfinite(end):
            axes.dot(at[np.isfinite(means).all(axis=0)][-1], end, style(method).colour)
            parts.append(text(left + 280, top - 8, f"{end:.3g}", "end", INK, 12, bold=True))
            ends.append(f"{measure.label} {end:.3g}")
        parts += axes.parts
    ends = f" {name}, after {done} episodes: {', '.join(ends)}." if ends else " No episode has ended yet."
    return drawing(WIDTH, HEIGHT, parts, f"Training curves.{ends}")


def train_panel(
    method: str = "bootstrapped",
    seeds: int = 4,
    episodes: int = 0,
    scenario: Scenario = DEFAULT,
    drives: Sequence[Rollout] | None = None,
    **changes,
) -> TrainPanel:
    """Choose a method, p, ξ and c, train for real, watch the curves grow, stop, and replay the best agent in 3D.

    episodes: of each agent; 0: the method's own number. drives: demonstrations to learn from instead of the rule's, if
    there is at least one when Train is pressed. changes: values of any settings (see
    `bootcourse.learn.settings.Settings`); one that has a slider starts there. Raises BootcourseError for a method or a
    setting that does not exist, and for a value out of range.
    """
    settings_for(method, **changes)
    whole_number("seeds", 1, SEEDS)(seeds)
    whole_number("episodes", 0, EPISODES)(episodes)
    return TrainPanel(method, seeds, episodes, scenario, drives, changes)
