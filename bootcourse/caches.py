"""Where what takes long to compile may be kept from one start to the next."""

import os
from contextlib import suppress
from pathlib import Path

from platformdirs import user_cache_dir

PACKAGE = Path(__file__).resolve().parent


def cache_places() -> list[Path]:
    """The folders that may keep compiled code, the best first; numba's own NUMBA_CACHE_DIR, if set, goes before all."""
    chosen, own = os.environ.get("NUMBA_CACHE_DIR"), []
    with suppress(RuntimeError):  # a user without a home folder
        own = [Path(user_cache_dir("bootcourse"))]
    return [*([Path(chosen)] if chosen else []), PACKAGE / "__pycache__", *(each for each in own if each.is_absolute())]
