"""Waiting for what a thread, a process or a page does."""

import time


def until(condition, seconds: float = 20.0) -> bool:
    """Whether the condition comes true in time; a busy machine takes longer."""
    ends = time.monotonic() + seconds
    while not (true := condition()) and time.monotonic() < ends:
        time.sleep(0.02)
    return bool(true)
