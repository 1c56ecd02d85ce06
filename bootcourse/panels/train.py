"""Train while you watch: choose a method, start, and move p, ξ, c and β while the agents learn (see watch.py).

trainer = train_panel()
trainer.result                                  # of the last training: bc.save_runs(trainer.result, "runs/mine")
train_panel(drives=world.attempts)              # bootstrap from your own drives (see `bc.world`)
"""

import functools
import threading
import time
from collections.abc import Callable, Sequence

import ipywidgets as widgets
import torch

from bootcourse.episodes.rollout import Rollout
from bootcourse.errors import BootcourseError, described
from bootcourse.learn.settings import Settings, settings_for, with_seeds
from bootcourse.learn.training import Result, Training, one_torch_thread
from bootcourse.markup import html
from bootcourse.methods import METHODS, display_name
from bootcourse.panels.number import Number, whole_number
from bootcourse.panels.panel import Panel, beside
from bootcourse.panels.watch import Watch, training_chart
from bootcourse.scenario import DEFAULT, Scenario

SLIDERS = {  # setting: symbol, low, high, step, help, unit
    "rule_p": ("p", 0.12, 0.999, 0.001, "How sure the stochastic rule π̃ is of its own action.", ""),
    "xi_multiplier": ("ξ", 0.1, 10_000, 0.05, "Strength of the pull towards the rule.", "× α"),
    "bonus": ("c", 0, 10, 0.1, "Bonus on a demonstrated action's reward.", ""),
    "beta_start": ("β", 0, 1, 0.01, "Share of demonstrations in a batch; moved while they learn, it stays.", ""),
}
LOGARITHMIC = ("xi_multiplier",)
SEEDS, EPISODES = 64, 20_000  # at most, of one training


class TrainPanel(Panel):
    """`.result` is what the last training learned, None before its end. The training runs in a thread of its own."""

    thread: threading.Thread | None = None
    watch: Watch | None = None

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
            self.numbers[name] = Number(symbol, start, low, high, step, help, unit, check_of(name),
                                        logarithmic=name in LOGARITHMIC)  # fmt: skip
            self.numbers[name].observe(functools.partial(self._slid, name), "value")
        self.seeds = Number("seeds", seeds, 1, 10, 1, "Agents that learn side by side, each with its own seed.",
                            check=whole_number("seeds", 1, SEEDS))  # fmt: skip
        self.episodes = Number("episodes", episodes or METHODS[method].episodes, 50, EPISODES, 50,
                               "Drives of each agent: 150 s, or until an accident.",
                               check=whole_number("episodes", 1, EPISODES))  # fmt: skip
        self.train = self.make_button("Train", "play", "Train for real, in the background", self._train, "primary")
        self.stop = self.make_button("Stop", "stop", "Stop, and keep what was learned", self._stopping.set)
        self.progress, self.stage = widgets.HTML(), widgets.VBox()
        buttons = widgets.HBox([self.method, self.train, self.stop, self.progress], layout={"flex_flow": "row wrap"})
        numbers = beside(*self.numbers.values(), self.seeds, self.episodes)
        super().__init__("Train while you watch", numbers, buttons, self.stage)
        self.method.observe(self._choose, "value")
        self._show_used()
        self.svg = training_chart([method], {}, 1000)
        self._buttons(running=False)

    def settings(self) -> Settings:
        """The settings that the controls show. Raises BootcourseError if they do not fit together."""
        chosen = {name: number.value for name, number in self.numbers.items() if name not in self._unused()}
        return settings_for(self.method.value, **(self.others | chosen))

    def close(self) -> None:
        """Stop the training, and remove the panel."""
        if self.thread is not None and not self.closed:
            self._stopping.set()
            self.thread.join(5.0)
        super().close()

    def _choose(self, change=None) -> None:
        self.episodes.value = METHODS[self.method.value].episodes  # 1,000 are too few for one update of PPO
        self._show_used()

    def _unused(self) -> set[str]:
        """The settings with a slider of which the method makes no use."""
        own = METHODS[self.method.value].settings
        without_kl, without_demonstrations = own.get("xi_multiplier") == 0, own.get("beta_start") == 0
        unused = {"rule_p", "xi_multiplier"} if without_kl else set()
        unused |= {"bonus", "beta_start"} if without_demonstrations else {"bonus"} if own.get("bonus") == 0 else set()
        return unused

    def _show_used(self) -> None:
        for name, number in self.numbers.items():
            number.layout.display = "none" if name in self._unused() else None

    def _slid(self, name: str, change) -> None:
        """A slider was moved while the agents train: they go on with its value, and the curves say when."""
        if self.watch is None or not self.watch.running:
            return
        with self.saying_what_is_wrong():
            self.say()
            symbol, *_, unit = SLIDERS[name]
            self.watch.change(symbol, name, change["new"], unit)

    def _train(self) -> None:
        settings = self.settings()
        agents, episodes = with_seeds(settings, int(self.seeds.value)), int(self.episodes.value)
        drives = list(self.drives or ()) if settings.needs_demonstrations else []
        self._stopping.clear()
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
            training = Training(agents, episodes, self.scenario, demonstrations=drives, learner="faster")
            before, self.watch = self.watch, Watch(training, button=False)
            self.stage.children = [self.watch]
            if before is not None:
                before.close()
            self._due = 0.0
            self.result = training.run(progress=False, callback=self._look, stop=self._stopped)
            self.watch.ended(self.result, by_hand=self.result.interrupted)
            self._tell(training, "Stopped" if self.result.interrupted else "Done")
            self.svg = self.watch.svg
            if self.result.stopped:
                seeds = ", ".join(str(agents[i].seed) for i in sorted(self.result.stopped))
                self.say(f"Diverged, and kept as last finite: seed {seeds}.", wrong=True)
        except Exception as error:
            sentence = str(error) if isinstance(error, BootcourseError) else described(error)
            self.say(f"The training broke off. {sentence}", wrong=True)
        finally:
            self._buttons(running=False)

    def _stopped(self) -> bool:
        return self._stopping.is_set() or self.watch.stopping

    def _look(self, training: Training) -> None:
        """In the training's thread, after each decision."""
        self.watch.look(training)
        if time.monotonic() >= self._due and not self._stopped():
            self._tell(training, "Training")
            self._due = time.monotonic() + 1

    def _tell(self, training: Training, how: str) -> None:
        driven = int(training.curves.finished.clip(max=training.episodes).sum())
        total, seconds = training.n_agents * training.episodes, training.seconds
        self.progress.value = progress(f"{how}: {driven:,} of {total:,} episodes in {seconds:.0f} s", driven / total)

    def _buttons(self, running: bool) -> None:
        self.train.disabled, self.stop.disabled = running, not running


def check_of(setting: str) -> Callable[[float], Settings]:
    """A check of a number: does the library take it for this setting?"""
    return lambda value: settings_for("bootstrapped", **{setting: value})


def progress(words: str, share: float) -> str:
    """A bar, filled to a share, and words beside it."""
    bar = html('<progress max="1" value="{:.4f}" style="width:180px;vertical-align:middle"></progress>', share)
    return html('<div class="bc-quiet" role="status">{}&ensp;{}</div>', bar, words)


def train_panel(
    method: str = "bootstrapped",
    seeds: int = 4,
    episodes: int = 0,
    scenario: Scenario = DEFAULT,
    drives: Sequence[Rollout] | None = None,
    **changes,
) -> TrainPanel:
    """Choose a method, train for real, watch the present agent drive, and move p, ξ, c and β while it learns.

    episodes: of each agent; 0: the method's own number. drives: demonstrations to learn from instead of the rule's, if
    there is at least one when Train is pressed. changes: values of any settings (see
    `bootcourse.learn.settings.Settings`); one that has a slider starts there. Raises BootcourseError for a method or a
    setting that does not exist, and for a value out of range.
    """
    settings_for(method, **changes)
    whole_number("seeds", 1, SEEDS)(seeds)
    whole_number("episodes", 0, EPISODES)(episodes)
    return TrainPanel(method, seeds, episodes, scenario, drives, changes)
