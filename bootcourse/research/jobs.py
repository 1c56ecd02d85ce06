"""A job is a piece of a study that is computed in one go. A finished job is not computed again.

    DIR/unfinished/NAME   while it is computed: `checkpoint.npz`, from which a killed job continues
    DIR/jobs/NAME         when it is done: `results.npz`, `runs/`, and `job.json` with what was asked for, the versions
                          that computed it, and the hash of every file

The folder is moved in one step, so every folder in `jobs` is complete. A job has one owner at a time (see
`storage.work.owned`): a worker may go on after the process that started it was killed.
"""

import json
import os
import time
from collections.abc import Callable
from dataclasses import asdict, dataclass
from pathlib import Path
from typing import Annotated, Any, NamedTuple

from msgspec import Meta, Struct, convert

from bootcourse.errors import BootcourseError
from bootcourse.files import decoding, provenance, sha256
from bootcourse.storage.checkpoint import DamagedCheckpoint
from bootcourse.storage.sealed import amiss, read_sealed, write_sealed
from bootcourse.storage.work import owned

FORMAT = "bootcourse job 3"
CHECKPOINT = "checkpoint.npz"
HELD_OUT = 1  # the block of held-out roads that every method of every study is tested on
PARENT = os.getppid()  # read at import: a worker may be busy compiling when the process that started it dies


class Provenance(Struct):
    """The entry of a job's provenance that is a number; the others, the packages' versions, are for people."""

    seconds: Annotated[float, Meta(ge=0)]


class Description(Struct):
    """The entries of job.json that are read."""

    asked: dict[str, Any]  # compared with what is asked for, see `finished`
    sha256: dict[str, str]  # {file: its hash}
    provenance: Provenance


class Interrupted(Exception):
    """The study was stopped. A training with checkpoints has written one; other jobs begin again."""


class Workplace(NamedTuple):
    """Where a job is computed."""

    study: Path  # the study's folder
    job: Path  # the job's own, which becomes the finished job with all that is written there


Run = Callable[..., float | None]  # (workplace, **arguments) -> seconds of earlier attempts, if any. Raises Interrupted


@dataclass(frozen=True)
class Job:
    """A function and its arguments, which determine its result."""

    name: str  # its folder, such as "clocks/2-updates-no-demonstrations"
    run: Run  # writes `results.npz` or another file to its workplace
    arguments: dict[str, Any]  # what JSON can hold, and dataclasses of such


def asked(job: Job) -> dict:
    """The arguments of a job, as JSON reads them back."""
    return json.loads(json.dumps(job.arguments, default=asdict))


def asked_before(stored: dict) -> dict:
    """The arguments of a finished job. Jobs from before experiments were files hold some of them one level down."""
    inner = stored.get("arguments", stored.get("cell"))
    return inner if isinstance(inner, dict) else stored


def orphaned() -> bool:
    """Has the process that started this one ended?"""
    return os.getppid() != PARENT


def finished(job: Job, root: Path) -> bool:
    """Is it done? Raises BootcourseError if its folder is damaged, or holds another job."""
    folder = root / "jobs" / job.name
    if not folder.exists():
        return False
    before = asked_before(read_job(folder)["asked"])
    different = [name for name, value in asked(job).items() if before.get(name) != value]
    if different:
        raise BootcourseError(
            f"{folder} was computed with other {', '.join(different)}: choose another folder for this study."
        )
    return True


def read_job(folder: Path) -> dict:
    """The `job.json` of a finished job, after a check of all its files. Raises BootcourseError if one is damaged."""
    remedy = f"delete {folder}, and start the same command again"
    description = read_sealed(folder / "job.json", FORMAT, remedy)
    with decoding(folder / "job.json", remedy):
        convert(description, Description)
    for name, digest in description["sha256"].items():
        if sentence := amiss(folder / name, digest, remedy):
            raise BootcourseError(sentence)
    return description


def run_job(job: Job, root: Path) -> str:
    """Compute a job and move it to `jobs`. Returns "", or a sentence that says what went wrong."""
    try:
        if not (root / "study.json").exists():  # on a machine of a cluster that has another disk
            return f"{root} is not there for the process that should compute {job.name}: use a folder that all share."
        with owned(root / "unfinished" / job.name, orphaned) as is_lost:
            _run(job, root, is_lost)
    except (Interrupted, InterruptedError, KeyboardInterrupt):
        return f"{job.name}: interrupted"
    except (BootcourseError, OSError) as error:
        return f"{job.name}: {error}"
    return ""


def _run(job: Job, root: Path, is_lost: Callable[[], bool]) -> None:
    final, folder = root / "jobs" / job.name, root / "unfinished" / job.name
    if final.exists():  # the owner before has finished it: a cluster may start a job twice
        return
    folder.mkdir(parents=True, exist_ok=True)
    started = time.perf_counter()
    try:
        earlier = job.run(Workplace(root, folder), **job.arguments)
    except DamagedCheckpoint as error:
        raise BootcourseError(f"{error} To begin this job again, delete {folder}.") from None
    seconds = (earlier or 0.0) + time.perf_counter() - started
    (folder / CHECKPOINT).unlink(missing_ok=True)
    files = [path for path in sorted(folder.rglob("*")) if path.is_file() and path.name != "job.json"]
    description = {
        "format": FORMAT,
        "asked": asked(job),
        "sha256": {path.relative_to(folder).as_posix(): sha256(path) for path in files},
        "provenance": provenance(seconds=round(seconds, 1)),
    }
    write_sealed(folder / "job.json", description)
    if is_lost():  # the machine slept, say, and another process took over: what is here is that one's
        raise Interrupted(job.name)
    final.parent.mkdir(parents=True, exist_ok=True)
    os.rename(folder, final)
