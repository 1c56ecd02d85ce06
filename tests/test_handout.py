"""What a lecturer hands out, and how a new version meets what a student wrote in the old one."""

import copy
import json
import zipfile

import nbformat
import pytest

from bootcourse.course import check, edition
from bootcourse.course.classroom import handout
from bootcourse.course.classroom.merge import merge, texts
from bootcourse.course.lessons import number, stem
from bootcourse.errors import BootcourseError

NAME = f"notebooks/{stem('the_barrier')}.ipynb"


@pytest.fixture(autouse=True)
def small(monkeypatch):
    """A handout of a few files."""
    monkeypatch.setattr(handout, "COPIED", ("LICENSE", "Makefile", "pyproject.toml", "tools/install.sh"))


@pytest.fixture
def folder(tmp_path):
    handout.write(tmp_path / "course", {number("the_barrier"), number("demonstrations")}, solutions=False)
    return tmp_path / "course"


def test_it_has_the_lessons_a_page_and_no_solution(folder):
    names = {path.relative_to(folder).as_posix() for path in folder.rglob("*") if path.is_file()}
    assert {"README.md", "Makefile", "handout.json", NAME} <= names
    assert len([name for name in names if name.endswith(".ipynb")]) == 2
    assert not any("solved" in name or "instructor" in name for name in names)
    page = (folder / "README.md").read_text()
    assert "The barrier" in page and "bootcourse submit" in page and "{" not in page
    with zipfile.ZipFile(folder.with_name("course.zip")) as file:
        assert {name.removeprefix("course/") for name in file.namelist() if name[-1] != "/"} == names


def test_its_lock_holds_only_what_a_student_needs(folder):
    lock = (folder / "environment.lock").read_text()
    assert "-r environment.lock\n" in lock and "\njupyterlab==" in lock and "\npytest==" not in lock


def test_solutions_are_closed_in_it_until_the_lecturer_opens_them_and_hints_are_not(folder, monkeypatch):
    monkeypatch.chdir(folder / "notebooks")
    with pytest.raises(BootcourseError, match="Solutions are closed"):
        check.solution("luck")
    assert check.hint("luck").kind == "hint"
    handout.update(folder, None, solutions=True)
    assert edition.solutions_are_open() and "1 - (1 - once)" in check.solution("luck").data


@pytest.mark.parametrize(
    "how, sentence",
    [(("full", None), "exists already"), (("new", {77}), "none of these lessons")],
)
def test_a_wrong_request_gets_one_sentence_and_writes_nothing(tmp_path, how, sentence):
    (tmp_path / "full").mkdir()
    (tmp_path / "full/mine.txt").write_text("mine")
    with pytest.raises(BootcourseError, match=sentence):
        handout.write(tmp_path / how[0], how[1], False)
    assert not (tmp_path / "new").exists() and len(list((tmp_path / "full").iterdir())) == 1
    with pytest.raises(BootcourseError, match="is no handout"):
        handout.update(tmp_path / "full", None, None)


def test_an_update_keeps_what_a_student_wrote_and_says_so(folder):
    mine = json.loads((folder / NAME).read_text())
    stub = next(cell for cell in mine["cells"] if "check.luck(luck)" in "".join(cell["source"]))
    stub["source"] = "def luck(good, decisions, tries):\n    return 1\n\ncheck.luck(luck)"
    (folder / NAME).write_text(json.dumps(mine))
    (folder / "LICENSE").write_text("my own")
    said = handout.update(folder, None, None)
    assert f"{NAME}: 1 cells of the student's kept." in said
    assert any(line.startswith("LICENSE: replaced") for line in said)
    assert (folder / "LICENSE.yours").read_text() == "my own"
    now = json.loads((folder / NAME).read_text())
    assert stub["source"] in [cell["source"] for cell in now["cells"]] and len(now["cells"]) == len(mine["cells"])


def test_what_an_update_puts_aside_is_not_replaced_by_the_next(folder):
    for text in ("my own", "my second", "my own"):
        (folder / "LICENSE").write_text(text)
        handout.update(folder, None, None)
    kept = sorted((path.name, path.read_text()) for path in folder.glob("LICENSE*yours"))
    assert {text for _, text in kept} == {"my own", "my second"} and len(kept) == 2


@pytest.mark.parametrize("record", ["{}", "[]", "5", "{", '{"format": "bootcourse handout 2"}'])
def test_a_damaged_record_is_one_sentence(folder, record, monkeypatch):
    (folder / "handout.json").write_text(record)
    with pytest.raises(BootcourseError, match="handout.json"):
        handout.update(folder, None, None)


@pytest.mark.parametrize("damaged", ["{", "[]", '{"cells": 3}', '{"cells": [3]}'])
def test_a_damaged_notebook_is_left_alone(folder, damaged):
    (folder / NAME).write_text(damaged)
    assert any("damaged, and left as it is" in line for line in handout.update(folder, None, None))
    new = folder / NAME.replace(".ipynb", ".new.ipynb")
    assert (folder / NAME).read_text() == damaged and json.loads(new.read_text())["cells"]


# Cell by cell ---------------------------------------------------------------------------------------

STUB, MINE = "def f():\n    ...\n\ncheck.f(f)", "def f():\n    return 1\n\ncheck.f(f)"


def notebook(*sources: str) -> dict:
    cells = [nbformat.v4.new_code_cell(source, id=source[:3].strip()) for source in sources]
    return json.loads(nbformat.writes(nbformat.v4.new_notebook(cells=cells)))


def by_student(base: dict, changes: dict[str, str]) -> dict:
    """A student's copy: {a cell's text: the text that it has now}, and every cell was run."""
    mine = copy.deepcopy(base)
    for cell in mine["cells"]:
        cell["source"] = changes.get("".join(cell["source"]), cell["source"])
        cell["outputs"] = [{"output_type": "stream", "name": "stdout", "text": "mine"}]
    return mine


def without_ids(base: dict) -> dict:
    return base | {"cells": [{key: cell[key] for key in cell if key != "id"} for cell in base["cells"]]}


def with_own_cell(base: dict, name: str = "own") -> dict:
    own = {"id": name, "cell_type": "code", "source": "own", "outputs": [], "metadata": {}}
    return base | {"cells": [*base["cells"][:2], own, *base["cells"][2:]]}


OLD = notebook("one", "two", STUB)
CHANGED_STUB = STUB.replace("def f():", "def f():\n    'Docstring.'")
MERGES = {
    "new cells come and the student's stay": (
        by_student(OLD, {STUB: MINE}), ["zero", "one", STUB], ["zero", "one", MINE]
    ),
    "both changed a cell: the student's stays": (by_student(OLD, {STUB: MINE}), [CHANGED_STUB], [MINE]),
    "an own cell stays behind what stood before it": (
        with_own_cell(OLD), ["zero", "one", "two", STUB], ["zero", "one", "two", "own", STUB]
    ),
    "of cells that the lesson no longer has, those that were changed stay": (
        by_student(OLD, {"two": "two, mine"}), ["one"], ["one", "two, mine"]
    ),
    "two cells have one id: both stay": (
        with_own_cell(by_student(OLD, {STUB: MINE}), "def"), ["one", STUB], ["one", "own", MINE]
    ),
    "an editor dropped the ids: every line of the student's stays": (
        without_ids(by_student(OLD, {STUB: MINE})), ["one", STUB], ["one", MINE, STUB]
    ),
}  # fmt: skip


@pytest.mark.parametrize("case", MERGES)
def test_an_update_merges_cell_by_cell(case):
    mine, new, expected = MERGES[case]
    assert ["".join(cell["source"]) for cell in merge(mine, texts(OLD), notebook(*new))[0]["cells"]] == expected


def test_cells_that_did_not_change_keep_their_outputs_and_what_both_changed_is_named():
    merged, said = merge(by_student(OLD, {STUB: MINE}), texts(OLD), notebook("one", "new", CHANGED_STUB))
    assert [bool(cell["outputs"]) for cell in merged["cells"]] == [True, False, True]
    assert said == "1 cells of the student's kept; changed in the lesson, too, and kept: “def f():”."
