"""Writing and reading files so that nothing is lost and nothing damaged is believed.

A file is written under a temporary name in its own folder, synced, and renamed: what existed before
stays whole until the new file is complete. No pickles.
"""

import hashlib
import importlib.metadata
import io
import json
import os
import platform
import tempfile
import zipfile
from pathlib import Path

import numpy as np

from bootcourse.errors import BootcourseError


def write_bytes(path: Path, data: bytes) -> None:
    """Replace `path` by `data`, all or nothing. Raises BootcourseError if the disk refuses."""
    path = Path(path)
    temporary = None
    try:
        path.parent.mkdir(parents=True, exist_ok=True)
        with tempfile.NamedTemporaryFile(dir=path.parent, prefix=f".{path.name}.", delete=False) as file:
            temporary = Path(file.name)
            file.write(data)
            file.flush()
            os.fsync(file.fileno())
        temporary.chmod(0o666 & ~_umask())
        temporary.replace(path)
    except OSError as error:
        reason = error.strerror or error
        raise BootcourseError(f"Cannot write {path}: {reason}. Free some space or choose another folder.") from None
    finally:  # also after an interrupt; once renamed, nothing is there any more
        if temporary is not None:
            temporary.unlink(missing_ok=True)


def _umask() -> int:
    mask = os.umask(0)
    os.umask(mask)
    return mask


def write_json(path: Path, value) -> None:
    write_bytes(path, (json.dumps(value, indent=2, sort_keys=True) + "\n").encode())


def read_bytes(path: Path) -> bytes:
    try:
        return Path(path).read_bytes()
    except OSError as error:
        raise BootcourseError(f"Cannot read {path}: {error.strerror or error}.") from None


def read_json(path: Path):
    try:
        return json.loads(read_bytes(path))
    except ValueError:
        raise BootcourseError(f"{path} is damaged: it is not JSON. Delete it, or restore it from a copy.") from None


def write_arrays(path: Path, arrays: dict[str, np.ndarray], compress: bool = True) -> None:
    """Write named arrays as an `.npz` without pickles."""
    buffer = io.BytesIO()
    (np.savez_compressed if compress else np.savez)(buffer, **arrays)
    write_bytes(path, buffer.getvalue())


def read_arrays(path: Path) -> dict[str, np.ndarray]:
    """Every array of a `.npz`. Raises BootcourseError if the file is missing, cut short or has pickles."""
    read_bytes(path)  # says in one sentence what is wrong with a missing file
    try:
        with np.load(path, allow_pickle=False) as file:  # a bare array (.npy) is no context: TypeError
            return {name: file[name] for name in file.files}
    except (ValueError, TypeError, OSError, EOFError, KeyError, zipfile.BadZipFile):
        raise BootcourseError(f"{path} is damaged or cut short: record it again, or restore it from a copy.") from None


def sha256(path: Path) -> str:
    return hashlib.sha256(read_bytes(path)).hexdigest()


def provenance(**more) -> dict:
    """Who made a file: the versions that decide a result, and whatever else is given."""
    packages = ("bootcourse", "highway-env", "gymnasium", "numpy", "numba", "torch")
    versions = {}
    for name in packages:
        try:
            versions[name] = importlib.metadata.version(name)
        except importlib.metadata.PackageNotFoundError:
            versions[name] = "not installed"
    return {"python": platform.python_version(), **versions, **more}
