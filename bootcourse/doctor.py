"""`bootcourse doctor`: one screen that says what is right and wrong with this machine.

Each check yields findings, and each problem has its remedy beside it. Nothing here is imported from
outside the standard library until a check needs it, so that the doctor can speak when packages are
missing. `python bootcourse/doctor.py` runs it too.
"""

import importlib.metadata
import os
import platform
import re
import shutil
import socket
import sys
import tempfile
import time
from collections.abc import Iterator
from pathlib import Path
from typing import NamedTuple

ROOT = Path(__file__).resolve().parent.parent
LOCK = ROOT / "environment.lock"
OLDEST = (3, 11)
SET_UP = "Run `make lab` in the course's folder (on Windows, the install line of README.md)."
BROWSERS = ("chromium", "chromium-browser", "google-chrome", "chrome")
COLOURS = {"ok": "32", "note": "33", "STOP": "31"}


class Finding(NamedTuple):
    """`level` is "ok", "note" (the lessons run all the same) or "STOP" (they do not)."""

    level: str
    what: str
    remedy: str = ""


def python() -> Iterator[Finding]:
    here = f"Python {platform.python_version()} in {sys.prefix}"
    if sys.version_info < OLDEST:
        yield Finding("STOP", here, "Install Python 3.11 or newer, delete .venv, and run `make lab PYTHON=python3.11`.")
    else:
        yield Finding("ok", here)


def packages() -> Iterator[Finding]:
    """Every package that environment.lock has for this platform, against what is installed."""
    if not LOCK.exists():
        yield Finding("note", f"{LOCK} is not there: versions not compared", "Work in a clone of the course.")
        return
    locked = locked_versions(LOCK.read_text())
    installed = {name: installed_version(name) for name in locked}
    missing = [name for name in locked if installed[name] is None]
    different = [name for name in locked if installed[name] not in (None, locked[name])]
    lessons_need = needed("bootcourse") or set(missing)
    stopping = [name for name in missing if name in lessons_need]
    others = [name for name in missing if name not in lessons_need]
    if installed_version("bootcourse") is None:
        yield Finding("STOP", "bootcourse itself is not installed in this Python", SET_UP)
    if stopping:
        yield Finding("STOP", f"not installed: {listed(stopping)}", SET_UP)
    if others:
        yield Finding("note", f"not installed, and only the tests need it: {listed(others)}", SET_UP)
    for name in different:
        yield Finding("note", f"{name} is {installed[name]}, and the lessons were made with {locked[name]}", SET_UP)
    yield Finding("ok", f"{len(locked) - len(missing) - len(different)} of {len(locked)} packages match {LOCK.name}")


def listed(names: list[str]) -> str:
    return ", ".join(names[:8]) + (f" and {len(names) - 8} more" if len(names) > 8 else "")


def locked_versions(lock: str) -> dict[str, str]:
    """{name: version} of the lock's lines that hold on this machine (`; sys_platform == 'linux'`)."""
    Marker = packaging().markers.Marker
    lines = re.findall(r"^([\w.-]+)==([^\s;]+)(?: ; ([^\\\n]+?))?(?: \\)?$", lock, flags=re.MULTILINE)
    return {name: version for name, version, marker in lines if not marker or Marker(marker).evaluate()}


def needed(name: str, extras: tuple[str, ...] = ("",), found: set | None = None) -> set[str]:
    """The names of all that the installed package `name` asks for, and what those ask for in turn."""
    found = set() if found is None else found
    try:
        asked = importlib.metadata.requires(name) or []
    except importlib.metadata.PackageNotFoundError:
        return found
    for requirement in map(packaging().requirements.Requirement, asked):
        marker = requirement.marker
        child = re.sub(r"[-_.]+", "-", requirement.name).lower()
        if child not in found and (not marker or any(marker.evaluate({"extra": extra}) for extra in extras)):
            found.add(child)
            needed(child, ("", *requirement.extras), found)
    return found


def packaging():
    """The module that reads requirements: installed by the lock, and inside pip in any case."""
    try:
        import packaging.markers
        import packaging.requirements
    except ModuleNotFoundError:
        import pip._vendor.packaging.markers
        import pip._vendor.packaging.requirements

        return pip._vendor.packaging
    return packaging


def installed_version(name: str) -> str | None:
    try:
        return importlib.metadata.version(name)
    except importlib.metadata.PackageNotFoundError:
        return None


def torch_build() -> Iterator[Finding]:
    import torch

    threads = f"{torch.get_num_threads()} threads on {os.cpu_count()} cores"
    if torch.version.cuda:
        advice = "It works. To win back gigabytes of disk, delete .venv and run `make lab`."
        yield Finding("note", f"torch {torch.__version__} is a CUDA build, {threads}", advice)
    else:
        yield Finding("ok", f"torch {torch.__version__} is a CPU build, {threads}")


def compiler() -> Iterator[Finding]:
    import numba

    start = time.perf_counter()
    if numba.njit(lambda x: x + 1.0)(1.0) != 2.0:
        yield Finding("STOP", "numba compiles, but 1 + 1 is not 2", SET_UP)
    else:
        yield Finding("ok", f"numba compiles a small function in {time.perf_counter() - start:.1f} s")


def road() -> Iterator[Finding]:
    import gymnasium

    start = time.perf_counter()
    roads = gymnasium.make_vec("bootcourse:Trap-v0", num_envs=4)
    roads.reset(seed=0)
    roads.step(roads.action_space.sample())
    roads.close()
    seconds = time.perf_counter() - start
    yield Finding("ok", f"the compiled road drives after {seconds:.1f} s (the first time it compiles)")


def port() -> Iterator[Finding]:
    """JupyterLab and the 3D replays each listen on this machine only, on a free port."""
    try:
        with socket.create_server(("127.0.0.1", 0)) as server:
            with socket.create_connection(server.getsockname(), timeout=5):
                yield Finding("ok", "a page can be served on 127.0.0.1")
    except OSError as error:
        advice = "Allow local connections for Python in the firewall or security program."
        yield Finding("STOP", f"no page can be served on 127.0.0.1: {error}", advice)


def cache() -> Iterator[Finding]:
    from bootcourse.road.compiled import CACHE_FOLDER

    try:
        CACHE_FOLDER.mkdir(parents=True, exist_ok=True)
        with tempfile.TemporaryFile(dir=CACHE_FOLDER):
            yield Finding("ok", f"compiled code is kept in {CACHE_FOLDER}")
    except OSError as error:
        advice = "Make it writable, or every start of a notebook compiles the road again."
        yield Finding("note", f"{CACHE_FOLDER} cannot be written: {error.strerror}", advice)


def disk() -> Iterator[Finding]:
    free = shutil.disk_usage(Path.cwd()).free / 1e9
    level = "ok" if free > 1 else "note" if free > 0.1 else "STOP"
    remedy = "" if level == "ok" else "Free some space: trained runs and recordings need up to 1 GB."
    yield Finding(level, f"{free:.1f} GB free on the disk of {Path.cwd()}", remedy)


def browser() -> Iterator[Finding]:
    found = next(filter(None, map(shutil.which, BROWSERS)), None)
    if found:
        yield Finding("ok", f"browser tests use {found}")
    else:
        advice = "Only `make test` uses it, and skips those tests. Debian: apt install chromium."
        yield Finding("note", "no Chromium for the browser tests", advice)


CHECKS = (python, packages, torch_build, compiler, road, port, cache, disk, browser)


def findings() -> Iterator[Finding]:
    """Every check's findings. A check that falls over is a finding itself."""
    for check in CHECKS:
        try:
            yield from check()
        except ModuleNotFoundError as error:
            yield Finding("STOP", f"{check.__name__}: {error.name} is not installed", SET_UP)
        except Exception as error:
            yield Finding("STOP", f"{check.__name__}: {type(error).__name__}: {error}", SET_UP)


def main() -> int:
    """Print the screen. Returns 1 if something stops the lessons, else 0."""
    print(f"The course on {platform.system()} {platform.machine()}\n")
    stops = 0
    for finding in findings():
        stops += finding.level == "STOP"
        print(f"  {painted(finding.level)}  {finding.what}")
        if finding.remedy:
            print(f"        -> {finding.remedy}")
        sys.stdout.flush()
    print("\nSomething stops the lessons: see STOP above." if stops else "\nThe lessons can start: `make lab`.")
    return 1 if stops else 0


def painted(level: str) -> str:
    text = f"{level:4}"
    return f"\033[{COLOURS[level]}m{text}\033[0m" if sys.stdout.isatty() else text


if __name__ == "__main__":
    sys.path[0] = str(ROOT)  # as a file, Python looks beside it; the package is one folder up
    sys.exit(main())
