"""A live replay: rollouts on a server on this machine, shown in a notebook's cell or in a browser."""

import contextlib
import os
import threading
import time
from collections.abc import Sequence
from pathlib import Path

from bootcourse import one_per_cell
from bootcourse.episodes.rollout import Rollout
from bootcourse.markup import Markup, html
from bootcourse.policies import Policy
from bootcourse.replay3d import scene, server
from bootcourse.replay3d.gui import ReplayControls
from bootcourse.replay3d.player import Player
from bootcourse.replay3d.stage import Stage

HUD_RATE = 10.0  # Hz, of real time, at most: how often the numbers in the panel change


class Replay(contextlib.AbstractContextManager):
    """A replay of rollouts on a server. A notebook shows it as the cell's output; `close()` ends it. See `replay`."""

    def __init__(
        self, rollouts, height: int = 640, dark: bool = False, futures: Policy | None = None, details: bool = False
    ):
        self.timelines, self.futures = scene.timelines_of(rollouts, futures), futures
        self.details = details
        self.height, self.closed = height, False
        self._lock = threading.RLock()  # held while a frame is shown or the scene changes, in whichever thread
        self._hud_due, self._greeted = 0.0, False
        self.server = server.LocalServer()
        try:
            self.stage = Stage(self.server, self.timelines, dark)
            duration = max(timeline.duration for timeline in self.timelines)
            self.player = Player(duration, self.timelines[0].dt, self._frame, watched=self._watched)
            self.panel = ReplayControls(self)
            self._frame(0.0)
            self.server.on_client_connect(self._greet)
            self.player.start()
        except BaseException:
            self.server.stop()
            raise

    @property
    def port(self) -> int:
        return self.server.get_port()

    @property
    def url(self) -> str:
        return f"http://{server.HOST}:{self.port}"

    def close(self) -> None:
        """Stop playing, stop the server and free its port. Closing twice does nothing."""
        if self.closed:
            return
        self.closed = True
        one_per_cell.forget(self)
        self.player.stop()
        self.server.stop()

    def __exit__(self, *_) -> None:
        self.close()

    def export(self, path: Path) -> Path:
        """Write the same drives as one HTML file that a browser opens without a server. Returns the path."""
        from bootcourse.replay3d.recorder import export

        return export([line.rollout for line in self.timelines], path, self.stage.dark, self.futures, self.details)

    def _watched(self) -> bool:
        return bool(self.server.get_clients())

    def _greet(self, client) -> None:
        if not self._greeted:  # it starts when the first browser connects
            self._greeted = True
            self.player.play()

    def _frame(self, t: float) -> None:
        with self._lock, self.server.atomic():
            self.stage.show(t)
            now = time.monotonic()
            if now >= self._hud_due or not self.player.playing:
                self._hud_due = now + 1 / HUD_RATE
                self.panel.refresh(t)

    def restage(self, dark: bool | None = None, futures: bool | None = None) -> None:
        """Switch to the dark or the light theme, show or hide the imagined drives, and draw the present again."""
        with self._lock:
            if futures is not None:
                self.stage.futures = futures
            if dark not in (None, self.stage.dark):
                self.stage.dark = dark
                self.stage.build()
            self._frame(self.player.t)

    def _repr_mimebundle_(self, include=None, exclude=None) -> dict:
        return {"text/html": str(self._html()), "text/plain": f"<replay at {self.url}>"}

    def _html(self) -> Markup:
        address, advice = address_for_browser(self.port)
        if address is None:
            return html("<p>{}</p>", advice)
        frame = html('<iframe src="{}" width="100%" height="{}" style="border:0"></iframe>', address, self.height)
        return frame + html('<div style="font-size:smaller;opacity:.7">{}</div>', advice)


def address_for_browser(port: int) -> tuple[str | None, str]:
    """(the address at which the reader's browser finds the server, or None; a sentence to show with it)."""
    prefix = os.environ.get("JUPYTERHUB_SERVICE_PREFIX")
    if prefix is None:
        url = f"http://{server.HOST}:{port}"
        return url, f"Live at {url} while the kernel runs. To keep it, or if it stays empty: .export('replay.html')."
    import importlib.util

    if importlib.util.find_spec("jupyter_server_proxy") is None:
        return None, (
            "This notebook runs behind JupyterHub, where your browser cannot reach the replay's server: install "
            "jupyter-server-proxy and restart your server, or show recording(...) instead of replay(...)."
        )
    return f"{prefix.rstrip('/')}/proxy/{port}/", "Live through this hub's proxy while the kernel runs."


def replay(
    rollouts: Rollout | Sequence[Rollout], *, height: int = 640, dark: bool = False,
    futures: Policy | None = None, details: bool = False,
) -> Replay:  # fmt: skip
    """Show a rollout, or several of the same seed side by side, in 3D.

    height: of the cell's output, pixels. futures: a base policy: at each decision, draw the
    nine imagined drives that it would go on with, those that crash in red, that of the driven action bold.
    details: show also what the driver thinks, π, π̃, Q and the KL, and the terms of its reward.
    Running the same notebook cell again replaces its replay.
    Raises BootcourseError if the drives cannot be shown together.
    """
    scene.timelines_of(rollouts)  # a refused replay leaves the one before alone
    cell = one_per_cell.this_cell()
    one_per_cell.close_shown_by(cell)
    shown = Replay(rollouts, height, dark, futures, details)
    one_per_cell.note(cell, shown)
    return shown
