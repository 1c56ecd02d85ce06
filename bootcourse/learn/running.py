"""How a training runs in its process: the device of its networks, one thread of torch, and interrupts."""

import signal
import threading
from contextlib import contextmanager

import torch

from bootcourse.errors import BootcourseError


def device_named(name: str) -> torch.device:
    """torch's device of that name. Raises BootcourseError if torch does not find it."""
    try:
        return torch.zeros(1, device=name).device
    except (RuntimeError, AssertionError, TypeError):  # an unknown name; a CUDA that this torch was built without
        raise BootcourseError(f'device = {name!r}: torch does not find it here. Give "cpu".') from None


@contextmanager
def one_torch_thread():
    """On the main thread, set torch to one thread (several are slower on small matrices), and restore it afterwards.

    A background thread that is started inside this context also computes on one core, because a new thread inherits
    the number that was set last. Called in a background thread, this changes no number of threads.

    Numbers below 1e-38 count as 0 meanwhile: as α fades, gradients and Adam's averages get that small, and arithmetic
    on such numbers made updates take up to twice as long.
    """
    before = torch.get_num_threads()
    on_main_thread = threading.current_thread() is threading.main_thread()
    if on_main_thread:
        torch.set_num_threads(1)
    torch.set_flush_denormal(True)
    try:
        yield
    finally:
        torch.set_flush_denormal(False)
        if on_main_thread:
            torch.set_num_threads(before)


@contextmanager
def interrupt_after_step():
    """Set an event at the first interrupt, so that the step ends and the training can resume; raise at the second."""
    interrupted = threading.Event()

    def interrupt(signum, frame):
        if interrupted.is_set():
            raise KeyboardInterrupt
        interrupted.set()

    if threading.current_thread() is not threading.main_thread():  # only the main thread receives interrupts
        yield interrupted
        return
    before = signal.signal(signal.SIGINT, interrupt)
    try:
        yield interrupted
    finally:
        signal.signal(signal.SIGINT, before if before is not None else signal.default_int_handler)
