"""Work that may be stopped at any moment and goes on when the same command is started again.

It is done in a locked folder, with checkpoints; what is finished is moved to its place when it is complete. The
operating system holds the lock until the process ends, also when that is killed. (On a network disk without locks,
take care yourself to start only one process.)
"""

import time
from collections.abc import Iterator
from contextlib import contextmanager, suppress
from pathlib import Path

from filelock import FileLock, Timeout

from bootcourse.errors import BootcourseError
from bootcourse.files import remove_temporary
from bootcourse.learn.training import Training
from bootcourse.storage.checkpoint import save_checkpoint

LOCK = ".lock"


@contextmanager
def locked(folder: Path, what: str = "study") -> Iterator[None]:
    """Lock a folder, and remove the temporary files that a killed process left there.

    A folder that holds nothing but the lock is removed at the end. what: "study", "training" ..., for the sentence.
    Raises BootcourseError if another process has the lock, or the folder cannot be written.
    """
    folder = Path(folder)
    lock = FileLock(folder / LOCK)
    try:
        folder.mkdir(parents=True, exist_ok=True)
        lock.acquire(timeout=0)
    except Timeout:
        raise BootcourseError(
            f"Another {what} is at work in {folder}: wait for it, or choose another folder."
        ) from None
    except OSError as error:
        raise BootcourseError(f"Cannot write {folder}: {error.strerror}. Choose another folder.") from None
    try:
        remove_temporary(folder)
        yield
    finally:
        lock.release()
        with suppress(OSError):  # another process may begin in this moment
            if all(path.name == LOCK for path in folder.iterdir()):
                (folder / LOCK).unlink(missing_ok=True)
                folder.rmdir()


class Checkpoints:
    """A training's callback: writes a checkpoint to `path` every so many seconds."""

    def __init__(self, path: Path, seconds: float):
        self.path, self.seconds, self.last = path, seconds, time.monotonic()

    def __call__(self, training: Training) -> None:
        if time.monotonic() - self.last > self.seconds:
            save_checkpoint(training, self.path)
            self.last = time.monotonic()
