"""`@compiled`: a function that numba compiles to machine code and caches on disk.

numba's default cache depends only on the file of the called function: after a change in formulas.py, the cached loop
of twin.py would still contain the old formula. This cache is in a folder whose name is a hash of the processor and of
every file with compiled functions, so any change recompiles all of them, and machines that share a disk do not meet.
A file in it that is damaged is compiled again. Where no lasting folder can be written, the cache lasts as long as the
process, in a temporary folder that nobody else may open.

Two settings make the road about three times as fast: small functions are inlined (forceinline), and reference
counting (_nrt) is on only for functions that allocate arrays, because it costs more than the formulas.
"""

import atexit
import hashlib
import os
import shutil
import sys
import tempfile
from contextlib import suppress
from pathlib import Path
from typing import Any

import numba
from llvmlite.binding import get_host_cpu_features, get_host_cpu_name
from numba.core.caching import FunctionCache

from bootcourse.caches import PACKAGE, cache_places


def sources(package: Path) -> list[Path]:
    """The files whose text the cache depends on: all of `road`, and every other file with a compiled function."""
    files = sorted([*package.glob("*.py"), *package.glob("*/*.py")])
    return [file for file in files if file.parent.name == "road" or b"\n@compiled" in file.read_bytes()]


def cache_folder(files: list[Path], places: list[Path], kind: str = "numba") -> tuple[Path | None, str]:
    """(the cache for these files, "") in the first of these places that can be written, or (None, why none can)."""
    text = b"".join(file.read_bytes() for file in files)
    text += f"{get_host_cpu_name()} {get_host_cpu_features().flatten()}".encode()
    name, reasons = f"{kind}-{hashlib.sha256(text).hexdigest()[:12]}", []
    for place in places:
        try:
            (place / name).mkdir(parents=True, exist_ok=True)
            with tempfile.TemporaryFile(dir=place / name):
                return place / name, ""
        except OSError as error:
            reasons.append(f"{place} ({error.strerror})")
    return None, ", ".join(reasons)


def make_temporary_place() -> None:
    """Set NUMBA_CACHE_DIR to a new folder, for this process and those that it starts; it is removed at the end.

    The folder has an unpredictable name and mode 700: compiled code that somebody else put there would be executed.
    """
    with suppress(OSError):
        folder, owner = tempfile.mkdtemp(prefix="bootcourse-"), os.getpid()
        os.environ["NUMBA_CACHE_DIR"] = folder

        def remove() -> None:
            if os.getpid() == owner:
                shutil.rmtree(folder, ignore_errors=True)

        atexit.register(remove)


CACHE_FOLDER, UNWRITABLE = cache_folder(sources(PACKAGE), cache_places())
ADVICE = "Make one of them writable, or set NUMBA_CACHE_DIR to a folder of yours that can be written."
if UNWRITABLE:
    print(
        f"Every start compiles the road again, because nothing can be kept in {UNWRITABLE}. {ADVICE}", file=sys.stderr
    )
    make_temporary_place()
    CACHE_FOLDER, _ = cache_folder(sources(PACKAGE), cache_places())


class Cache(FunctionCache):
    """numba's cache of a function, which does without a file that cannot be read or written."""

    def load_overload(self, sig, target_context):
        """The compiled code of a signature; None, and it is compiled again, if a power cut or the like damaged it."""
        try:
            return super().load_overload(sig, target_context)
        except Exception:  # whatever pickle or LLVM raise
            with suppress(OSError):
                self.flush()
            return None

    def save_overload(self, sig, data):
        """Keep compiled code for later starts, if there is room for it."""
        try:
            super().save_overload(sig, data)
        except OSError as error:
            print(f"Compiled code is not kept in {self.cache_path}: {error.strerror}.", file=sys.stderr)


def compiled(function):
    """Compile a function that allocates no arrays in numba's nopython mode; division by zero as in numpy."""
    return compile_into(CACHE_FOLDER, function, forceinline=True, _nrt=False)


def compiled_loop(function):
    """Compile a function that may allocate arrays, such as a loop over many roads."""
    return compile_into(CACHE_FOLDER, function, forceinline=True, _nrt=True)


def compile_into(folder: Path | None, function, **options):
    """The function compiled with these options of numba, cached in a folder; None: not cached."""
    config: Any = numba.config
    before, config.CACHE_DIR = config.CACHE_DIR, str(folder)
    try:
        made = numba.njit(cache=folder is not None, error_model="numpy", nogil=True, **options)(function)
        if folder is not None:
            made._cache = Cache(function)
        return made
    finally:
        config.CACHE_DIR = before
