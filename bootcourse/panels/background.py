"""A training in the background: a daemon thread, one at a time, that can be stopped and looked into.

It never fails in silence, and knows no widgets: the panel is one of its possible spectators.
"""

import threading
import time
import traceback
from collections.abc import Callable

from bootcourse.errors import BootcourseError
from bootcourse.learn.training import Result, Training

LOOKS = 5.0  # Hz, at most
SHARE = 0.15  # of the thread's time, at most, for looking

_running: "Background | None" = None
_lock = threading.Lock()


class Background:
    """A training that `start` begins. At its end `result` is what was learned, `error` what broke it, if anything.

    make: makes the training, in the thread (it may take seconds); look: called with the training while it runs, at
    most LOOKS times a second, in the thread; ended: called in the thread when all is over.
    """

    def __init__(
        self,
        make: Callable[[], Training],
        look: Callable[[Training], None] = lambda training: None,
        ended: Callable[["Background"], None] = lambda background: None,
    ):
        self.make, self.look, self.ended = make, look, ended
        self.training: Training | None = None
        self.result: Result | None = None
        self.error: str = ""  # a sentence
        self.traceback: str = ""  # of what was no BootcourseError: a bug
        self._stop, self._wanted, self._peeked = threading.Event(), threading.Event(), threading.Event()
        self._seen: Result | None = None
        self._next_look, self._over = 0.0, False
        self.thread = threading.Thread(target=self._run, name="bootcourse training", daemon=True)

    @property
    def running(self) -> bool:
        return self.thread.is_alive() and not self._over

    def start(self) -> None:
        """Begin. Raises BootcourseError while another training runs."""
        global _running
        with _lock:
            if _running is not None and _running.running:
                raise BootcourseError(
                    "A training is running already: stop it, or wait for its end, then start another."
                )
            _running = self
            self.thread.start()

    def stop(self) -> None:
        """Ask it to end after the decision that it is at; what was learned is kept."""
        self._stop.set()

    def wait(self, seconds: float | None = None) -> bool:
        """Wait for its end. Returns whether it came."""
        if self.thread.ident is not None and threading.current_thread() is not self.thread:
            self.thread.join(seconds)
        return not self.running

    def peek(self, seconds: float = 3.0) -> Result:
        """What was learned so far, taken between two decisions while it runs, or at its end.

        Raises BootcourseError if there is nothing yet.
        """
        if self.running and self.result is None:
            self._peeked.clear()
            self._wanted.set()
            ends = time.monotonic() + seconds
            while self.running and time.monotonic() < ends and not self._peeked.wait(0.02):
                pass
        result = self.result or self._seen
        if result is None:
            raise BootcourseError("Nothing was learned yet: wait a moment.")
        return result

    def _run(self) -> None:
        try:
            self.training = self.make()
            self.result = self.training.run(progress=False, callback=self._after_decision, stop=self._stop.is_set)
        except BootcourseError as error:
            self.error = str(error)
        except Exception as error:
            self.error = f"The training broke off: {type(error).__name__}: {error}"
            self.traceback = traceback.format_exc()
        if self.result is None and self.training is not None:
            self.result = self.training.result(interrupted=True)
        self._over = True
        self.ended(self)

    def _after_decision(self, training: Training) -> None:
        if self._wanted.is_set():
            self._wanted.clear()
            self._seen = training.result(interrupted=True)
            self._peeked.set()
        now = time.monotonic()
        if now >= self._next_look and not self._stop.is_set():
            self.look(training)
            took = time.monotonic() - now
            self._next_look = now + max(1 / LOOKS, took / SHARE)
