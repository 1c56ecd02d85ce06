"""`FILE.py:NAME` on the command line: a function or a class of the user's own file."""

import hashlib
import importlib.util
import sys
from pathlib import Path

from bootcourse.errors import BootcourseError, described
from bootcourse.scenario import Scenario, scenario_from

PREFIX = "own file "  # of the name under which Python knows a user's file
_folders: set[str] = set()  # of the files that were loaded


def loaded(place: str, option: str, what: str):
    """What "FILE.py:NAME" names. It can import the files beside it, but none in place of one of Python's own modules.

    Raises BootcourseError if it is not there or does not load.
    """
    file, _, name = place.rpartition(":")
    if Path(file).suffix != ".py":
        raise BootcourseError(f"{option} {place}: give a file and a {what} in it, such as mine.py:mine.")
    if not Path(file).is_file():
        raise BootcourseError(f"{option} {place}: there is no file {file}.")
    path = Path(file).resolve()
    find_neighbours(str(path.parent))
    # Two files of one name are two modules. Dataclasses look for theirs by its name.
    own = f"{PREFIX}{path.stem} {hashlib.sha256(str(path).encode('utf-8', 'surrogateescape')).hexdigest()[:12]}"
    spec = importlib.util.spec_from_file_location(own, path)
    module = sys.modules[own] = importlib.util.module_from_spec(spec)
    try:
        spec.loader.exec_module(module)
    except (Exception, SystemExit) as error:  # whatever the user's file does
        del sys.modules[own]
        raise BootcourseError(f"{file} cannot be loaded: {described(error)}.") from error
    if not hasattr(module, name):
        raise BootcourseError(f"{file} has no {what} '{name}': write it there, or give another name.")
    return getattr(module, name)


def scenario_at(place: str) -> Scenario:
    """The scenario of a name, or of "FILE.py:NAME": a `Scenario` there, or a dictionary. Raises BootcourseError."""
    return scenario_from(loaded(place, "--scenario", "scenario") if ":" in place else place)


def find_neighbours(folder: str) -> None:
    """Let the files of a folder be imported by name; those of another user's file, which keeps them, are forgotten.

    The folder is searched after Python's own modules and before the installed packages. A queue.py or statistics.py of
    the user would otherwise stop whatever imports Python's module later.
    """
    for name, module in list(sys.modules.items()):
        at = str(Path(getattr(module, "__file__", None) or "").parent)
        if at in _folders and at != folder and not name.startswith(PREFIX):
            del sys.modules[name]
    if folder in sys.path:
        sys.path.remove(folder)
    later = {*_folders, *(place for place in sys.path if Path(place).name in ("site-packages", "dist-packages"))}
    sys.path.insert(next((i for i, place in enumerate(sys.path) if place in later), len(sys.path)), folder)
    _folders.add(folder)
