"""What ships with the course, so that nobody has to wait: checked here, made by `bootcourse.study.ship`.

`assets/manifest.json` lists every file with its size, its hash, the command that makes it, the
versions that made it, and the hash of the code that it depends on. A file whose code has changed
since is not wrong, only older than the code: `verify` says so.
"""

from pathlib import Path

from bootcourse.errors import BootcourseError
from bootcourse.files import read_json, sha256
from bootcourse.study.sources import sources_hash

FOLDER = Path(__file__).resolve().parent.parent.parent / "assets"
MANIFEST = "manifest.json"
LIMIT = 25_000_000  # bytes, all together


def report(folder: Path = FOLDER) -> int:
    """Print what is wrong with the shipped files, and what is older than the code. Returns the exit status."""
    problems, older = verify(folder)
    for sentence in (*problems, *older):
        print(sentence)
    entries = read_json(folder / MANIFEST)["files"]
    size = sum(entry["bytes"] for entry in entries) / 1e6
    print(f"{len(entries)} files, {size:.1f} MB: {len(problems)} wrong, {len(older)} made by older code.")
    return 1 if problems else 0


def verify(folder: Path = FOLDER) -> tuple[list[str], list[str]]:
    """(what is wrong, what is older than the code that it depends on), a sentence each."""
    entries = read_json(folder / MANIFEST)["files"]
    problems, older, size = [], [], 0
    for entry in entries:
        path = folder / entry["file"]
        if not path.is_file():
            problems.append(f"{path} is missing: restore it from a copy, or make it again: {entry['command']}")
        elif path.stat().st_size != entry["bytes"] or sha256(path) != entry["sha256"]:
            problems.append(f"{path} is damaged: restore it from a copy, or make it again: {entry['command']}")
        changed = changed_parts(entry["sources"])
        if changed:
            older.append(f"{entry['file']} is older than the code in {', '.join(changed)}: {entry['command']}")
        size += entry["bytes"]
    listed = {entry["file"] for entry in entries}
    for path in sorted(folder.rglob("*")):
        name = path.relative_to(folder).as_posix()
        if path.is_file() and name != MANIFEST and name not in listed:
            problems.append(f"{path} is not in {MANIFEST}: delete it, or build the assets again.")
    if size >= LIMIT:
        problems.append(f"The assets hold {size / 1e6:.1f} MB: they must stay under {LIMIT / 1e6:.0f} MB.")
    return problems, older


def changed_parts(sources: dict[str, str]) -> list[str]:
    """The parts of bootcourse whose code is no longer what these hashes were made from."""

    def now(part: str) -> str:
        try:
            return sources_hash([part])[part]
        except BootcourseError:  # moved or renamed since
            return ""

    return [part for part, digest in sources.items() if now(part) != digest]
