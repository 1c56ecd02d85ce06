"""Several processes at once: how many make sense here, and whether this system lets them work together."""

import multiprocessing

import joblib

from bootcourse.errors import BootcourseError


def usable_processors() -> int:
    """The processors that this process may use: on a shared node or in a container, fewer than the machine has."""
    return joblib.cpu_count()


def check_semaphores() -> None:
    """Raise BootcourseError where processes cannot share a semaphore: Linux keeps them in /dev/shm."""
    try:
        multiprocessing.get_context("spawn").Semaphore()
    except (ImportError, OSError) as error:
        raise BootcourseError(
            f"Processes cannot work together here ({error}): on Linux they need a folder /dev/shm that can be written. "
            "Make it so, in a container with `--shm-size=1g` or `--tmpfs /dev/shm`."
        ) from None
