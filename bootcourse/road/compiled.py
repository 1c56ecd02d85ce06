"""`@compiled`: a function that numba turns into machine code, kept on disk between sessions.

numba's own cache looks only at the file of the function that is called. A change in formulas.py
would leave the old formula inside the cached loop of twin.py. Here the cache lives in a folder
named after the text of the road and of every other file with a compiled function, so a changed
formula is always compiled again.

Two more settings make the road about three times as fast. A small function is put inside the one
that calls it (forceinline). And only a function that makes arrays counts who holds them (_nrt): to
count at every call costs more than the formulas do.
"""

import hashlib
import os
from pathlib import Path

import numba
from platformdirs import user_cache_dir

PACKAGE = Path(__file__).resolve().parent.parent


def sources(package: Path) -> list[Path]:
    """The files whose text decides what is compiled: the road's own, and each with a compiled function."""
    files = sorted([*package.glob("*.py"), *package.glob("*/*.py")])
    return [file for file in files if file.parent.name == "road" or b"\n@compiled" in file.read_bytes()]


def cache_folder(package: Path) -> Path:
    """Where the machine code of this version lies: beside the package, or where the user's caches are."""
    text = b"".join(source.read_bytes() for source in sources(package))
    name = f"numba-{hashlib.sha256(text).hexdigest()[:12]}"
    beside = package / "__pycache__"
    writable = os.access(beside if beside.exists() else package, os.W_OK)
    return (beside if writable else Path(user_cache_dir("bootcourse"))) / name


CACHE_FOLDER = cache_folder(PACKAGE)


def compiled(function):
    """Compile `function` in numba's nopython mode, with numpy's rules for division by zero.

    It makes no arrays, only numbers: it fills the arrays that it is given.
    """
    return _compile(function, makes_arrays=False)


def compiled_loop(function):
    """The same for a loop over many roads, which may make the arrays that its functions work in."""
    return _compile(function, makes_arrays=True)


def _compile(function, makes_arrays: bool):
    before = numba.config.CACHE_DIR
    numba.config.CACHE_DIR = str(CACHE_FOLDER)
    try:
        return numba.njit(cache=True, error_model="numpy", nogil=True, forceinline=True, _nrt=makes_arrays)(function)
    finally:
        numba.config.CACHE_DIR = before
