"""Work that may be stopped at any moment and goes on when the same command is started again.

It is done in a locked folder, with checkpoints; what is finished is moved to its place when it is complete. The
operating system holds the lock until the process ends, also when that is killed. (On a network disk without locks,
take care yourself to start only one process.) The lock of a piece of that work is a file whose owner shows again and
again that it is alive, because workers may outlive the process that started them, and may be on other machines.
"""

import time
import uuid
from collections.abc import Callable, Iterator
from contextlib import contextmanager, suppress
from pathlib import Path
from typing import TYPE_CHECKING

from filelock import FileLock, SoftFileLease, Timeout

from bootcourse.errors import BootcourseError
from bootcourse.files import remove_temporary

if TYPE_CHECKING:
    from bootcourse.learn.training import Training

LOCK = ".lock"
LEASE = 60.0  # s without a sign of life, after which an owner on another machine counts as dead
PATIENCE = 3  # looks, a second apart, at an owner's file that stays empty, after which it is taken away


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


@contextmanager
def owned(folder: Path, stop: Callable[[], bool] = lambda: False) -> Iterator[Callable[[], bool]]:
    """Be the one process, on all machines, that works on a folder: waits while another does, takes over when it died.

    The folder itself need not be there. Gives a function that says whether this process has lost it: another took over,
    because for `LEASE` this one showed no sign of life. Raises InterruptedError once stop() is true while it waits.
    """
    folder.parent.mkdir(parents=True, exist_ok=True)
    path, seen, looks = folder.with_name(f".{folder.name}.owner"), None, 0
    lease = SoftFileLease(path, lease_duration=LEASE)
    while not lease.is_locked:
        if stop():
            raise InterruptedError(f"{folder}: stopped while another process had it.")
        try:
            lease.acquire(timeout=1)
        except Timeout:
            before, seen = seen, _unwritten(path)
            looks = looks + 1 if seen and seen == before else 0
            if looks >= PATIENCE:
                _take_away(path)
    try:
        yield lambda: lease.compromise is not None
    finally:
        lease.release()


def _unwritten(owner: Path) -> tuple[int, int] | None:
    """Which file an owner's is if it is empty: its number and time of change.

    An owner makes its file and then writes its name. If it is killed between, filelock lets the file stand for ever.
    """
    with suppress(OSError):
        status = owner.stat()
        return None if status.st_size else (status.st_ino, status.st_ctime_ns)
    return None


def _take_away(owner: Path) -> None:
    """Remove an owner's empty file; if another owner has written one in this moment, put it back."""
    aside = owner.with_name(f"{owner.name}.{uuid.uuid4().hex}")
    with suppress(OSError):
        owner.rename(aside)
        if aside.stat().st_size:
            aside.rename(owner)
        else:
            aside.unlink()


def remove_empty(folder: Path) -> None:
    """Remove the empty folders in a folder, and itself if nothing is left."""
    for path in sorted([folder, *folder.rglob("*")], reverse=True):
        with suppress(OSError):  # a file, or a folder that is not empty
            path.rmdir()


class Checkpoints:
    """A training's callback: writes a checkpoint to `path` every so many seconds."""

    def __init__(self, path: Path, seconds: float):
        self.path, self.seconds, self.last = path, seconds, time.monotonic()

    def __call__(self, training: "Training") -> None:
        from bootcourse.storage.checkpoint import save_checkpoint  # loads torch, which who only owns a folder can spare

        if time.monotonic() - self.last > self.seconds:
            save_checkpoint(training, self.path)
            self.last = time.monotonic()
