"""The text of the world's module: the scripts of this folder one after the other, and what they are given to work on.

The compiled road, the agents and the car take a minute to make (build.py), so they ship in world.json, with a hash of
everything that they are made of. Where one of these files was changed, they are made anew, once, and kept in a cache.
Nothing here imports what makes them, so a notebook shows its first picture at once.

    python -m bootcourse.web.bundle     # after a change: makes world.json anew
"""

import hashlib
import json
import re
from contextlib import suppress
from functools import cache
from pathlib import Path

from bootcourse.caches import cache_places
from bootcourse.errors import BootcourseError
from bootcourse.files import write_bytes

HERE = Path(__file__).resolve().parent
PACKAGE = HERE.parent
SHIPPED = HERE / "world.json"
MADE_OF = (
    "[a-z]*.py", "road/*.py", "episodes/*.py", "learn/agent.py", "learn/networks.py", "learn/protocol.py",
    "learn/compiled*.py", "learn/records.py", "learn/settings.py", "learn/vectorised.py", "replay3d/*.py",
    "plots/road.py", "plots/svg.py", "web/build.py", "web/entries.py", "web/learning.py", "web/packing.py",
    "web/wasm.py", "web/*.safetensors",
)  # fmt: skip
IN_DEPTH = ("shaders", "webgl", "scene")  # the view in 3D
SCRIPTS = (
    "imports", "random", "road", "minds", "drive", "drivers", "seat", "words", "address", "view", *IN_DEPTH,
    "thoughts", "summary", "controls", "main", "mount",
)  # fmt: skip


def text_of(name: str) -> str:
    """A file of this folder without indentation; of a style also without comments and spaces at its marks."""
    text = re.sub(r"^[ \t]+", "", (HERE / name).read_text(encoding="utf-8"), flags=re.M)
    return re.sub(r" ?/\*.*?\*/|(?<=[:;{]) | (?=[{}])", "", text) if name.endswith(".css") else text


def script(name: str) -> str:
    """A script of this folder without indentation, and without the lines that are comments or empty."""
    return re.sub(r"^[ \t]*(//.*)?\n?", "", (HERE / f"{name}.js").read_text(encoding="utf-8"), flags=re.M)


def module() -> str:
    """The scripts that make a world, whose door is `mount`, with the style and the elements of its shadow root."""
    style = "".join(map(text_of, ("theme.css", "controls.css", "style.css")))
    own = {"STYLE": style, "WORLD": text_of("world.html")}
    texts = [f"const {name} = `{text}`;" for name, text in own.items()]
    return "\n".join([content()["names"], *texts, *map(script, SCRIPTS)])


def notebook_module() -> str:
    """The same as an ES module for notebooks, with its data in it."""
    data = json.loads(content()["data"])
    data.pop("learning", None)  # in a notebook, Python trains
    texts = [module(), f"const DATA = {json.dumps(data)};", script("watched"), script("widget")]
    return "\n".join([*texts, "export { mount, show, DATA };"])


@cache
def content() -> dict[str, str]:
    """What build.py makes, for the scripts: "names" and "data"."""
    made_of = fingerprint()
    cached = [place / f"world-{made_of}.json" for place in cache_places()]
    for path in (SHIPPED, *cached):
        with suppress(OSError, ValueError):  # it is not there, or a power cut has damaged it
            kept = json.loads(path.read_text(encoding="utf-8"))
            if kept["made_of"] == made_of:
                return kept
    print("The road is compiled for the browser, once: one minute, or two.", flush=True)
    made = make()
    for path in cached:
        try:
            write_bytes(path, json.dumps(made).encode())
            break
        except BootcourseError:  # a folder that cannot be written: the next one
            continue
    return made


def make() -> dict[str, str]:
    """The same, made anew, and of what."""
    from bootcourse.web import build

    return {"made_of": fingerprint(), **build.content()}


def fingerprint() -> str:
    """Changes with every file that `content` is made of."""
    text = hashlib.sha256()
    for path in sorted({path for pattern in MADE_OF for path in PACKAGE.glob(pattern)}):
        text.update(path.name.encode() + path.read_bytes())
    return text.hexdigest()[:12]


if __name__ == "__main__":
    write_bytes(SHIPPED, json.dumps(make(), indent=1).encode() + b"\n")
