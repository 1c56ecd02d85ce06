"""`@vectorised`: a function of the learner that numba compiles to vector instructions, and caches on disk.

The learner takes most of a minute to compile, the road some seconds. So it has a cache of its own, whose name is a hash
of the learner's compiled files and of the road's, and nothing is compiled before it is called: people who only use the
road do not wait. A product and a sum may be one instruction (`contract`), which rounds once instead of twice.
"""

import sys
from pathlib import Path

from bootcourse.road.compiled import PACKAGE, cache_folder, cache_places, compile_into, sources


def learner_sources(package: Path) -> list[Path]:
    """The files whose text the learner's cache depends on."""
    learn = package / "learn"
    ours = [file for file in sorted(learn.glob("*.py")) if b"\n@vectorised" in file.read_bytes()]
    return [*sources(package), learn / "vectorised.py", learn / "records.py", *ours]  # shapes are constants of the code


CACHE_FOLDER, _ = cache_folder(learner_sources(PACKAGE), cache_places(), "learner")


def vectorised(function):
    """Compile a function that allocates no arrays, for vector instructions."""
    return compile_into(CACHE_FOLDER, function, fastmath={"contract"}, _nrt=False)


def announce(function, seconds: int) -> None:
    """Print, before the first call, that a function is not in the cache and takes so long to compile."""
    if CACHE_FOLDER is None or not any(CACHE_FOLDER.rglob(f"*{function.__name__}-*.nbi")):
        print(f"The learner is compiled, once: about {seconds} s.", file=sys.stderr)
