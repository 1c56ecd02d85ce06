"""The panel beside the scene: the time slider, the buttons, the switches, and the head-up display."""

from bootcourse.methods import display_name
from bootcourse.plots.futures import LEGEND
from bootcourse.replay3d import hud
from bootcourse.replay3d.camera import CAMERAS, point
from bootcourse.replay3d.player import SPEEDS

PANEL_WIDTH = 330  # px
PLAY, PAUSE = "Play", "Pause"
STEPS = ("◂", "▸")  # one simulation step back, one forward


class ReplayControls:
    """Controls of a `viewer.Replay`; `refresh(t)` shows a time. viser calls them in threads of its own."""

    def __init__(self, replay):
        self.server, self.player, self.stage, self.timelines = (
            replay.server,
            replay.player,
            replay.stage,
            replay.timelines,
        )
        self.replay, self.followed = replay, 0  # index of the drive whose numbers are shown
        self._shown = None
        gui = replay.server.gui
        gui.main_panel.dock_right()
        gui.main_panel.set_width(PANEL_WIDTH)
        gui.add_html(hud.STYLE)
        self._playback(gui)
        cameras = gui.add_button_group("Camera", CAMERAS, hint="Where you look from; drag the road to look elsewhere")
        cameras.on_click(lambda event: event.client and point(event.client.camera, event.target.value, self.stage.span))
        self.table = gui.add_html("") if len(self.timelines) > 1 else None
        self.card = gui.add_html("")
        gui.add_html(str(hud.plots(self.timelines)))
        self.cursor = gui.add_html(str(hud.cursor(0.0)))
        with gui.add_folder("More"):
            self._switches(gui)
            details = gui.add_checkbox("Details", replay.details, hint="What the driver thinks, and its reward's terms")
            details.on_update(lambda event: self._detail(bool(event.target.value)))

    def _playback(self, gui) -> None:
        player = self.player
        ends = {line.duration for line in self.timelines if line.rollout.accident}
        marks = tuple((t, "⚠") for t in sorted(ends)) or None
        self.time = gui.add_slider("Time, s", 0.0, player.duration, 0.1, 0.0, marks=marks)
        self.play = gui.add_button(PLAY, hint="Key P")
        steps = gui.add_button_group("Step", STEPS, hint=f"{self.timelines[0].dt:g} s back (key J), or on (key K)")
        self.time.on_update(lambda event: player.seek(event.target.value, hold=True) if event.client else None)
        self.play.on_click(lambda _: player.toggle())
        steps.on_click(lambda event: player.step(-1 if event.target.value == STEPS[0] else 1))
        gui.add_command("Play or pause", hotkey="P").on_trigger(lambda _: player.toggle())
        gui.add_command("Step back", hotkey="J").on_trigger(lambda _: player.step(-1))
        gui.add_command("Step forward", hotkey="K").on_trigger(lambda _: player.step(1))

    def _switches(self, gui) -> None:
        speed = gui.add_dropdown("Speed", tuple(SPEEDS), initial_value="1×")
        speed.on_update(lambda event: setattr(self.player, "speed", SPEEDS[event.target.value]))
        loop = gui.add_checkbox("Loop", self.player.loop)
        loop.on_update(lambda event: setattr(self.player, "loop", bool(event.target.value)))
        if len(self.timelines) > 1:
            names = tuple(f"{k + 1} {display_name(line.rollout.label)}" for k, line in enumerate(self.timelines))
            follow = gui.add_dropdown("Numbers of", names)
            follow.on_update(lambda event: self._follow(names.index(event.target.value)))
        if any(line.imagined is not None for line in self.timelines):
            hint = f"Key F. {LEGEND.capitalize()}; broad: the action that is driven"
            nine = gui.add_checkbox("Nine futures", self.stage.futures, hint=hint)
            nine.on_update(lambda event: self.replay.restage(futures=bool(event.target.value)))
            command = gui.add_command("Show or hide the nine futures", hotkey="F")
            command.on_trigger(lambda _: setattr(nine, "value", not nine.value))
        dark = gui.add_checkbox("Dark", self.stage.dark)
        dark.on_update(lambda event: self.replay.restage(dark=bool(event.target.value)))

    def _follow(self, index: int) -> None:
        self.followed, self._shown = index, None
        self.replay.restage()

    def _detail(self, details: bool) -> None:
        self.replay.details, self._shown = details, None
        self.replay.restage()

    def refresh(self, t: float) -> None:
        """Show time t: the cursor in every frame, the numbers when a tenth of a second of the replay has passed."""
        with self.replay.server.atomic():
            self.cursor.content = str(hud.cursor(t / self.player.duration))  # viser sends no subclass of str
            self.play.label = PAUSE if self.player.playing else PLAY
            if round(t, 1) == self._shown:
                return
            self._shown = round(t, 1)
            if not self.player.held:
                self.time.value = min(self._shown, self.player.duration)
            self.card.content = str(hud.card(self.timelines[self.followed], t, self.replay.details))
            if self.table is not None:
                self.table.content = str(hud.table(self.timelines, t))
