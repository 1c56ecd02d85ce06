"""A training in a daemon thread: one at a time in a process, which can be stopped and looked into while it runs.

It knows no widgets. What goes wrong in the thread becomes a sentence, and its traceback is kept.
"""

import contextlib
import math
import threading
import time
import traceback
from collections.abc import Callable

import torch

from bootcourse.errors import BootcourseError
from bootcourse.learn.training import Result, Training, one_torch_thread

LOOKS = 5.0  # Hz, at most
SHARE = 0.15  # of the thread's time, at most, for looking

_running: "Background | None" = None
_lock = threading.Lock()


class Background:
    """A training that `start` begins. At its end `result` is what was learned, `error` what went wrong, if anything.

    All four functions are called in the training's thread. make: makes the training (it may take seconds).
    look: is given the training while it runs, at most LOOKS times a second; after an error in it the training goes
    on without looks. ended: is given this object once, after the training. say: is given a sentence when one of
    the other three raises an error.
    """

    def __init__(
        self, make: Callable[[], Training], look: Callable[[Training], None] = lambda training: None,
        ended: Callable[["Background"], None] = lambda background: None,
        say: Callable[[str], None] = lambda sentence: None,
    ):  # fmt: skip
        self.make, self.look, self.ended, self.say = make, look, ended, say
        self.training: Training | None = None
        self.result: Result | None = None
        self.error: str = ""  # one sentence for each thing that went wrong
        self.traceback: str = ""  # of errors other than BootcourseError: these are bugs
        self._stop, self._wanted, self._peeked = threading.Event(), threading.Event(), threading.Event()
        self._begun, self._over = threading.Event(), threading.Event()
        self._seen: Result | None = None
        self._next_look = 0.0
        self.thread = threading.Thread(target=self._run, name="bootcourse training", daemon=True)

    @property
    def running(self) -> bool:
        """Is it training, or still reporting its end?"""
        return self.thread.is_alive() and not self._over.is_set()

    @property
    def stopping(self) -> bool:
        """Was it asked to stop?"""
        return self._stop.is_set()

    def start(self) -> None:
        """Begin. Raises BootcourseError while another training runs."""
        global _running
        with _lock:
            if _running is not None and _running.running:
                raise BootcourseError(
                    "A training is running already: stop it, or wait for its end, then start another."
                )
            _running = self
            # torch keeps its number of threads for each thread apart, and a new one takes over the number that was set
            # last. On 2 cores that others use as well, an update takes ten times as long with 2 threads as with 1.
            with one_torch_thread():
                self.thread.start()
                self._begun.wait()

    def stop(self) -> None:
        """Ask it to end after the present decision; what was learned is kept."""
        self._stop.set()

    def wait(self, seconds: float | None = None) -> bool:
        """Wait until it has ended, at most so long. Returns whether it has."""
        if self.thread.ident is not None and threading.current_thread() is not self.thread:
            self.thread.join(seconds)
        return not self.running

    def peek(self, seconds: float = 3.0) -> Result:
        """What was learned so far, taken between two decisions while it runs, or at its end.

        Raises BootcourseError if there is nothing yet.
        """
        self._peeked.clear()
        self._wanted.set()
        ends = time.monotonic() + seconds
        while self.running and self.result is None and time.monotonic() < ends and not self._peeked.wait(0.02):
            pass
        result = self.result or self._seen
        if result is None:
            raise BootcourseError("Nothing was learned yet: wait a moment.")
        return result

    def _run(self) -> None:
        torch.get_num_threads()  # takes it over
        self._begun.set()
        with self._telling("The training broke off"):
            self.training = self.make()
            self.result = self.training.run(progress=False, callback=self._after_decision, stop=self._stop.is_set)
        if self.result is None and self.training is not None:
            self.result = self.training.result(interrupted=True)
        with self._telling("The end of the training could not be shown"):
            self.ended(self)
        self._over.set()

    def _after_decision(self, training: Training) -> None:
        if self._wanted.is_set():
            self._wanted.clear()
            self._seen = training.result(interrupted=True)
            self._peeked.set()
        now = time.monotonic()
        if now >= self._next_look and not self.stopping:
            self._next_look = math.inf
            with self._telling("The training goes on, but its curves cannot be shown any more"):
                self.look(training)
                took = time.monotonic() - now
                self._next_look = now + max(1 / LOOKS, took / SHARE)

    @contextlib.contextmanager
    def _telling(self, what: str):
        """An error becomes a sentence in `error`, which `say` is given."""
        try:
            yield
        except Exception as error:
            sentence = str(error)
            if not isinstance(error, BootcourseError):
                sentence = f"{what}: {type(error).__name__}: {error}"
                self.traceback += traceback.format_exc()
            self.error = f"{self.error} {sentence}".strip()
            self.say(self.error)
