"""JSON files with a hash of their own content, so that a changed one is noticed when it is read."""

import hashlib
import json
from pathlib import Path

from bootcourse.errors import BootcourseError
from bootcourse.files import COPY, read_json, sha256, write_json


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


def is_file_with(path: Path, digest: str) -> bool:
    """Is there a file with this SHA-256 hash?"""
    return path.is_file() and sha256(path) == digest
