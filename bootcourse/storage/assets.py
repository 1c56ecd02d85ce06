"""What ships with the course, so that nobody has to wait: `assets/` and its manifest.

`manifest.json` lists every file with its size, its hash, the command that makes it, the versions of the packages
that made it, and the behaviours that it depends on. Here the files are checked; `bootcourse.study.fingerprint` checks
the behaviours, and `bootcourse.study.ship` makes it all.
"""

from pathlib import Path

from bootcourse.files import read_json, sha256

FOLDER = Path(__file__).resolve().parent.parent.parent / "assets"
MANIFEST = "manifest.json"
LIMIT = 25_000_000  # bytes, all together


def verify(folder: Path = FOLDER) -> list[str]:
    """What is wrong with the shipped files, a sentence each."""
    entries = read_json(folder / MANIFEST)["files"]
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
