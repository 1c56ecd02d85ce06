"""`bootcourse doctor`: checks of the installation and the machine, with a remedy for each problem.

Packages outside the standard library are imported inside the checks, so that it runs when some are missing.
`python bootcourse/doctor.py` runs it too.
"""

import importlib.metadata
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
LOCK, STUDENT_LOCK = ROOT / "environment.lock", ROOT / "student.lock"  # the second: what the lessons need of the first
OLDEST = (3, 11)
SET_UP = "Run `make lab` in the course's folder (on Windows, the install line of README.md)."
COMPILED = 10_000_000  # bytes that compiled code needs, with room to spare


class Finding(NamedTuple):
    """The result of a check. `level` is "ok", "note" (the lessons run) or "STOP" (they do not)."""

    level: str
    what: str
    remedy: str = ""


def python() -> Iterator[Finding]:
    """The version of Python."""
    here = f"Python {platform.python_version()} in {sys.prefix}"
    if sys.version_info < OLDEST:
        yield Finding("STOP", here, "Install Python 3.11 or newer, delete .venv, and run `make lab PYTHON=python3.11`.")
    else:
        yield Finding("ok", here)


def packages() -> Iterator[Finding]:
    """The installed packages against those of environment.lock for this platform."""
    if not LOCK.exists():
        yield Finding("note", f"{LOCK} is missing: versions not compared", "Work in a clone of the course.")
        return
    locked = locked_versions(LOCK.read_text(encoding="utf-8"))
    installed = {name: installed_version(name) for name in locked}
    needed = locked_versions(STUDENT_LOCK.read_text(encoding="utf-8")) if STUDENT_LOCK.exists() else locked
    missing = [name for name in ("bootcourse", *needed) if installed_version(name) is None]
    if missing:
        yield Finding("STOP", f"not installed: {', '.join(missing)}", SET_UP)
    if others := [name for name in locked if name not in needed and installed[name] is None]:
        yield Finding("note", f"not installed, and only the tests need it: {', '.join(others)}", SET_UP)
    for name in locked:
        if installed[name] not in (None, locked[name]):
            yield Finding("note", f"{name} is {installed[name]}, and the lessons were made with {locked[name]}", SET_UP)
    same = sum(installed[name] == locked[name] for name in locked)
    yield Finding("ok", f"{same} of {len(locked)} packages match {LOCK.name}")


def locked_versions(lock: str) -> dict[str, str]:
    """{name: version} of the lock's lines whose markers (`; sys_platform == 'linux'`) fit this machine."""
    try:
        from packaging.markers import Marker
    except ModuleNotFoundError:  # pip has a copy
        from pip._vendor.packaging.markers import Marker
    lines = re.findall(r"^([\w.-]+)==([^\s;]+)(?: ; ([^\\\n]+?))?(?: \\)?$", lock, flags=re.MULTILINE)
    return {name: version for name, version, marker in lines if not marker or Marker(marker).evaluate()}


def installed_version(name: str) -> str | None:
    """The version of a package; None if it is not installed."""
    try:
        return importlib.metadata.version(name)
    except importlib.metadata.PackageNotFoundError:
        return None


def road() -> Iterator[Finding]:
    """The compiled road takes a step."""
    import gymnasium

    start = time.perf_counter()
    roads = gymnasium.make_vec("bootcourse:Trap-v0", num_envs=4)
    roads.reset(seed=0)
    roads.step(roads.action_space.sample())
    roads.close()
    seconds = time.perf_counter() - start
    yield Finding("ok", f"the compiled road drives after {seconds:.1f} s (the first time it compiles)")


def port() -> Iterator[Finding]:
    """A local server, as JupyterLab and the 3D replays need."""
    try:
        with socket.create_server(("127.0.0.1", 0)) as server:
            with socket.create_connection(server.getsockname(), timeout=5):
                yield Finding("ok", "a page can be served on 127.0.0.1")
    except OSError as error:
        advice = "Allow local connections for Python in the firewall or security program."
        yield Finding("STOP", f"no page can be served on 127.0.0.1: {error}", advice)


def cache() -> Iterator[Finding]:
    """The folder for compiled code is writable."""
    from bootcourse.road.compiled import ADVICE, CACHE_FOLDER, UNWRITABLE

    if UNWRITABLE:
        yield Finding("note", f"every start compiles the road again: nothing can be kept in {UNWRITABLE}", ADVICE)
        return
    try:
        with tempfile.TemporaryFile(dir=CACHE_FOLDER) as file:
            file.write(bytes(COMPILED))
            file.flush()
        yield Finding("ok", f"compiled code is kept in {CACHE_FOLDER}")
    except OSError as error:  # numba would raise it at the first step
        yield Finding("STOP", f"{CACHE_FOLDER} cannot hold the compiled road: {error.strerror}", "Free some space.")


def lessons() -> Iterator[Finding]:
    """The lessons and the shipped results, which an installed package does not hold."""
    from bootcourse.storage.assets import FOLDER, MANIFEST, verify

    notebooks = list((ROOT / "notebooks").glob("*.ipynb"))
    whole = "Work in a whole copy of the course's repository, and run `make lab` there. (Training works here.)"
    if not notebooks:
        yield Finding("STOP", f"the lessons are not in {ROOT / 'notebooks'}", whole)
    if not (FOLDER / MANIFEST).exists():
        yield Finding("STOP", f"the results that the lessons show are not in {FOLDER}", whole)
    elif problems := verify():
        again = f"Delete the folder {FOLDER}, and "
        if (ROOT / ".git").exists():
            again += f"run `git checkout {FOLDER.name}` in {ROOT}."
        else:  # it was downloaded as a .zip file
            again += "put the one from a new download of the course in its place."
        yield Finding("STOP", f"{len(problems)} of the shipped files are wrong. {problems[0]}", again)
    elif notebooks:
        yield Finding("ok", f"{len(notebooks)} lessons, and the results that they show")


def disk() -> Iterator[Finding]:
    """The free disk space."""
    free = shutil.disk_usage(Path.cwd()).free / 1e9
    level = "ok" if free > 1 else "note" if free > 0.1 else "STOP"
    remedy = "" if level == "ok" else "Free some space: trained runs and recordings need up to 1 GB."
    yield Finding(level, f"{free:.1f} GB free on the disk of {Path.cwd()}", remedy)


CHECKS = (python, packages, cache, road, lessons, port, disk)


def main() -> int:
    """Print the findings of all checks. Returns 1 if a finding is STOP or a check raised an exception, else 0."""
    print(f"The course on {platform.system()} {platform.machine()}\n")
    stops = 0
    for check in CHECKS:
        for finding in findings(check):
            stops += finding.level == "STOP"
            print(f"  {finding.level:4}  {finding.what}" + (f"\n        -> {finding.remedy}" if finding.remedy else ""))
            sys.stdout.flush()
    print("\nThe lessons cannot start: see STOP above." if stops else "\nThe lessons can start: `make lab`.")
    return 1 if stops else 0


def findings(check) -> Iterator[Finding]:
    """The findings of a check; an exception that it raises is one."""
    try:
        yield from check()
    except ModuleNotFoundError as error:
        yield Finding("STOP", f"{check.__name__}: {error.name} is not installed", SET_UP)
    except Exception as error:
        yield Finding("STOP", f"{check.__name__}: {type(error).__name__}: {error}", SET_UP)


if __name__ == "__main__":
    sys.path[0] = str(ROOT)  # run as a file, Python would search this folder instead of the one above the package
    sys.exit(main())
