"""A clock for a panel: calls a function several times a second in a daemon thread, until it is stopped."""

import threading
import time
from collections.abc import Callable


class Ticker:
    """`start` and `stop` as often as you like. tick(seconds since the last tick) -> go on?"""

    def __init__(self, tick: Callable[[float], bool], rate: float):
        self.tick, self.rate = tick, rate
        self._stop = threading.Event()
        self._thread: threading.Thread | None = None

    @property
    def running(self) -> bool:
        return self._thread is not None and self._thread.is_alive() and not self._stop.is_set()

    def start(self) -> None:
        if self.running:
            return
        self._stop = threading.Event()
        self._thread = threading.Thread(target=self._run, args=(self._stop,), name="bootcourse clock", daemon=True)
        self._thread.start()

    def stop(self) -> None:
        """End it, and wait until it has ended (not from within a tick)."""
        self._stop.set()
        thread = self._thread
        if thread is not None and thread is not threading.current_thread():
            thread.join(2.0)

    def _run(self, stop: threading.Event) -> None:
        last = time.monotonic()
        while not stop.wait(max(0.0, last + 1 / self.rate - time.monotonic())):
            now = time.monotonic()
            passed, last = now - last, now
            if not self.tick(passed):
                stop.set()
