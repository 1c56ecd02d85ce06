"""Reading and writing files without pickles.

A file is written under a temporary name in the same folder, synced and renamed: an existing file is replaced only
when the new one is complete.
"""

import hashlib
import importlib.metadata
import io
import json
import os
import platform
import shutil
import tempfile
import zipfile
from pathlib import Path

import numpy as np

from bootcourse.errors import BootcourseError

TEMPORARY = ".tmp"  # at the end of every temporary name


def write_bytes(path: Path, data: bytes) -> None:
    """Write `data` to `path`, completely or not at all. Raises BootcourseError if the file cannot be written."""
    path = Path(path)
    temporary = None
    try:
        path.parent.mkdir(parents=True, exist_ok=True)
        with tempfile.NamedTemporaryFile(
            dir=path.parent, prefix=f".{path.name}.", suffix=TEMPORARY, delete=False
        ) as file:
            temporary = Path(file.name)
            file.write(data)
            file.flush()
            os.fsync(file.fileno())
        temporary.chmod(0o666 & ~_umask())
        temporary.replace(path)
    except OSError as error:
        reason = error.strerror or error
        raise BootcourseError(f"Cannot write {path}: {reason}. Free some space or choose another folder.") from None
    finally:  # also after an interrupt; after the renaming there is no temporary file
        if temporary is not None:
            temporary.unlink(missing_ok=True)


def _umask() -> int:
    mask = os.umask(0)
    os.umask(mask)
    return mask


def remove_temporary(folder: Path) -> None:
    """Remove the temporary files and folders that killed processes left in a folder and below it."""
    for path in [*Path(folder).rglob(f".*{TEMPORARY}")]:
        if path.is_dir():
            shutil.rmtree(path, ignore_errors=True)
        else:
            path.unlink(missing_ok=True)


def write_json(path: Path, value) -> None:
    """Write a value as JSON. Raises BootcourseError if the file cannot be written."""
    write_bytes(path, (json.dumps(value, indent=2, sort_keys=True) + "\n").encode())


def read_bytes(path: Path) -> bytes:
    """The bytes of a file. Raises BootcourseError if it cannot be read."""
    try:
        return Path(path).read_bytes()
    except OSError as error:
        raise BootcourseError(f"Cannot read {path}: {error.strerror or error}.") from None


def read_json(path: Path):
    """The value of a JSON file. Raises BootcourseError if it cannot be read or is not JSON."""
    try:
        return json.loads(read_bytes(path))
    except ValueError:
        raise BootcourseError(f"{path} is damaged: it is not JSON. Delete it, or restore it from a copy.") from None


def write_arrays(path: Path, arrays: dict[str, np.ndarray], compress: bool = True) -> None:
    """Write named arrays as an `.npz` file. Raises BootcourseError if it cannot be written."""
    buffer = io.BytesIO()
    (np.savez_compressed if compress else np.savez)(buffer, **arrays)
    write_bytes(path, buffer.getvalue())


def read_arrays(path: Path) -> dict[str, np.ndarray]:
    """All arrays of an `.npz` file. Raises BootcourseError if it is missing, truncated or contains pickles."""
    read_bytes(path)  # raises BootcourseError for a missing file
    try:
        with np.load(path, allow_pickle=False) as file:  # a single array (.npy) raises TypeError here
            return {name: file[name] for name in file.files}
    except (ValueError, TypeError, OSError, EOFError, KeyError, zipfile.BadZipFile):
        raise BootcourseError(f"{path} is damaged or cut short: record it again, or restore it from a copy.") from None


def sha256(path: Path) -> str:
    """The SHA-256 hash of a file, in hexadecimal."""
    return hashlib.sha256(read_bytes(path)).hexdigest()


def provenance(**more) -> dict:
    """The versions of Python and of the packages that results depend on, and the given entries."""
    packages = ("bootcourse", "highway-env", "gymnasium", "numpy", "numba", "torch")
    versions = {}
    for name in packages:
        try:
            versions[name] = importlib.metadata.version(name)
        except importlib.metadata.PackageNotFoundError:
            versions[name] = "not installed"
    return {"python": platform.python_version(), **versions, **more}
