"""`@compiled`: a function that numba compiles to machine code and caches on disk.

numba's default cache depends only on the file of the called function: after a change in formulas.py, the cached loop
of twin.py would still contain the old formula. This cache is in a folder whose name is a hash of every file with
compiled functions, so any change recompiles all of them.

Two settings make the road about three times as fast: small functions are inlined (forceinline), and reference
counting (_nrt) is on only for functions that allocate arrays, because it costs more than the formulas.
"""

import hashlib
import os
from pathlib import Path

import numba
from platformdirs import user_cache_dir

PACKAGE = Path(__file__).resolve().parent.parent


def sources(package: Path) -> list[Path]:
    """The files whose text the cache depends on: all of `road`, and every other file with a compiled function."""
    files = sorted([*package.glob("*.py"), *package.glob("*/*.py")])
    return [file for file in files if file.parent.name == "road" or b"\n@compiled" in file.read_bytes()]


def cache_folder(package: Path) -> Path:
    """The cache of this version: in the package's `__pycache__` if it is writable, otherwise in the user's cache.

    Where numba's own NUMBA_CACHE_DIR is set, it is there.
    """
    text = b"".join(source.read_bytes() for source in sources(package))
    name = f"numba-{hashlib.sha256(text).hexdigest()[:12]}"
    if os.environ.get("NUMBA_CACHE_DIR"):
        return Path(os.environ["NUMBA_CACHE_DIR"]) / name
    beside = package / "__pycache__"
    writable = os.access(beside if beside.exists() else package, os.W_OK)
    return (beside if writable else Path(user_cache_dir("bootcourse"))) / name


CACHE_FOLDER = cache_folder(PACKAGE)


def compiled(function):
    """Compile a function that allocates no arrays in numba's nopython mode; division by zero as in numpy."""
    return _compile(function, makes_arrays=False)


def compiled_loop(function):
    """Compile a function that may allocate arrays, such as a loop over many roads."""
    return _compile(function, makes_arrays=True)


def _compile(function, makes_arrays: bool):
    before = numba.config.CACHE_DIR
    numba.config.CACHE_DIR = str(CACHE_FOLDER)
    try:
        return numba.njit(cache=True, error_model="numpy", nogil=True, forceinline=True, _nrt=makes_arrays)(function)
    finally:
        numba.config.CACHE_DIR = before
