"""The panel beside the scene: the time slider, the buttons, the switches, and the head-up display."""

from collections.abc import Callable

from bootcourse.methods import display_name
from bootcourse.plots.futures import LEGEND
from bootcourse.replay3d import hud, scene
from bootcourse.replay3d.camera import CAMERAS, point
from bootcourse.replay3d.player import SPEEDS
from bootcourse.road.state import Accident

PANEL_WIDTH = 330  # px
PLAY, PAUSE = "Play", "Pause"
STEPS = ("|◂", "◂", "▸", "▸|")  # to the start, one simulation step back, one forward, to the end


class ReplayControls:
    """Controls for `player` and `stage`; `refresh(t)` shows a time.

    restage(change, rebuild): called when a switch is set. It calls change() between two frames, makes the scene anew
    if `rebuild` is true, and shows it. viser calls the controls in threads of its own.
    """

    def __init__(self, server, player, stage, restage: Callable[[Callable[[], None], bool], None]):
        self.server, self.player, self.stage, self.restage = server, player, stage, restage
        self.timelines = stage.timelines
        self._shown = None
        gui = server.gui
        gui.main_panel.dock_right()
        gui.main_panel.set_width(PANEL_WIDTH)
        gui.add_html(hud.STYLE)
        self._playback(gui)
        cameras = gui.add_button_group("Camera", CAMERAS, hint="Where you look from; drag the road to look elsewhere")
        cameras.on_click(lambda event: event.client and point(event.client.camera, event.target.value, stage.span))
        self.table = gui.add_html("") if len(self.timelines) > 1 else None
        self.card = gui.add_html("")
        gui.add_html(str(hud.plots(self.timelines)))
        self.cursor = gui.add_html(str(hud.cursor(0.0)))
        with gui.add_folder("More"):
            self._pace(gui)
            self._switches(gui)

    def _playback(self, gui) -> None:
        player = self.player
        accidents = sorted({line.duration for line in self.timelines if line.rollout.accident != Accident.NONE})
        marks = tuple((t, "⚠") for t in accidents) or None
        self.time = gui.add_slider("Time, s", 0.0, player.duration, 0.1, 0.0, marks=marks)
        self.play = gui.add_button(PLAY, hint="Key P")
        dt = self.timelines[0].dt
        hint = f"To the start, {dt:g} s back (key J), {dt:g} s on (key K), to the end"
        steps = gui.add_button_group("Step", STEPS, hint=hint)
        if accidents:
            jump = gui.add_button("Go to the accident", color="red")
            jump.on_click(lambda _: self._jump(accidents))
        self.time.on_update(lambda event: player.seek(event.target.value, hold=True) if event.client else None)
        self.play.on_click(lambda _: self._toggle())
        steps.on_click(lambda event: self._step(event.target.value))
        gui.add_command("Play or pause", hotkey="P").on_trigger(lambda _: self._toggle())
        gui.add_command("Step back", hotkey="J").on_trigger(lambda _: player.step(-1))
        gui.add_command("Step forward", hotkey="K").on_trigger(lambda _: player.step(1))

    def _pace(self, gui) -> None:
        speed = gui.add_dropdown("Speed", tuple(SPEEDS), initial_value="1×")
        loop = gui.add_checkbox("Loop", self.player.loop)
        speed.on_update(lambda event: setattr(self.player, "speed", SPEEDS[event.target.value]))
        loop.on_update(lambda event: setattr(self.player, "loop", bool(event.target.value)))

    def _toggle(self) -> None:
        if self.player.playing:
            self.player.pause()
        else:
            self.player.play()

    def _step(self, which: str) -> None:
        first, back, _, last = STEPS
        if which in (first, last):
            self.player.pause()
            self.player.seek(0.0 if which == first else self.player.duration)
        else:
            self.player.step(-1 if which == back else 1)

    def _jump(self, accidents: list[float]) -> None:
        """Pause a second before the next accident, or before the first one after the last."""
        later = [t for t in accidents if t - 1.0 > self.player.t + 1e-6]
        self.player.pause()
        self.player.seek((later or accidents)[0] - 1.0)

    def _switches(self, gui) -> None:
        options = self.stage.options
        if len(self.timelines) > 1:
            names = tuple(f"{k + 1} {display_name(line.rollout.label)}" for k, line in enumerate(self.timelines))
            follow = gui.add_dropdown("Follow", names, initial_value=names[options.follow])
            layout = gui.add_dropdown("Roads", scene.LAYOUTS, initial_value=options.layout)
            follow.on_update(lambda event: self._set("follow", names.index(event.target.value), rebuild=True))
            layout.on_update(lambda event: self._set("layout", event.target.value, rebuild=True))
        switches = {"labels": "Distances to the traps", "path": "Path driven", "rule": "What the rule wants"}
        if any(line.imagined is not None for line in self.timelines):
            switches["futures"] = "Nine futures"
        boxes = {field: gui.add_checkbox(label, getattr(options, field)) for field, label in switches.items()}
        for field, box in boxes.items():
            box.on_update(lambda event, field=field: self._set(field, bool(event.target.value)))
        if nine := boxes.get("futures"):
            nine.hint = f"Key F. {LEGEND.capitalize()}; broad: the action that is driven"
            command = gui.add_command("Show or hide the nine futures", hotkey="F")
            command.on_trigger(lambda _: setattr(nine, "value", not nine.value))
        dark = gui.add_checkbox("Dark", options.dark)
        dark.on_update(lambda event: self._set("dark", bool(event.target.value), rebuild=True))

    def _set(self, name: str, value, rebuild: bool = False) -> None:
        def change() -> None:
            setattr(self.stage.options, name, value)
            self._shown = None

        if getattr(self.stage.options, name) == value:
            return
        self.restage(change, rebuild)

    def refresh(self, t: float) -> None:
        """Show time t: the cursor in every frame, the numbers when a tenth of a second of the replay has passed."""
        with self.server.atomic():
            self.cursor.content = str(hud.cursor(t / self.player.duration))  # viser sends no subclass of str
            self.play.label = PAUSE if self.player.playing else PLAY
            if round(t, 1) == self._shown:
                return
            self._shown = round(t, 1)
            if not self.player.held:
                self.time.value = min(self._shown, self.player.duration)
            follow = self.stage.options.follow
            self.card.content = str(hud.card(self.timelines[follow], t))
            if self.table is not None:
                self.table.content = str(hud.table(self.timelines, t))
