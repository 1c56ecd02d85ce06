"""The shipped files in `assets/`, and their check against the manifest.

`manifest.json` lists the size of every file, its hash, the command and the package versions that made it, and the
behaviours that it depends on. `bootcourse.study.fingerprint` checks the behaviours; `bootcourse.study.ship` makes the
files.
"""

from pathlib import Path
from typing import Annotated, TypedDict

from msgspec import Meta

from bootcourse.files import read_json, sha256

FOLDER = Path(__file__).resolve().parent.parent.parent / "assets"
MANIFEST = "manifest.json"
LIMIT = 25_000_000  # bytes in total


class Entry(TypedDict):
    """A shipped file."""

    file: Annotated[str, Meta(pattern=r"^\w[\w.-]*(/\w[\w.-]*)*$")]  # its path in the folder
    sha256: Annotated[str, Meta(pattern="^[0-9a-f]{64}$")]
    bytes: Annotated[int, Meta(ge=0, le=LIMIT)]
    command: str  # that makes it
    behaviour: dict[str, str]  # {name: key of a fingerprint}
    versions: dict[str, str]  # {package: version}


class Manifest(TypedDict):
    files: list[Entry]
    behaviours: dict[str, dict[str, list[float]]]  # {name: {key: fingerprint}}


def read_manifest(folder: Path) -> Manifest:
    """The manifest of an assets folder. Raises BootcourseError if it is missing or damaged."""
    return read_json(folder / MANIFEST, Manifest)


def verify(folder: Path = FOLDER) -> list[str]:
    """The problems of the shipped files, one sentence each."""
    entries = read_manifest(folder)["files"]
    problems = []
    for entry in entries:
        path = folder / entry["file"]
        if not path.is_file():
            problems.append(f"{path} is missing: restore it from a copy, or make it again: {entry['command']}")
        elif path.stat().st_size != entry["bytes"] or sha256(path) != entry["sha256"]:
            problems.append(f"{path} is damaged: restore it from a copy, or make it again: {entry['command']}")
    listed = {MANIFEST, *(entry["file"] for entry in entries)}
    for path in sorted(folder.rglob("*")):
        if path.is_file() and path.relative_to(folder).as_posix() not in listed:
            problems.append(f"{path} is not in {MANIFEST}: delete it, or build the assets again.")
    size = sum(entry["bytes"] for entry in entries)
    if size >= LIMIT:
        problems.append(f"The assets hold {size / 1e6:.1f} MB: they must stay under {LIMIT / 1e6:.0f} MB.")
    return problems
