"""What a lecturer hands out: some lessons with the kit that they need, a lock and one page.

Solved notebooks and the instructor's pages stay behind, and `check.solution` shows nothing unless the lecturer opens
it. The kit itself holds right answers, because the checks compare with them: `HOLDS_SOLUTIONS` says so wherever a
handout is written or read.
`handout.json` says which files were handed out, so that an update knows what a student has changed.
"""

import hashlib
import os
import re
import shutil
import tempfile
from pathlib import Path
from typing import ClassVar

import msgspec
from msgspec import Struct

import bootcourse
from bootcourse.course.edition import HANDOUT
from bootcourse.course.lessons import LESSONS, number
from bootcourse.errors import BootcourseError
from bootcourse.files import TEMPORARY, read_bytes, read_json, unix_lines, write_bytes

KIT = Path(bootcourse.__file__).resolve().parent.parent
COPIED = ("bootcourse", "assets", "tools/install.sh", "pyproject.toml", "Makefile", "LICENSE", ".gitattributes")
KEPT_BACK = ("text.py", "numbers.py", "answers.py")  # of a lesson: solutions, and what its makers use


HOLDS_SOLUTIONS = "The checks are part of the kit and hold right answers: they stand in `bootcourse/course/lessons`."


class Handout(Struct):
    """The content of `handout.json`."""

    FORMAT: ClassVar[str] = "bootcourse handout 3"

    solutions: bool  # may `check.solution` show them?
    files: dict[str, str]  # name -> `hashed`
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
{solutions} {holds} Write your own first, and look there afterwards. Your predictions are kept in `notebooks/answers`.

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
    parts, parent = content(lessons, solutions), archive.parent
    parent.mkdir(parents=True, exist_ok=True)
    with tempfile.TemporaryDirectory(dir=parent, prefix=".", suffix=TEMPORARY) as whole:
        new = Path(whole, archive.stem)
        for name, data in parts.items():
            write_bytes(new / name, data)
        zipped = shutil.make_archive(str(Path(whole, "zipped")), "zip", whole, new.name)
        folder.mkdir(exist_ok=True)
        for part in new.iterdir():
            os.replace(part, folder / part.name)
        os.replace(zipped, archive)
    count = sum(name.endswith(".ipynb") for name in parts)
    return [f"{folder}: {count} lessons.", f"{archive}: {archive.stat().st_size / 1e6:.0f} MB.", HOLDS_SOLUTIONS]


def update(folder: Path, lessons: set[int] | None, solutions: bool | None) -> list[str]:
    """Bring a handout up to date. Returns what was done, a sentence a file. Raises BootcourseError if it is none.

    A file that a student changed stays as it is; the new version is written beside it. Without lessons, they stay as
    they are.
    """
    if not (folder / HANDOUT).is_file():
        raise BootcourseError(f"{folder} is no handout: it has no {HANDOUT}. Leave out --update to write a new one.")
    old = read_json(folder / HANDOUT, Handout, "restore it from the handout's zip file")
    before = {Path(name).stem.partition("_")[2] for name in old.files}  # notebooks/05_the_barrier.ipynb -> the_barrier
    parts = content(
        lessons or {number(lesson) for lesson in before if lesson in LESSONS},
        old.solutions if solutions is None else solutions,
    )
    said = []
    for name, data in parts.items():
        path = folder / name
        mine = read_bytes(path) if path.exists() else None
        if mine not in (None, data) and name != HANDOUT and hashed(mine) != old.files.get(name):
            path = path.with_name(f"{path.stem}.new-{hashed(data)[:6]}{path.suffix}")
            said.append(f"{name}: yours stays; the new version is {path.name}.")
            if path.exists():  # from an update before, and perhaps worked in since
                continue
        elif mine is None and path.suffix == ".ipynb":
            said.append(f"{name}: new.")
        write_bytes(path, data)
    return said


def hashed(data: bytes) -> str:
    """Of a text the same on every system: a student's Git may have changed how its lines end."""
    return hashlib.sha256(unix_lines(data)).hexdigest()[:16]


def was_worked_in(cells: list[dict]) -> bool:
    """Does a lesson's notebook hold an answer, or a widget, which only who runs a cell sees?"""
    of_exercises = [text for text in map(source, cells) if re.search(r"^check\.(\w+)\(\1\)$", text, re.MULTILINE)]
    blank = all(re.search(r"^ +\.\.\.$", text, re.MULTILINE) for text in of_exercises if "def " in text)
    shown = [mime for cell in cells for output in cell.get("outputs", []) for mime in output.get("data", {})]
    return not blank or "application/vnd.jupyter.widget-view+json" in shown


def source(cell: dict) -> str:
    """What stands in a cell."""
    return "".join(cell["source"])


def content(lessons: set[int] | None, solutions: bool) -> dict[str, bytes]:
    """{name: data} of every file of a handout.

    Raises BootcourseError where the notebooks are not installed, and for one in which somebody has worked.
    """
    files, titles = {}, []
    for path in sorted((KIT / "notebooks").glob("[0-9][0-9]_*.ipynb")):
        if lessons is None or int(path.name[:2]) in lessons:
            name = f"notebooks/{path.name}"
            files[name] = read_bytes(path)
            cells = read_json(path, dict)["cells"]
            if was_worked_in(cells):
                raise BootcourseError(
                    f"{name} holds somebody's work, perhaps right answers: hand out from a fresh clone, or keep "
                    f"a copy of it and put the lesson back with `git restore {name}`."
                )
            title = source(cells[0]).partition("\n")[0].lstrip("# ")
            titles.append(f"- [{title}]({name})")
    if not files:
        raise BootcourseError(f"{KIT}/notebooks has none of these lessons: install the course as its README says.")
    kit = sorted(path for name in COPIED for path in [KIT / name, *(KIT / name).rglob("*")] if path.is_file())
    kit = [path for path in kit if not {"__pycache__", ".ipynb_checkpoints"} & set(path.parts)]
    kit = [path for path in kit if not (path.name in KEPT_BACK and path.parent.parent.name == "lessons")]
    files |= {path.relative_to(KIT).as_posix(): unix_lines(read_bytes(path)) for path in kit}
    lock = read_bytes(KIT / "student.lock")  # no test and book packages; under the name that its Makefile knows
    files["environment.lock"] = lock.replace(b"student.lock", b"environment.lock")
    files["README.md"] = README.format(
        lessons="\n".join(titles),
        solutions='`check.solution("NAME")` shows a solution.' if solutions else "solutions are closed.",
        holds=HOLDS_SOLUTIONS,
    ).encode()
    record = Handout(solutions, {name: hashed(data) for name, data in files.items()})
    return files | {HANDOUT: msgspec.json.format(msgspec.json.encode(record), indent=1)}
