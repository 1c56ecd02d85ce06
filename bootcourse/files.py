"""Reading and writing files without pickles.

A file is written under a temporary name in the same folder, synced and renamed: an existing file is replaced only
when the new one is complete. What a file says about its own size and contents is checked before anything is unpacked,
and whatever a damaged file makes a library raise becomes one sentence that names the file and the remedy.
"""

import contextlib
import dataclasses
import functools
import hashlib
import importlib.metadata
import io
import json
import math
import os
import platform
import secrets
import shutil
import stat
import zipfile
from pathlib import Path
from typing import Any, TypeVar

import msgspec
import numpy as np

from bootcourse.errors import BootcourseError, RuleFailed

TEMPORARY = ".tmp"  # at the end of every temporary name
LARGEST_JSON = 2**25  # bytes; the manifest of the assets has 0.1 MB
LARGEST_ARRAYS = 2**32  # bytes; the checkpoint of 100 agents with full replay buffers has 1.3 GB
UNPACKED = 2**28  # bytes that an .npz file may unpack to beyond its own size; ours compress to a tenth at best
MEMBERS = 10_000  # arrays in an .npz file, at most; the checkpoint of 100 agents has 3,000
PACKED = {zipfile.ZIP_STORED, zipfile.ZIP_DEFLATED}  # as numpy writes; others unpack beyond what they declare
LONGEST = 400  # characters of what is wrong with a file's contents, which may be quoted
COPY = "restore it from a copy, or make it again"  # the remedy for a damaged file
FIRST_BYTES = {".png": b"\x89PNG", ".gif": b"GIF8", ".pdf": b"%PDF", ".svg": b"<?xml", ".html": b"<!doctype html"}
Kind = TypeVar("Kind")


def write_bytes(path: Path, data: bytes) -> None:
    """Write `data` to `path`, completely or not at all. Raises BootcourseError if the file cannot be written."""
    path = Path(path)
    temporary = None
    try:
        path.parent.mkdir(parents=True, exist_ok=True)
        with open(path.with_name(f".{path.name}.{secrets.token_hex(4)}{TEMPORARY}"), "xb") as file:
            temporary = Path(file.name)
            file.write(data)
            file.flush()
            os.fsync(file.fileno())
        temporary.replace(path)
    except (OSError, ValueError) as error:  # ValueError: a null character in the name
        reason = getattr(error, "strerror", None) or error
        raise BootcourseError(f"Cannot write {path}: {reason}. Free some space or choose another folder.") from None
    finally:  # also after an interrupt; after the renaming there is no temporary file
        if temporary is not None:
            temporary.unlink(missing_ok=True)


def remove_temporary(folder: Path) -> None:
    """Remove the temporary files and folders that killed processes left in a folder and below it."""
    for path in [*Path(folder).rglob(f".*{TEMPORARY}")]:
        if path.is_dir():
            shutil.rmtree(path, ignore_errors=True)
        else:
            path.unlink(missing_ok=True)


def write_json(path: Path, value) -> None:
    """Write a value as JSON. Raises BootcourseError if the file cannot be written.

    What is no Unicode in its texts, as in a name from a terminal of another encoding, becomes "?": JSON cannot hold it.
    """
    text = json.dumps(value, indent=2, sort_keys=True)
    if "\\ud" in text:  # half a letter, perhaps
        value = json.loads(json.dumps(value, ensure_ascii=False).encode("utf-8", "replace"))
        text = json.dumps(value, indent=2, sort_keys=True)
    write_bytes(path, (text + "\n").encode())


def check_replaceable(path: Path, *endings: str) -> Path:
    """Raise BootcourseError unless `path` has one of these endings, and what it would replace is a file of that kind.

    A picture may replace an older picture, but not the text that someone gave the wrong name.
    """
    path = Path(path)
    ending = path.suffix.lower()
    if ending not in endings:
        raise BootcourseError(f"{path} does not end in {' or '.join(endings)}: give the file that ending.")
    if os.path.lexists(path):
        with open_regular(path) as file:
            if not file.read(20).lower().startswith(FIRST_BYTES[ending].lower()):
                raise BootcourseError(f"{path} exists already and is not a {ending[1:]} file: choose another name.")
    return path


def open_regular(path: Path, largest: float = math.inf):
    """A file, opened to read its bytes. Raises BootcourseError if it is missing, not a regular file, or too large."""
    path = Path(path)
    try:
        status = path.stat()  # before it is opened: opening a pipe would wait for its writer
        if not stat.S_ISREG(status.st_mode):
            raise BootcourseError(
                f"{path} is a {'folder' if stat.S_ISDIR(status.st_mode) else 'device'}, not a file: name a file."
            )
        if status.st_size > largest:
            raise BootcourseError(f"{path} has {status.st_size:,} bytes, at most {largest:,} can be right: {COPY}.")
        return path.open("rb")
    except BootcourseError:
        raise
    except (FileNotFoundError, NotADirectoryError):
        raise BootcourseError(f"{path} is not there: check the name, or {COPY}.") from None
    except (OSError, ValueError) as error:  # ValueError: a name that no file can have
        raise BootcourseError(f"Cannot read {path}: {getattr(error, 'strerror', None) or error}.") from None


@contextlib.contextmanager
def decoding(path: Path, remedy: str = COPY):
    """Turn whatever the block raises on the contents of a file into one sentence that names it: BootcourseError."""
    try:
        yield
    except BootcourseError as error:
        if isinstance(error, RuleFailed) or str(path) in str(error):  # a rule's failure says nothing of the file
            raise
        raise BootcourseError(f"{path}: {str(error)[:LONGEST]}") from None
    except msgspec.ValidationError as error:
        raise BootcourseError(f"{path} is damaged or of another version ({_in_short(error)}): {remedy}.") from None
    except Exception as error:  # of zlib, zipfile, numpy, safetensors, memory, recursion ...: no list is complete
        raise BootcourseError(f"{path} is damaged or cut short ({_in_short(error)}): {remedy}.") from None


def _in_short(error: Exception) -> str:
    words = " ".join(str(error).split())
    return f"{words[:200]}..." if len(words) > 200 else words or type(error).__name__


def read_bytes(path: Path, largest: int = LARGEST_JSON, remedy: str = COPY) -> bytes:
    """The bytes of a file. Raises BootcourseError if it is missing, not a regular file, or too large."""
    with open_regular(path, largest) as file, decoding(path, remedy):
        return file.read()


def read_json(path: Path, kind: type[Kind] = Any, remedy: str = COPY) -> Kind:
    """The value of a JSON file. Raises BootcourseError if it cannot be read, or is not of this kind (see `parse`)."""
    return parse(read_bytes(path, remedy=remedy), kind, path, remedy)


def parse(text: str | bytes, kind: type[Kind], path: Path, remedy: str = COPY) -> Kind:
    """The value of JSON text from a file, as msgspec builds a `kind`: each field is checked for its type and range.

    A kind with a class variable FORMAT also wants this text in its field "format".
    Raises BootcourseError that names the file, the field and the remedy.
    """
    with decoding(path, remedy):
        if isinstance(text, bytes) and json.detect_encoding(text) != "utf-8":  # a Windows editor has saved it
            text = text.decode(json.detect_encoding(text))
        value, wanted = msgspec.json.decode(text), getattr(kind, "FORMAT", None)
        if wanted and isinstance(value, dict) and value.get("format") != wanted:
            raise BootcourseError(
                f"{path} has the format {value.get('format')!r:.40}, this version reads '{wanted}': {remedy}."
            )
        built = msgspec.convert(value, kind)
        _want_all_fields(value, built)
        return built


def _want_all_fields(value: Any, built: Any) -> None:
    """A file names each field of a dataclass: none takes its default unseen. Raises BootcourseError."""
    if dataclasses.is_dataclass(built):
        names = {field.name for field in dataclasses.fields(built)}
        if different := sorted(names ^ set(value)):
            raise BootcourseError(f"{type(built).__name__} in another version has other fields: {different[0]!r:.40}.")
    elif isinstance(built, msgspec.Struct):
        names = set(built.__struct_fields__) & set(value)
    else:
        return
    for name in names:
        _want_all_fields(value[name], getattr(built, name))


def write_arrays(path: Path, arrays: dict[str, np.ndarray], compress: bool = True) -> None:
    """Write named arrays as an `.npz` file. Raises BootcourseError if it cannot be written."""
    buffer = io.BytesIO()
    (np.savez_compressed if compress else np.savez)(buffer, **arrays)
    write_bytes(path, buffer.getvalue())


def read_arrays(path: Path, remedy: str = COPY) -> dict[str, np.ndarray]:
    """All arrays of an `.npz` file: numbers, booleans or text.

    Raises BootcourseError if it is missing, damaged, holds pickles, or would unpack to more than it can rightly hold.
    """
    with open_regular(path, LARGEST_ARRAYS) as file, decoding(path, remedy):
        members = zipfile.ZipFile(file).infolist()
        declared = sum(member.file_size for member in members)
        if len(members) > MEMBERS or declared > os.fstat(file.fileno()).st_size + UNPACKED:
            raise ValueError(f"it declares {len(members):,} arrays of {declared:,} bytes")
        if {member.compress_type for member in members} - PACKED:
            raise ValueError("numpy would not pack it like this")
        file.seek(0)
        with np.load(file, allow_pickle=False) as arrays:
            return {name: arrays[name] for name in arrays.files}


def check_arrays(arrays: dict[str, np.ndarray], shapes: dict[str, tuple], path: Path, remedy: str = COPY) -> None:
    """Raise BootcourseError unless `arrays` are those of `shapes` {name: shape} and hold numbers."""
    if odd := sorted(arrays.keys() ^ shapes.keys()):
        raise BootcourseError(f"{path} is incomplete or of another version (see {', '.join(odd[:3])}): {remedy}.")
    for name, shape in shapes.items():
        array = arrays[name]
        if array.shape != shape or array.dtype.kind not in "biuf":
            raise BootcourseError(f"{path}: {name} is {array.dtype} {array.shape}, not numbers {shape}: {remedy}.")


def read_tensors(path: Path, remedy: str = COPY) -> dict[str, np.ndarray]:
    """All tensors of a safetensors file. Raises BootcourseError if it is missing or damaged."""
    from safetensors.numpy import load

    with decoding(path, remedy):
        return load(read_bytes(path, LARGEST_ARRAYS, remedy))


def sha256(path: Path) -> str:
    """The SHA-256 hash of a file, in hexadecimal."""
    with open_regular(path) as file:
        return hashlib.file_digest(file, "sha256").hexdigest()


def unix_lines(data: bytes) -> bytes:
    """A text with the line endings of Linux, whatever Git for Windows made of them; data with zeros as it is."""
    return data if b"\0" in data else data.replace(b"\r\n", b"\n")


def provenance(**more) -> dict:
    """The versions of Python and of the packages that results depend on, and the given entries."""
    packages = ("bootcourse", "highway-env", "gymnasium", "numpy", "numba", "torch")
    return {"python": platform.python_version(), **{name: _version(name) for name in packages}, **more}


@functools.cache  # a package's files tell its version, which takes a millisecond
def _version(package: str) -> str:
    try:
        return importlib.metadata.version(package)
    except importlib.metadata.PackageNotFoundError:
        return "not installed"
