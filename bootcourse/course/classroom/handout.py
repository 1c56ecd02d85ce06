"""What a lecturer hands out: some lessons with the kit that they need, a lock and one page, and no solutions in reach.

`handout.json` says which files and cells were handed out, so that an update knows what a student has changed.
"""

import io
import itertools
import json
import re
import zipfile
from datetime import date
from pathlib import Path
from typing import ClassVar

import msgspec
from msgspec import Struct

import bootcourse
from bootcourse.course.classroom.merge import hashed, merge, texts
from bootcourse.course.classroom.submission import MADE_WITH, fingerprint
from bootcourse.course.edition import HANDOUT
from bootcourse.course.lessons import LESSONS, number
from bootcourse.errors import BootcourseError
from bootcourse.files import check_own, read_bytes, read_json, write_bytes

KIT = Path(bootcourse.__file__).resolve().parent.parent
COPIED = ("bootcourse", "assets", "tools/install.sh", "pyproject.toml", "LICENSE")
TARGETS = ("lab", "doctor", "clean")  # of the Makefile; the others need what is not handed out


class Handout(Struct):
    """The content of `handout.json`."""

    FORMAT: ClassVar[str] = "bootcourse handout 2"

    deadline: str  # as 2030-05-31, or ""
    solutions: bool  # may `check.solution` show them?
    files: dict[str, str]  # name -> `hashed`
    cells: dict[str, dict[str, str]]  # notebook -> `texts`; its lesson's number may be another one by now
    format: str = FORMAT


README = """# Lessons to work in

{deadline}**To begin**, open a terminal in this folder and type `make lab` (Python 3.11 or newer; it takes a few minutes
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


def write(folder: Path, lessons: set[int] | None, deadline: str, solutions: bool) -> list[str]:
    """Write a new handout as a folder and a zip file. Returns what was done. Raises BootcourseError.

    The folder must not exist, or be empty. deadline: "" or a date as 2030-05-31.
    """
    if folder.exists() and (not folder.is_dir() or any(folder.iterdir())):
        raise BootcourseError(f"{folder} exists already: choose another folder, or bring it up to date with --update.")
    check_own(*zip_of(folder))
    parts = content(lessons, checked(deadline), solutions)
    for name, data in parts.items():
        write_bytes(folder / name, data)
    lessons = [name for name in parts if name.endswith(".ipynb")]
    return [f"{folder}: {len(lessons)} lessons.", zipped(folder, parts)]


def update(folder: Path, lessons: set[int] | None, deadline: str, solutions: bool | None) -> list[str]:
    """Bring a handout up to date. Returns what was done, a sentence a file. Raises BootcourseError if it is none.

    What a student wrote in a notebook stays; another file that was changed is kept as NAME.yours. Without lessons or
    a deadline, they stay as they are.
    """
    if not (folder / HANDOUT).is_file():
        raise BootcourseError(f"{folder} is no handout: it has no {HANDOUT}. Leave out --update to write a new one.")
    old = read_json(folder / HANDOUT, Handout, "restore it from the handout's zip file")
    check_own(*zip_of(folder))
    before = {lesson_of(name): name for name in old.cells}
    lessons = lessons or {number(lesson) for lesson in before if lesson in LESSONS}
    solutions = old.solutions if solutions is None else solutions
    parts, said = content(lessons, checked(deadline) or old.deadline, solutions), []
    for name, data in parts.items():
        was = before.get(lesson_of(name), name) if name.endswith(".ipynb") else name
        if was != name and (folder / was).is_file() and not (folder / name).exists():
            (folder / was).rename(folder / name)
            said.append(f"{was}: it is {name} now.")
        old.files[name], old.cells[name] = old.files.get(was, ""), old.cells.get(was, {})
        said += place(folder / name, name, data, old)
    return [*said, zipped(folder, parts)]


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
            merged = merge(read_json(path, dict), old.cells.get(name, {}), json.loads(data))
        except (BootcourseError, KeyError, TypeError, AttributeError):
            new = spare(path.with_suffix(".new.ipynb"), data)
            return [f"{name}: damaged, and left as it is; the new version is {new}."]
        write_bytes(path, dumped(merged.notebook))
        return [f"{name}: {merged}"]
    yours = spare(path.with_name(f"{path.name}.yours"), mine)
    write_bytes(path, data)
    return [f"{name}: replaced; the one that was here is {yours}."]


def spare(path: Path, data: bytes) -> str:
    """Write to this file, or beside it if it holds something else. Returns the file's name."""
    free = (path.with_stem(f"{path.stem}-{count}") if count > 1 else path for count in itertools.count(1))
    path = next(each for each in free if not each.exists() or each.is_file() and read_bytes(each) == data)
    write_bytes(path, data)
    return path.name


def lesson_of(name: str) -> str:
    """notebooks/05_the_barrier.ipynb -> the_barrier"""
    return Path(name).stem.partition("_")[2]


def content(lessons: set[int] | None, deadline: str, solutions: bool) -> dict[str, bytes]:
    """{name: data} of every file of a handout. Raises BootcourseError where the notebooks are not installed."""
    files, cells, titles = {}, {}, []
    for path in sorted((KIT / "notebooks").glob("[0-9][0-9]_*.ipynb")):
        if lessons is None or int(path.name[:2]) in lessons:
            notebook = read_json(path, dict)
            notebook["metadata"][MADE_WITH] = fingerprint()
            name = f"notebooks/{path.name}"
            files[name], cells[name] = dumped(notebook), texts(notebook)
            titles.append(f"- [{title_of(notebook)}]({name})")
    if not files:
        raise BootcourseError(f"{KIT}/notebooks has none of these lessons: install the course as its README says.")
    kit = sorted(path for name in COPIED for path in [KIT / name, *(KIT / name).rglob("*")] if path.is_file())
    kit = [path for path in kit if not {"__pycache__", ".ipynb_checkpoints"} & set(path.parts)]
    files |= {path.relative_to(KIT).as_posix(): read_bytes(path) for path in kit}
    lock = read_bytes(KIT / "student.lock")  # no test and book packages; under the name that its Makefile knows
    files["environment.lock"] = lock.replace(b"student.lock", b"environment.lock")
    files["Makefile"] = makefile((KIT / "Makefile").read_text(encoding="utf-8")).encode()
    files["README.md"] = README.format(
        deadline=f"**Deadline:** {deadline}\n\n" if deadline else "",
        lessons="\n".join(titles),
        solutions='`check.solution("NAME")` shows a solution.' if solutions else "solutions are closed.",
    ).encode()
    record = Handout(
        deadline=deadline, solutions=solutions,
        files={name: hashed(data) for name, data in files.items()}, cells=cells,
    )  # fmt: skip
    return files | {HANDOUT: msgspec.json.format(msgspec.json.encode(record), indent=1)}


def dumped(notebook: dict) -> bytes:
    return (json.dumps(notebook, indent=1, ensure_ascii=False) + "\n").encode("utf-8", "replace")


def title_of(notebook: dict) -> str:
    text = "".join("".join(cell["source"]) + "\n" for cell in notebook["cells"] if cell["cell_type"] == "markdown")
    return re.search(r"^# (.+)", text, re.M)[1]


def checked(deadline: str) -> str:
    """A date as 2030-05-31, or "". Raises BootcourseError for anything else."""
    try:
        return deadline and date.fromisoformat(deadline).isoformat()
    except ValueError:
        raise BootcourseError(f"--deadline {deadline}: give a date, such as 2030-05-31.") from None


def makefile(text: str) -> str:
    """The paragraphs of the Makefile that a handout can do, and of its first one the lines about them."""
    targets = re.findall(r"^([a-z]+):", text, re.M)
    gone = [target for target in targets if target not in (*TARGETS, "help")]
    head, *paragraphs = text.split("\n\n")
    head = "\n".join(line for line in head.splitlines() if not re.match(rf"# make ({'|'.join(gone)})\b", line))
    possible = [part for part in paragraphs if not re.search(rf"^({'|'.join(gone)}|\.venv/bench):", part, re.M)]
    return "\n\n".join([head, *possible]).rstrip() + "\n"


def zip_of(folder: Path) -> tuple[Path, str]:
    """The zip file of a handout, and what stands in it."""
    folder = folder.resolve()
    return folder.parent / f"{folder.name}.zip", f"{folder.name}/{HANDOUT}"


def zipped(folder: Path, parts: dict[str, bytes]) -> str:
    """Write what is handed out as FOLDER.zip beside the folder: nothing that a student wrote is in it."""
    folder, data = folder.resolve(), io.BytesIO()
    with zipfile.ZipFile(data, "w", zipfile.ZIP_DEFLATED) as file:
        for name, part in parts.items():
            file.writestr(f"{folder.name}/{name}", part)
    path = zip_of(folder)[0]
    write_bytes(path, data.getvalue())
    return f"{path}: {path.stat().st_size / 1e6:.0f} MB."
