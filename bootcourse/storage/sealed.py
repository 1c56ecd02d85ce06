"""Hashes: JSON files with one of their own content, and what to say of a file that has not the hash it should have."""

import hashlib
import json
from pathlib import Path

from bootcourse.errors import BootcourseError
from bootcourse.files import COPY, LARGEST_JSON, read_bytes, read_json, sha256, unix_lines, write_json

LINE_ENDINGS = "In a Git clone, run `git config core.autocrlf false`, delete it, and fetch it with `git checkout` again"


def write_sealed(path: Path, content: dict) -> None:
    """Write an object with its seal. Raises BootcourseError if the file cannot be written."""
    write_json(path, content | {"seal": seal(content)})


def read_sealed(path: Path, format: str | None = None, remedy: str = COPY) -> dict:
    """The object that `write_sealed` wrote. format: the text that its "format" must be; None: it has no such entry.

    Raises BootcourseError if the file is missing, damaged, or of another version.
    """
    content = read_json(path, dict, remedy)
    if content.pop("seal", None) != seal(content):
        raise BootcourseError(f"{path} is damaged (it does not fit its own hash): {remedy}.")
    if content.get("format") != format:
        raise BootcourseError(f"{path} has the format {content.get('format')!r:.40}, this version reads {format!r}.")
    return content


def seal(content: dict) -> str:
    """The hash of an object."""
    return hashlib.sha256(json.dumps(content, sort_keys=True).encode()).hexdigest()


def amiss(path: Path, digest: str, remedy: str = COPY) -> str:
    """A sentence about a file that has not this SHA-256 hash; "" if it has. remedy: for one that is damaged."""
    if not path.is_file():
        return f"{path} is missing: {remedy}."
    if sha256(path) == digest:
        return ""
    if path.stat().st_size < LARGEST_JSON and hashlib.sha256(unix_lines(read_bytes(path))).hexdigest() == digest:
        return f"{path} is not as it was: its line endings were changed, as Git for Windows does. {LINE_ENDINGS}."
    return f"{path} is damaged, its hash has changed: {remedy}."
