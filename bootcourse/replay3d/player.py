"""The clock of a replay: play, pause, seek, step, speed, loop. A thread calls `advance` for every frame."""

import threading
import time
from collections.abc import Callable

SPEEDS = {"¼×": 0.25, "½×": 0.5, "1×": 1.0, "2×": 2.0, "4×": 4.0, "8×": 8.0}
FRAME_RATE = 30.0  # Hz
HOLD = 0.35  # s for which a drag of the time slider stops the clock


class Player:
    """A time t in [0, duration], in seconds, that runs while `playing`. Any thread may call any method.

    on_frame(t) is called in the player's own thread for every frame and after every change; while it is slow,
    frames are left out and the time stays right. watched: is anybody looking? If not, the time stands still.
    """

    def __init__(self, duration: float, step: float, on_frame: Callable[[float], None], watched=lambda: True):
        self.duration, self.step_length = duration, step
        self.t, self.speed, self.playing, self.loop = 0.0, 1.0, False, False
        self._on_frame, self._watched = on_frame, watched
        self._lock, self._wake, self._stop = threading.RLock(), threading.Event(), threading.Event()
        self._held_until = 0.0
        self._thread: threading.Thread | None = None

    def play(self) -> None:
        with self._lock:
            if self.t >= self.duration:
                self.t = 0.0
            self.playing = True
        self._wake.set()

    def pause(self) -> None:
        with self._lock:
            self.playing = False
        self._wake.set()

    def toggle(self) -> None:
        if self.playing:
            self.pause()
        else:
            self.play()

    def seek(self, t: float, hold: bool = False) -> None:
        """Go to a time; `hold` keeps the clock there for a moment, since a drag sends many times in a row."""
        with self._lock:
            self.t = min(max(float(t), 0.0), self.duration)
            if hold:
                self._held_until = time.monotonic() + HOLD
        self._wake.set()

    @property
    def held(self) -> bool:
        """Is the time slider being dragged?"""
        return time.monotonic() < self._held_until

    def step(self, count: int) -> None:
        """Pause, and go to the next (1) or the previous (-1) simulation step."""
        with self._lock:
            self.playing = False
            now = self.t / self.step_length
            nearest = round(now)
            target = nearest + count if abs(now - nearest) < 1e-6 else int(now) + (1 if count > 0 else 0)
            self.t = min(max(target * self.step_length, 0.0), self.duration)
        self._wake.set()

    def advance(self, seconds: float) -> bool:
        """Let `seconds` of real time pass. Returns whether the replay's time has moved."""
        with self._lock:
            if not self.playing or self.held:
                return False
            self.t += seconds * self.speed
            if self.t >= self.duration:
                self.t = self.t % self.duration if self.loop else self.duration
                self.playing = self.loop
            return True

    def start(self) -> None:
        self._thread = threading.Thread(target=self._run, name="bootcourse replay", daemon=True)
        self._thread.start()

    def stop(self) -> None:
        self._stop.set()
        self._wake.set()
        if self._thread is not None and self._thread is not threading.current_thread():
            self._thread.join(timeout=2.0)

    def _run(self) -> None:
        before = time.perf_counter()
        due = before
        while not self._stop.is_set():
            now = time.perf_counter()
            moved = self._watched() and self.advance(now - before)
            before = now
            if moved or self._wake.is_set():
                self._wake.clear()
                self._on_frame(self.t)
            if self.playing and self._watched():
                due = max(due + 1 / FRAME_RATE, time.perf_counter())
                self._stop.wait(due - time.perf_counter())
            else:  # paused, or no viewer is connected: wait until something wakes the player, 0.2 s at most
                self._wake.wait(0.2)
                before = due = time.perf_counter()
