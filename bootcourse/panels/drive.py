"""Drive the ego yourself: nine buttons or the arrow keys, step by step or in real time, against a ghost.

    mine = drive_panel(seed=3)
    mine.rollout          # what you drove, as `record` would have recorded it
    mine.demonstrations   # what you saved as demonstrations: train_panel(drives=mine.demonstrations)

`episodes/interactive.py` drives, `cockpit.py` draws, `pad.py` reads the keys.
"""

import os
import threading
import time
from collections.abc import Callable
from pathlib import Path

import ipywidgets as widgets
import numpy as np

from bootcourse.episodes.interactive import InteractiveEpisode
from bootcourse.episodes.lookahead import Imagined, nine_drives
from bootcourse.episodes.record import record
from bootcourse.episodes.rollout import Rollout
from bootcourse.errors import BootcourseError, whole
from bootcourse.panels.arguments import LAST_ROAD, check_road
from bootcourse.panels.cockpit import Futures, cockpit
from bootcourse.panels.number import Number
from bootcourse.panels.pad import Pad
from bootcourse.panels.panel import Panel
from bootcourse.panels.ticker import Ticker
from bootcourse.plots.futures import in_words, trails
from bootcourse.plots.svg import Drawing
from bootcourse.policies import Policy, rule_policy
from bootcourse.scenario import ACTION_NAMES, DEFAULT, IDLE, Scenario

FRAMES = 10.0  # Hz, in real time
STEPS, REAL = "step by step", "real time"
PACE = (0.1, 10.0)  # s that a decision may take
WIDE = "124px"  # a button


def check_pace(value: float) -> None:
    if not PACE[0] <= value <= PACE[1]:
        raise BootcourseError(f"pace = {value:g} s: give {PACE[0]:g} to {PACE[1]:g} seconds for a decision.")


class DrivePanel(Panel):
    """`.rollout` is the present drive (None before its first decision), `.drives` those before it.

    Two threads write here: the main thread when something is pressed, and the clock's thread at each tick. Each
    holds `_lock` while it writes. The main thread stops the clock without it, since that waits for the last tick.
    """

    ticker: Ticker | None = None

    def __init__(
        self, seed: int, scenario: Scenario, ghost_of: Callable[[int], Rollout], fixed: str, futures: Policy | None
    ):
        self.scenario, self.ghost_of, self.base = scenario, ghost_of, futures or rule_policy(scenario)
        self._imagined: tuple[tuple, Imagined] | None = None  # of the last picture: (drive, decision), drives
        self.drives: list[Rollout] = []
        self.demonstrations: list[Rollout] = []
        self._lock = threading.RLock()
        self._kept: InteractiveEpisode | None = None  # the drive whose rollout is the last demonstration
        self.drive, self.ghost = InteractiveEpisode(seed, scenario), ghost_of(seed)
        self.shown, self.coming = 0.0, None
        self.ticker = Ticker(self._tick, FRAMES)
        self.pad, self.view = Pad(self.press), widgets.HTML()
        self.view.add_class("bc-road")
        self.mode = widgets.ToggleButtons(
            options=[STEPS, REAL], tooltips=["A decision for each press", "A decision for each tick of the clock"]
        )
        self.mode.style.button_width = "118px"
        make = self.make_button
        self.go = make("Start", "play", "Start or pause the clock (real time)", self._go, "primary", WIDE)
        self.again = make("Drive again", "refresh", "The same road, from its start", self._again, width=WIDE)
        self.pace = Number("pace", 1.0, 0.2, 3.0, 0.1, "How long a decision takes in real time.", "s", check_pace)
        self.road = Number("road", seed, 0, 99, 1, "The seed of the road. Another one begins a new drive.",
                           check=check_road)  # fmt: skip
        self.road.lock(fixed)
        help = "Save this drive as a demonstration for an agent"
        self.keep = make("Keep as demonstration", "graduation-cap", help, self._keep, width="214px")
        help = "Write this drive to the file, to draw or to replay it"
        self.save = make("Save", "save", help, self._save, width=WIDE)
        self.path = widgets.Text(_path(seed), tooltip="Where Save writes", layout={"width": "230px"})
        self.nine = widgets.Checkbox(
            futures is not None, description="nine futures", indent=False,
            tooltip="Draw where each action leads if the base policy drives on: red ends in an accident",
        )  # fmt: skip
        mode = widgets.HBox([self.mode, self.go, self.again])
        store = widgets.HBox([self.keep, self.save, self.path, self.nine], layout={"flex_flow": "row wrap"})
        row = {"flex_flow": "row wrap", "grid_gap": "6px 28px"}
        controls = widgets.VBox([mode, self.pace, self.road, store], layout={"grid_gap": "4px"})
        super().__init__("Drive it yourself", self.view, widgets.HBox([self.pad, controls], layout=row))
        self.mode.observe(lambda change: self.handle(self._new_mode), "value")
        self.road.observe(lambda change: self.handle(self._again), "value")
        self.nine.observe(lambda change: self.handle(self._draw), "value")
        self._new_mode()
        self._draw()

    @property
    def rollout(self) -> Rollout | None:
        with self._lock:
            return self.drive.rollout() if self.drive.actions else None

    def press(self, action: int) -> None:
        """A button or a key: decide now, or choose what the clock's next decision is."""
        with self._lock:
            self.say()
            if self.drive.over:
                self.say("This drive is over: press Drive again, or choose another road.")
                return
            if self.mode.value == STEPS:
                self.drive.decide(action)
                self.shown = self.drive.time
            else:
                self._choose(action)
                self._start_clock()
            self._draw()

    def close(self) -> None:
        if not self.closed and self.ticker is not None:
            self.ticker.stop()
        super().close()

    def picture(self) -> Drawing:
        with self._lock:
            return cockpit(self.drive, self.ghost, self.shown, futures=self.futures())

    def _choose(self, action: int | None) -> None:
        """What the clock's next decision is; None: keep straight, and mark no button."""
        self.coming = action
        self.pad.mark(action)

    def _tick(self, passed: float) -> bool:
        """In the clock's thread, FRAMES times a second: drive on, and draw. Returns whether to go on."""
        with self._lock:
            try:
                if self.shown >= self.drive.time and not self.drive.over:
                    self.drive.decide(IDLE if self.coming is None else self.coming)
                    self._choose(None)
                decision = 1 / self.scenario.clock.decision_rate
                self.shown = min(self.shown + passed * decision / self.pace.value, self.drive.time)
                self._draw()
                going = not self.drive.over or self.shown < self.drive.time
            except Exception as error:  # an error in a thread is shown nowhere else
                self.say(f"The drive broke off: {type(error).__name__}: {error}", wrong=True)
                going = False
            if not going:
                self._show_clock(running=False)
            return going

    def _go(self) -> None:
        if self.mode.value != REAL:
            raise BootcourseError("Step by step there is no clock to start: choose real time.")
        if self.ticker.running:
            self._stop_clock()
        elif self.drive.over:
            raise BootcourseError("This drive is over: press Drive again, or choose another road.")
        else:
            self._start_clock()

    def _start_clock(self) -> None:
        with self._lock:
            self._show_clock(running=True)
            self.ticker.start()

    def _stop_clock(self) -> None:
        self.ticker.stop()
        self._show_clock(running=False)

    def _show_clock(self, running: bool) -> None:
        self.go.description, self.go.icon = ("Pause", "pause") if running else ("Start", "play")

    def _new_mode(self) -> None:
        self._stop_clock()
        with self._lock:
            self.shown = self.drive.time
            self._choose(None)
            self.go.disabled = self.mode.value == STEPS
            self.pace.lock("Step by step, a decision waits for you." if self.mode.value == STEPS else "")
            self._draw()

    def _again(self) -> None:
        self._stop_clock()
        seed = int(self.road.value)
        with self._lock:
            ghost = self.ghost if seed == self.drive.seed else self.ghost_of(seed)
            if self.drive.actions:
                self.drives.append(self.drive.rollout())
            self.drive, self.ghost, self.shown = InteractiveEpisode(seed, self.scenario), ghost, 0.0
            self._choose(None)
            self.path.value = _path(seed)
            self._draw()

    def _keep(self) -> None:
        with self._lock:
            rollout = self.drive.rollout()
            if self._kept is self.drive:
                self.demonstrations[-1] = rollout
            else:
                self.demonstrations.append(rollout)
            self._kept = self.drive
        count = sum(len(each.actions) for each in self.demonstrations)
        drives = f"{len(self.demonstrations)} demonstration{'s' * (len(self.demonstrations) > 1)}"
        self.say(f"{drives}, {count} decisions: train_panel(drives=PANEL.demonstrations) learns from them.")

    def _save(self) -> None:
        with self._lock:
            rollout = self.drive.rollout()
        path = Path(os.path.expanduser(self.path.value.strip()))
        if path.name in ("", ".."):
            raise BootcourseError("Name a file to save to, such as drives/mine.npz.")
        path = path if path.suffix == ".npz" else path.with_name(path.name + ".npz")
        if os.path.lexists(path):
            raise BootcourseError(f"{path} exists already: choose another name.")
        self.say(f"Saved to {rollout.save(path).resolve()}.")

    def _draw(self) -> None:
        coming = "" if self.coming is None else ACTION_NAMES[self.coming]
        with self._lock:
            self.view.value = cockpit(self.drive, self.ghost, self.shown, coming, self.futures())

    def futures(self) -> Futures | None:
        """The nine imagined drives from the last decision that is shown; the chosen one, or else the best, is bold."""
        rate, steps = self.scenario.clock.decision_rate, self.scenario.clock.steps
        decision, actions = int(self.shown * rate + 1e-9), self.drive.actions
        if not self.nine.value or (self.drive.over and self.shown >= self.drive.time):
            return None
        if self._imagined is None or self._imagined[0] != (self.drive, decision):
            cars = np.array(self.drive.recorder.states[decision * steps])[None]
            self._imagined = (self.drive, decision), nine_drives(cars, self.base, self.scenario)
        imagined = self._imagined[1]
        chosen = actions[decision] if decision < len(actions) else int(imagined.values[0].argmax())
        return Futures(trails(imagined, chosen), in_words(imagined))


def _path(seed: int) -> str:
    return f"drives/road-{seed}-{time.strftime('%Y%m%d-%H%M%S')}.npz"


def drive_panel(
    seed: int = 0,
    ghost: Rollout | Policy | None = None,
    scenario: Scenario = DEFAULT,
    futures: Policy | None = None,
) -> DrivePanel:
    """Drive the road of a seed yourself.

    futures: the base policy of the nine imagined drives, which the panel then draws from the start. Without one, the
    switch "nine futures" takes the rule.

    ghost: whom you drive against. None: the rule. A policy (such as `agent.as_policy()`) drives each road that you
    choose; a rollout is one drive, of this seed and scenario. Raises BootcourseError if it is of another, or if the
    seed is not a whole number in range.
    """
    seed = whole(seed, "seed", LAST_ROAD)
    if isinstance(ghost, Rollout):
        if ghost.seed != seed or ghost.scenario != scenario:
            raise BootcourseError(
                f"This ghost drove road {ghost.seed} of the scenario '{ghost.scenario.name}', and you drive road "
                f"{seed} of '{scenario.name}': give a drive of the same road."
            )
        return DrivePanel(seed, scenario, lambda seed: ghost, "The road of the ghost that you gave.", futures)
    policy, label = (rule_policy(scenario), "rule") if ghost is None else (ghost, "agent")
    return DrivePanel(seed, scenario, lambda seed: record(policy, [seed], scenario, label)[0], "", futures)
