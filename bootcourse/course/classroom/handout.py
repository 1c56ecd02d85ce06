"""What a lecturer hands out: some lessons with the kit that they need, a lock and one page, and no solutions in reach.

`handout.json` says which files and cells were handed out, so that an update knows what a student has changed.
"""

import itertools
import json
import shutil
from pathlib import Path
from typing import ClassVar

import msgspec
from msgspec import Struct

import bootcourse
from bootcourse.course.classroom.merge import hashed, merge, texts
from bootcourse.course.edition import HANDOUT
from bootcourse.course.lessons import LESSONS, number
from bootcourse.errors import BootcourseError
from bootcourse.files import read_bytes, read_json, write_bytes, write_json

KIT = Path(bootcourse.__file__).resolve().parent.parent
COPIED = ("bootcourse", "assets", "tools/install.sh", "pyproject.toml", "Makefile", "LICENSE")


class Handout(Struct):
    """The content of `handout.json`."""

    FORMAT: ClassVar[str] = "bootcourse handout 2"

    solutions: bool  # may `check.solution` show them?
    files: dict[str, str]  # name -> `hashed`
    cells: dict[str, dict[str, str]]  # notebook -> `texts`
    format: str = FORMAT


README = """# Lessons to work in

**To begin**, open a terminal in this folder and type `make lab` (Python 3.11 or newer; it takes a few minutes
the first time). On Windows, in PowerShell:

```powershell
py -3.11 -m venv .venv; .venv\\Scripts\\pip install --no-deps --require-hashes -r environment.lock
.venv\\Scripts\\pip install --no-deps --no-build-isolation -e .
.venv\\Scripts\\jupyter-lab --ServerApp.root_dir=notebooks
```

Something is wrong? `make doctor` says what (Windows: `.venv\\Scripts\\bootcourse doctor`).

**Lessons**

{lessons}

Work in the notebooks, and save them. A check tells you whether an answer is right, and `check.hint("NAME")` helps;
{solutions} Your predictions are kept in `notebooks/answers`.

**To hand in**, type `.venv/bin/bootcourse submit notebooks --name "Your Name"` (Windows: `.venv\\Scripts\\bootcourse`).
It runs nothing, and writes one file: hand in that file.
"""


def write(folder: Path, lessons: set[int] | None, solutions: bool) -> list[str]:
    """Write a new handout as a folder and a zip file. Returns what was done. Raises BootcourseError.

    The folder must not exist, or be empty; the zip file must not exist.
    """
    archive = folder.resolve().with_name(f"{folder.resolve().name}.zip")
    if folder.exists() and (not folder.is_dir() or any(folder.iterdir())):
        raise BootcourseError(f"{folder} exists already: choose another folder, or bring it up to date with --update.")
    if archive.exists():
        raise BootcourseError(f"{archive} exists already: choose another folder, or move this file away.")
    parts = content(lessons, solutions)
    for name, data in parts.items():
        write_bytes(folder / name, data)
    shutil.make_archive(str(archive.with_suffix("")), "zip", archive.parent, archive.stem)
    count = sum(name.endswith(".ipynb") for name in parts)
    return [f"{folder}: {count} lessons.", f"{archive}: {archive.stat().st_size / 1e6:.0f} MB."]


def update(folder: Path, lessons: set[int] | None, solutions: bool | None) -> list[str]:
    """Bring a handout up to date. Returns what was done, a sentence a file. Raises BootcourseError if it is none.

    What a student wrote in a notebook stays; another file that was changed is kept as NAME.yours. Without lessons,
    they stay as they are.
    """
    if not (folder / HANDOUT).is_file():
        raise BootcourseError(f"{folder} is no handout: it has no {HANDOUT}. Leave out --update to write a new one.")
    old = read_json(folder / HANDOUT, Handout, "restore it from the handout's zip file")
    before = {Path(name).stem.partition("_")[2] for name in old.cells}  # notebooks/05_the_barrier.ipynb -> the_barrier
    lessons = lessons or {number(lesson) for lesson in before if lesson in LESSONS}
    parts = content(lessons, old.solutions if solutions is None else solutions)
    return [said for name, data in parts.items() for said in place(folder / name, name, data, old)]


def place(path: Path, name: str, data: bytes, old: Handout) -> list[str]:
    """Put one file of an update in its place. Returns a sentence if anything of it is a student's, or is new."""
    if not path.exists():
        write_bytes(path, data)
        return [f"{name}: new."] if path.suffix == ".ipynb" else []
    mine = read_bytes(path)
    if mine == data or name == HANDOUT or hashed(mine) == old.files.get(name):
        write_bytes(path, data)
        return [f"{name}: replaced; nobody had changed it."] if mine != data and path.suffix == ".ipynb" else []
    if path.suffix == ".ipynb":
        try:
            merged, said = merge(read_json(path, dict), old.cells.get(name, {}), json.loads(data))
        except (BootcourseError, KeyError, TypeError, AttributeError):
            new = spare(path.with_suffix(".new.ipynb"), data)
            return [f"{name}: damaged, and left as it is; the new version is {new}."]
        write_json(path, merged)
        return [f"{name}: {said}"]
    yours = spare(path.with_name(f"{path.name}.yours"), mine)
    write_bytes(path, data)
    return [f"{name}: replaced; the one that was here is {yours}."]


def spare(path: Path, data: bytes) -> str:
    """Write to this file, or beside it if it holds something else. Returns the file's name."""
    free = (path.with_stem(f"{path.stem}-{count}") if count > 1 else path for count in itertools.count(1))
    path = next(each for each in free if not each.exists() or each.is_file() and read_bytes(each) == data)
    write_bytes(path, data)
    return path.name


def content(lessons: set[int] | None, solutions: bool) -> dict[str, bytes]:
    """{name: data} of every file of a handout. Raises BootcourseError where the notebooks are not installed."""
    files, cells, titles = {}, {}, []
    for path in sorted((KIT / "notebooks").glob("[0-9][0-9]_*.ipynb")):
        if lessons is None or int(path.name[:2]) in lessons:
            notebook = read_json(path, dict)
            name = f"notebooks/{path.name}"
            files[name], cells[name] = read_bytes(path), texts(notebook)
            title = "".join(notebook["cells"][0]["source"]).partition("\n")[0].lstrip("# ")
            titles.append(f"- [{title}]({name})")
    if not files:
        raise BootcourseError(f"{KIT}/notebooks has none of these lessons: install the course as its README says.")
    kit = sorted(path for name in COPIED for path in [KIT / name, *(KIT / name).rglob("*")] if path.is_file())
    kit = [path for path in kit if not {"__pycache__", ".ipynb_checkpoints"} & set(path.parts)]
    files |= {path.relative_to(KIT).as_posix(): read_bytes(path) for path in kit}
    lock = read_bytes(KIT / "student.lock")  # no test and book packages; under the name that its Makefile knows
    files["environment.lock"] = lock.replace(b"student.lock", b"environment.lock")
    files["README.md"] = README.format(
        lessons="\n".join(titles),
        solutions='`check.solution("NAME")` shows a solution.' if solutions else "solutions are closed.",
    ).encode()
    record = Handout(solutions, {name: hashed(data) for name, data in files.items()}, cells)
    return files | {HANDOUT: msgspec.json.format(msgspec.json.encode(record), indent=1)}
