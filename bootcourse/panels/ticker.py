"""A clock for a panel: it calls a function several times a second in a daemon thread, until it is stopped."""

import threading
import time
from collections.abc import Callable


class Ticker:
    """A clock that can be started and stopped any number of times, by one thread.

    tick: given the seconds since the last tick, returns whether to go on. rate: ticks a second.
    """

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
        """Stop, and wait for a tick that is being done (2 s at most; a tick that stops its own clock does not wait)."""
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
