"""The shipped files in `assets/`, and their check against the manifest.

`manifest.json` lists the size of every file, its hash, and the command and the package versions that made it.
`bootcourse assets build` makes the files.
"""

from pathlib import Path
from typing import Annotated, TypedDict

from msgspec import Meta, convert

from bootcourse.errors import BootcourseError
from bootcourse.files import decoding
from bootcourse.storage.sealed import amiss, read_sealed

FOLDER = Path(__file__).resolve().parent.parent.parent / "assets"
MANIFEST = "manifest.json"
FORMAT = "bootcourse assets 2"
LIMIT = 24_000_000  # bytes in total


class Entry(TypedDict):
    """A shipped file."""

    file: Annotated[str, Meta(pattern=r"^\w[\w.-]*(/\w[\w.-]*)*$")]  # its path in the folder
    sha256: Annotated[str, Meta(pattern="^[0-9a-f]{64}$")]
    bytes: Annotated[int, Meta(ge=0, le=LIMIT)]
    command: str  # that makes it
    versions: dict[str, str]  # {package: version}


class Manifest(TypedDict):
    files: list[Entry]


def shipped(name: str = "", folder: Path | None = None) -> Path:
    """The place of something that ships, such as "runs". Raises BootcourseError where no results ship.

    folder: by default `FOLDER`, which an installed package lacks.
    """
    folder = folder or FOLDER
    if not (folder / MANIFEST).exists():
        raise BootcourseError(
            f"{folder} holds no shipped results, as an installed package does not: work in a clone of the course's "
            "repository, installed with `pip install -e .`."
        )
    return folder / name


def read_manifest(folder: Path) -> Manifest:
    """The manifest of an assets folder. Raises BootcourseError if it is damaged, or not there."""
    path = shipped(MANIFEST, folder)
    content = read_sealed(path, FORMAT)
    with decoding(path):
        return convert(content, Manifest)


def verify(folder: Path = FOLDER) -> list[str]:
    """The problems of the shipped files, one sentence each. Raises BootcourseError for a damaged manifest."""
    entries = read_manifest(folder)["files"]
    problems = []
    for entry in entries:
        remedy = f"restore it from a copy, or make it again with `{entry['command']}`"
        if sentence := amiss(folder / entry["file"], entry["sha256"], remedy):
            problems.append(sentence)
    listed = {MANIFEST, *(entry["file"] for entry in entries)}
    for path in sorted(folder.rglob("*")):
        if path.is_file() and path.relative_to(folder).as_posix() not in listed:
            problems.append(f"{path} is not in {MANIFEST}: delete it, or build the assets again.")
    size = sum(entry["bytes"] for entry in entries)
    if size >= LIMIT:
        problems.append(f"The assets hold {size / 1e6:.1f} MB: they must stay under {LIMIT / 1e6:.0f} MB.")
    return problems
