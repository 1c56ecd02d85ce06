"""Stop a command at each of its file operations, start it again, and compare what it leaves with an undisturbed run.

    python -m tests.hostile.kills                           # every operation of every command, twice
    python -m tests.hostile.kills --every 10 train study    # one operation in ten of two commands

Each operation (a file is opened for writing, synced, renamed or removed, a folder made or removed) is the last one
twice: once the process is killed just before it, once the disk is full from there on. A kill leaves the files as they
are in that moment, so that one run, whose folder is copied before each operation, shows what every kill leaves. A
command runs in a fork of this process, which has done the same before, and files that differ in their times alone
are tried once: an attempt takes a second. TMPDIR=/dev/shm keeps it off the disk.
"""

import argparse
import errno
import functools
import hashlib
import itertools
import json
import mmap
import os
import re
import shutil
import sys
import tempfile
import traceback
from collections.abc import Callable, Iterator
from dataclasses import dataclass
from pathlib import Path
from types import SimpleNamespace

WRITING = os.O_WRONLY | os.O_RDWR | os.O_CREAT
GROWING = {"open", "os.mkdir", "fsync"}  # what a full disk refuses
CHANGING = GROWING | {"os.rename", "os.remove", "os.rmdir", "os.chmod"}
Before = Callable[[int, str, str], None]  # called before each operation: its number, what it is, the path


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
    from bootcourse.research import ship

    def ready_to_ship(folder: Path) -> None:
        if not (study.parent / "assets").exists():
            ship.build(study, study.parent / "assets")
        shutil.copytree(study, folder / "study")
        shutil.copytree(study.parent / "assets", folder / "assets")

    return [
        Command("train", TRAIN, [[*TRAIN, "--resume"], TRAIN]),
        Command("study", [*STUDY, "--workers", "1"], [[*STUDY, "--workers", "1"]]),
        Command("sweep", [*SWEEP, "--workers", "1"], [[*SWEEP, "--workers", "1"]]),
        Command("assets build", BUILD, [BUILD], ready_to_ship),
    ]


def run(arguments: list[str], folder: Path, before: Before = lambda *_: None) -> tuple[int, list[str], str]:
    """Run a command in a fork: (exit status, the operations that it began, what it printed)."""
    told = mmap.mmap(-1, 1 << 20)
    with tempfile.TemporaryFile() as printed:
        child = os.fork()
        if child == 0:
            os.dup2(printed.fileno(), 1)
            os.dup2(printed.fileno(), 2)
            os._exit(_in_the_child(arguments, folder, before, told))
        _, status = os.waitpid(child, 0)
        printed.seek(0)
        operations = told[:].split(b"\0", 1)[0].decode().splitlines()
        return os.waitstatus_to_exitcode(status), operations, printed.read().decode(errors="replace")


def _in_the_child(arguments: list[str], folder: Path, before: Before, told: mmap.mmap) -> int:
    count, ours = itertools.count(), []

    def operation(event: str, path: str) -> None:
        told.write(f"{event} {os.path.basename(path)}\n".encode())
        ours.append(True)  # `before` may copy files
        before(next(count), event, path)
        ours.pop()

    def hook(event: str, args) -> None:
        if ours or event not in CHANGING or (event == "open" and not args[2] & WRITING):
            return
        path = args[0]
        if isinstance(path, (str, bytes, os.PathLike)) and _inside(os.fsdecode(path), folder):
            operation(event, os.fsdecode(path))

    synced = os.fsync
    os.fsync = lambda file: (operation("fsync", ""), synced(file))[1]
    sys.addaudithook(hook)
    status = run_here(arguments, folder)
    sys.stdout.flush()
    sys.stderr.flush()
    return status


def _inside(path: str, folder: Path) -> bool:
    return not os.path.isabs(path) or path.startswith(str(folder))  # rmtree names files relative to their folder


def run_here(arguments: list[str], folder: Path) -> int:
    """Run a command in this process: its exit status."""
    from bootcourse.cli import main
    from bootcourse.research import jobs
    from bootcourse.storage import assets

    jobs.PARENT, assets.FOLDER = os.getppid(), folder / "assets"
    sys.argv = ["bootcourse", *(each.format(folder) for each in arguments)]
    try:
        main()
    except SystemExit as ended:
        return ended.code or 0
    except BaseException:
        traceback.print_exc()
        return 70
    return 0


def left(folder: Path) -> dict[str, str]:
    """{file: hash of what does not depend on the time} for every file below a folder."""
    files = [path for path in sorted(folder.rglob("*")) if path.is_file()]
    return {path.relative_to(folder).as_posix(): hashlib.sha256(_timeless(path)).hexdigest() for path in files}


def _timeless(path: Path) -> bytes:
    data = path.read_bytes()

    def without(value):
        if isinstance(value, dict):
            kept = {k: v for k, v in value.items() if k not in ("seconds", "seal", "pid") and "provenance" not in k}
            return {key: without(its) for key, its in kept.items()}
        return value

    try:
        return json.dumps(without(json.loads(data)), sort_keys=True).encode()
    except ValueError:  # no JSON, or not all of it
        return data


def state(folder: Path) -> tuple:
    """All that a command which is started again finds; temporary names are drawn by chance."""
    modes = {path.relative_to(folder).as_posix(): path.stat().st_mode for path in folder.rglob("*")}
    hashes = left(folder)
    each = [(re.sub(r"\.\w{8}\.tmp\b", ".tmp", name), mode, hashes.get(name)) for name, mode in modes.items()]
    return tuple(sorted(each, key=str))


def start_again(command: Command, folder: Path, expected: dict[str, str]) -> str:
    """Start a disturbed command again: what went wrong, or ""."""
    for arguments in command.again:
        status, _, printed = run(arguments, folder)
        if status != 2:
            break
    if status != 0 or "Traceback" in printed:
        return f"a dead end, status {status}: {(printed.strip().splitlines() or [''])[-1]}"
    there = left(folder)
    names = sorted(name for name in {*there, *expected} if there.get(name) != expected.get(name))
    return f"other files than undisturbed: {', '.join(names[:5])}" if names else ""


def disturb(command: Command, every: int, scratch: Path) -> Iterator[str]:
    """What went wrong in each attempt, or "", at one operation in `every`."""
    folder, moments = scratch / "folder", scratch / "moments"

    def begin() -> None:
        shutil.rmtree(folder, ignore_errors=True)
        folder.mkdir()
        command.prepare(folder)

    def copy(number: int, event: str, path: str) -> None:
        if number % every == 0:
            shutil.copytree(folder, moments / str(number))

    def full_from(at: int) -> Before:
        def refuse(number: int, event: str, path: str) -> None:
            if number >= at and event in GROWING:
                raise OSError(errno.ENOSPC, os.strerror(errno.ENOSPC), path)

        return refuse

    begin()
    run_here(command.arguments, folder)  # what it imports, compiles and remembers, every fork has
    begin()
    status, operations, printed = run(command.arguments, folder, copy)
    assert status == 0, printed
    expected, known = left(folder), {}
    print(f"{command.name}: {len(operations)} operations, {len(expected)} files", flush=True)

    def and_again(where: str) -> str:
        found = state(folder)
        if found not in known:
            known[found] = start_again(command, folder, expected)
        return known[found] and f"{where}: {known[found]}"

    for at in range(0, len(operations), every):
        shutil.rmtree(folder)
        os.rename(moments / str(at), folder)
        yield and_again(f"{command.name}, killed at {at} ({operations[at]})")
    for at in range(0, len(operations), every):
        begin()
        where = f"{command.name}, full at {at} ({operations[at]})"
        status, _, printed = run(command.arguments, folder, full_from(at))
        if "Traceback" in printed:
            yield f"{where}: a traceback: {printed.strip().splitlines()[-1]}"
        elif status == 0 and left(folder) != expected:
            yield f"{where}: it says that all is well"
        else:
            yield and_again(where)
    shutil.rmtree(folder)
    print(f"{command.name}: started again from {len(known)} different states", flush=True)


def warm(scratch: Path) -> Path:
    """Make this process one whose forks repeat themselves, and compute a small study. Returns its folder."""
    import torch
    import tqdm

    from bootcourse.learn import training
    from bootcourse.learn.settings import settings_for, with_seeds
    from bootcourse.research import fingerprint
    from bootcourse.research.jobs import Job, run_job
    from bootcourse.scenario import DEFAULT
    from bootcourse.storage import work

    fingerprint.fingerprint = functools.cache(fingerprint.fingerprint)  # computed once, not by every attempt
    torch.set_num_threads(1)
    tqdm.tqdm.monitor_interval = 0  # its thread would not survive a fork
    seconds = itertools.count().__next__  # clocks of their own, so that every attempt writes the same checkpoints
    work.time = SimpleNamespace(monotonic=seconds, strftime=lambda _: "today")
    training.time = SimpleNamespace(perf_counter=lambda: 0.0)
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
        scratch, wrong, attempts = Path(place), 0, 0
        study = warm(scratch)
        for command in commands(study):
            if chosen.names and command.name not in chosen.names:
                continue
            for found in disturb(command, chosen.every, scratch):
                attempts += 1
                wrong += bool(found)
                print(found, end="\n" * bool(found), flush=True)
    print(f"{attempts} attempts, {wrong} went wrong")
    return 1 if wrong else 0


if __name__ == "__main__":
    sys.exit(main())
