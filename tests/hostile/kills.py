"""Stop a command at each of its file operations, start it again, and compare what it leaves with an undisturbed run.

    python -m tests.hostile.kills                           # every operation of every command, twice
    python -m tests.hostile.kills --every 10 train study    # one operation in ten of two commands

Each operation (a file is opened for writing, synced, renamed or removed, a folder made or removed) is the last one
twice: once the process is killed just before it, once the disk is full from there on. The command runs in a fork of
this process, which is warm, so that an attempt takes a fraction of a second.
"""

import argparse
import errno
import functools
import hashlib
import itertools
import json
import mmap
import os
import shutil
import sys
import tempfile
import traceback
from collections.abc import Callable, Iterator
from dataclasses import dataclass
from pathlib import Path
from types import SimpleNamespace

KILLED = 137  # exit status
WRITING = os.O_WRONLY | os.O_RDWR | os.O_CREAT
GROWING = {"open", "os.mkdir", "fsync"}  # what a full disk refuses
CHANGING = GROWING | {"os.rename", "os.remove", "os.rmdir", "os.chmod"}
HOW = ("killed", "full")


@dataclass(frozen=True)
class Command:
    """A command that is disturbed. `{}` is the folder of an attempt."""

    name: str
    arguments: list[str]
    again: list[list[str]]  # what a user starts afterwards: the next one if it is refused with status 2
    prepare: Callable[[Path], None] = lambda folder: None


TRAIN = ["train", "--method", "soft", "--seeds", "2", "--episodes", "1", "--out", "{}/runs", "--quiet"]
STUDY = ["study", "--out", "{}/study", "--only", "sac,soft", "--seeds", "1", "--episodes", "1", "--tests", "2"]
SWEEP = ["sweep", "--out", "{}/sweep", "--seeds", "1", "--episodes", "1", "--tests", "2"]
BUILD = ["assets", "build", "--study", "{}/study"]


def commands(study: Path) -> list[Command]:
    """All of them. study: a finished one, for `assets build`."""

    def ready_to_ship(folder: Path) -> None:
        shutil.copytree(study, folder / "study")
        shutil.copytree(_built(study), folder / "assets")

    return [
        Command("train", TRAIN, [[*TRAIN, "--resume"], TRAIN]),
        Command("study", [*STUDY, "--workers", "1"], [[*STUDY, "--workers", "1"]]),
        Command("sweep", [*SWEEP, "--workers", "1"], [[*SWEEP, "--workers", "1"]]),
        Command("assets build", BUILD, [BUILD], ready_to_ship),
    ]


@functools.cache
def _built(study: Path) -> Path:
    from bootcourse.study import fingerprint, ship

    fingerprint.fingerprint = functools.cache(fingerprint.fingerprint)  # computed once, not by every attempt
    ship.build(study, study.parent / "assets")
    return study.parent / "assets"


def run(arguments: list[str], folder: Path, at: int = -1, how: str = "") -> tuple[int, list[str], str]:
    """Run a command in a fork: (exit status, the operations that it began, what it printed).

    at, how: the operation at which it is killed, or from which on the disk is full; -1: none.
    """
    told = mmap.mmap(-1, 1 << 20)
    with tempfile.TemporaryFile() as printed:
        child = os.fork()
        if child == 0:
            os.dup2(printed.fileno(), 1)
            os.dup2(printed.fileno(), 2)
            os._exit(_in_the_child([each.format(folder) for each in arguments], folder, at, how, told))
        _, status = os.waitpid(child, 0)
        printed.seek(0)
        operations = told[:].split(b"\0", 1)[0].decode().splitlines()
        return os.waitstatus_to_exitcode(status), operations, printed.read().decode(errors="replace")


def _in_the_child(arguments: list[str], folder: Path, at: int, how: str, told: mmap.mmap) -> int:
    from bootcourse.cli import main
    from bootcourse.storage import assets
    from bootcourse.study import jobs

    jobs.PARENT, assets.FOLDER = os.getppid(), folder / "assets"
    count = itertools.count()

    def operation(event: str, path) -> None:
        told.write(f"{event} {os.path.basename(os.fspath(path))}\n".encode())
        number = next(count)
        if how == "killed" and number == at:
            os._exit(KILLED)
        if how == "full" and number >= at and event in GROWING:
            raise OSError(errno.ENOSPC, os.strerror(errno.ENOSPC), str(path))

    def hook(event: str, args) -> None:
        if event not in CHANGING or (event == "open" and not args[2] & WRITING):
            return
        path = args[0]
        if isinstance(path, (str, bytes, os.PathLike)) and _inside(os.fsdecode(path), folder):
            operation(event, os.fsdecode(path))

    synced = os.fsync
    os.fsync = lambda file: (operation("fsync", ""), synced(file))[1]
    sys.addaudithook(hook)
    sys.argv = ["bootcourse", *arguments]
    try:
        main()
    except SystemExit as ended:
        sys.stdout.flush()
        return ended.code or 0
    except BaseException:
        traceback.print_exc()
        sys.stderr.flush()
        return 70
    return 0


def _inside(path: str, folder: Path) -> bool:
    return not os.path.isabs(path) or path.startswith(str(folder))  # rmtree names files relative to their folder


def left(folder: Path) -> dict[str, str]:
    """{file: hash of what does not depend on the time} for every file below a folder."""
    files = [path for path in sorted(folder.rglob("*")) if path.is_file()]
    return {path.relative_to(folder).as_posix(): hashlib.sha256(_timeless(path)).hexdigest() for path in files}


def _timeless(path: Path) -> bytes:
    if path.suffix != ".json":
        return path.read_bytes()

    def without(value):
        if isinstance(value, dict):
            kept = {k: v for k, v in value.items() if k not in ("seconds", "seal") and "provenance.json" not in k}
            return {key: without(its) for key, its in kept.items()}
        return value

    return json.dumps(without(json.loads(path.read_bytes())), sort_keys=True).encode()


def attempt(command: Command, at: int, how: str, expected: dict[str, str], scratch: Path) -> list[str]:
    """Disturb a command once and start it again: what went wrong, a sentence each."""
    folder = Path(tempfile.mkdtemp(dir=scratch))
    command.prepare(folder)
    status, operations, printed = run(command.arguments, folder, at, how)
    where = f"{command.name}, {how} at {at} ({operations[at] if at < len(operations) else 'the end'})"
    wrong = []
    if "Traceback" in printed:
        wrong.append(f"{where}: a traceback: {printed.strip().splitlines()[-1]}")
    if how == "full" and status == 0 and left(folder) != expected:
        wrong.append(f"{where}: it says that all is well")
    for arguments in command.again:
        status, _, printed = run(arguments, folder)
        if status != 2:
            break
    if status != 0 or "Traceback" in printed:
        wrong.append(f"{where}: a dead end, status {status}: {(printed.strip().splitlines() or [''])[-1]}")
    else:
        there = left(folder)
        names = sorted(name for name in {*there, *expected} if there.get(name) != expected.get(name))
        if names:
            wrong.append(f"{where}: other files than undisturbed: {', '.join(names[:5])}")
    shutil.rmtree(folder)
    return wrong


def disturb(command: Command, every: int, scratch: Path) -> Iterator[list[str]]:
    """What went wrong in each attempt, at one operation in `every`."""
    folder = scratch / "undisturbed"
    folder.mkdir()
    command.prepare(folder)
    status, operations, printed = run(command.arguments, folder)
    assert status == 0, printed
    expected = left(folder)
    shutil.rmtree(folder)
    print(f"{command.name}: {len(operations)} operations, {len(expected)} files", flush=True)
    for at, how in itertools.product(range(0, len(operations), every), HOW):
        yield attempt(command, at, how, expected, scratch)


def warm(scratch: Path) -> Path:
    """Import and compile everything, and compute a small study. Returns its folder."""
    import torch
    import tqdm

    from bootcourse.learn.settings import settings_for, with_seeds
    from bootcourse.scenario import DEFAULT
    from bootcourse.storage import work
    from bootcourse.study.jobs import Job, run_job

    torch.set_num_threads(1)
    tqdm.tqdm.monitor_interval = 0  # its thread would not survive a fork
    seconds = itertools.count().__next__  # a clock of its own, so that every attempt writes the same checkpoints
    work.time = SimpleNamespace(monotonic=seconds, strftime=lambda _: "today")
    made = scratch / "made" / "study"
    made.mkdir(parents=True)
    (made / "study.json").write_text("{}")
    for method in ("sac", "soft"):
        agents = with_seeds(settings_for(method, learning_starts=16, hidden=(8,), buffer_size=2000), 1)
        assert run_job(Job(f"default/{method}", tuple(agents), DEFAULT, 1, 2), made) == ""
    return made


def main() -> int:
    parser = argparse.ArgumentParser(description=__doc__.split("\n")[0])
    parser.add_argument("names", nargs="*", help="train, study, sweep, 'assets build'; by default all")
    parser.add_argument("--every", type=int, default=1, help="one operation in so many")
    chosen = parser.parse_args()
    os.environ["OMP_NUM_THREADS"] = "1"
    with tempfile.TemporaryDirectory() as place:
        scratch, wrong, attempts = Path(place), [], 0
        study = warm(scratch)
        for command in commands(study):
            if chosen.names and command.name not in chosen.names:
                continue
            for found in disturb(command, chosen.every, scratch):
                attempts += 1
                wrong += found
                print(*found, sep="\n", end="\n" * bool(found), flush=True)
    print(f"{attempts} attempts, {len(wrong)} went wrong")
    return 1 if wrong else 0


if __name__ == "__main__":
    sys.exit(main())
