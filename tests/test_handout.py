"""What a lecturer hands out, and how a new version meets what a student wrote in the old one."""

import copy
import json
import re
import zipfile

import nbformat
import pytest

from bootcourse.course import check, edition
from bootcourse.course.classroom import handout
from bootcourse.course.classroom.merge import merge, texts
from bootcourse.errors import BootcourseError
from tools.course.products import notebook


@pytest.fixture(autouse=True)
def small(monkeypatch):
    """A handout of a few files."""
    monkeypatch.setattr(handout, "COPIED", ("LICENSE", "pyproject.toml", "tools/install.sh"))


@pytest.fixture
def folder(tmp_path):
    handout.write(tmp_path / "course", {5, 6}, "2030-05-31", solutions=False)
    return tmp_path / "course"


def test_it_has_the_lessons_a_page_and_no_solution(folder):
    names = {path.relative_to(folder).as_posix() for path in folder.rglob("*") if path.is_file()}
    assert {"README.md", "Makefile", "handout.json", "notebooks/05_the_barrier.ipynb"} <= names
    assert len([name for name in names if name.endswith(".ipynb")]) == 2
    assert not any("solved" in name or "instructor" in name for name in names)
    page = (folder / "README.md").read_text()
    assert "2030-05-31" in page and "The barrier" in page and "bootcourse submit" in page and "{" not in page
    with zipfile.ZipFile(folder.with_name("course.zip")) as file:
        assert {name.removeprefix("course/") for name in file.namelist()} == names


def test_its_makefile_offers_only_what_it_can_do(folder):
    text = (folder / "Makefile").read_text()
    assert "\nlab:" in text and "\n.venv/installed:" in text and "# make lab" in text
    assert "\ntest:" not in text and "# make test" not in text and "\nbook:" not in text
    assert [name for name in re.findall(r"tools/[\w./]+", text) if not (folder / name).exists()] == []


def test_its_lock_is_the_students_under_the_name_that_its_makefile_knows(folder):
    lock = (folder / "environment.lock").read_text()
    assert "-r environment.lock\n" in lock and "\njupyterlab==" in lock and "\npytest==" not in lock


def test_solutions_are_closed_in_it_and_hints_are_not(folder, monkeypatch):
    monkeypatch.chdir(folder / "notebooks")
    with pytest.raises(BootcourseError, match="Solutions are closed"):
        check.solution("luck")
    for _ in range(4):
        given = check.hint("luck")
    assert given.kind == "hint" and "check.solution" not in given.footer


def test_a_lecturer_may_open_them(folder, monkeypatch):
    handout.update(folder, None, "", solutions=True)
    monkeypatch.chdir(folder / "notebooks")
    assert edition.solutions_are_open() and "1 - (1 - once)" in check.solution("luck").data


@pytest.mark.parametrize(
    "how, sentence",
    [(("full", None, ""), "exists already"), (("new", {77}, ""), "none of these lessons"),
     (("new", {5}, "tomorrow"), "such as 2030-05-31")],
)  # fmt: skip
def test_a_wrong_request_gets_one_sentence_and_writes_nothing(tmp_path, how, sentence):
    (tmp_path / "full").mkdir()
    (tmp_path / "full/mine.txt").write_text("mine")
    with pytest.raises(BootcourseError, match=sentence):
        handout.write(tmp_path / how[0], how[1], how[2], False)
    assert not (tmp_path / "new").exists() and len(list((tmp_path / "full").iterdir())) == 1
    with pytest.raises(BootcourseError, match="is no handout"):
        handout.update(tmp_path / "full", None, "", None)


def test_an_update_keeps_what_a_student_wrote_and_says_so(folder):
    path = folder / "notebooks/05_the_barrier.ipynb"
    mine = json.loads(path.read_text())
    stub = next(cell for cell in mine["cells"] if "check.luck(luck)" in "".join(cell["source"]))
    stub["source"] = "def luck(good, decisions, tries):\n    return 1\n\ncheck.luck(luck)"
    path.write_text(json.dumps(mine))
    (folder / "LICENSE").write_text("my own")
    said = handout.update(folder, None, "", None)
    assert "notebooks/05_the_barrier.ipynb: 1 cells of the student's kept, 0 new, 0 changed." in said
    assert any(line.startswith("LICENSE: replaced") for line in said)
    assert (folder / "LICENSE.yours").read_text() == "my own"
    now = json.loads(path.read_text())
    assert stub["source"] in [cell["source"] for cell in now["cells"]] and len(now["cells"]) == len(mine["cells"])
    assert json.loads((folder / "handout.json").read_text())["deadline"] == "2030-05-31"


def test_a_damaged_notebook_is_left_alone(folder):
    path = folder / "notebooks/05_the_barrier.ipynb"
    path.write_text("{")
    assert any("damaged, and left as it is" in line for line in handout.update(folder, None, "", None))
    assert path.read_text() == "{" and json.loads(path.with_suffix(".new.ipynb").read_text())["cells"]


# Cell by cell ---------------------------------------------------------------------------------------


def made(*sources: str) -> dict:
    cells = [nbformat.v4.new_code_cell(source, execution_count=None) for source in sources]
    return json.loads(nbformat.writes(notebook(cells)))


def sources(found: dict) -> list[str]:
    return ["".join(cell["source"]) for cell in found["cells"]]


STUB, MINE = "def f():\n    ...\n\ncheck.f(f)", "def f():\n    return 1\n\ncheck.f(f)"


def changed(base: dict, old: str, new: str) -> dict:
    """A student's copy in which one cell's text is another."""
    mine = copy.deepcopy(base)
    cell = next(cell for cell in mine["cells"] if "".join(cell["source"]) == old)
    cell["source"], cell["outputs"] = new, [{"output_type": "stream", "name": "stdout", "text": "mine"}]
    return mine


def test_new_cells_come_and_the_student_s_stay_with_their_outputs():
    base, new = made("import a", STUB, "show()"), made("import a", "import b", STUB, "look()")
    merged = merge(changed(base, STUB, MINE), texts(base), new)
    assert sources(merged.notebook) == ["import a", "import b", MINE, "look()"]
    assert merged.notebook["cells"][2]["outputs"] and (merged.kept, merged.new, merged.both) == (1, 2, ())


def test_an_exercise_that_both_have_changed_stays_the_student_s_and_is_named():
    other = STUB.replace("def f():", "def f():\n    'Docstring.'")
    merged = merge(changed(made(STUB), STUB, MINE), texts(made(STUB)), made(other))
    assert sources(merged.notebook) == [MINE] and merged.both == ("def f():",) and "def f():" in str(merged)


def test_a_student_s_own_cell_stays_behind_what_stood_before_it():
    base = made("one", "two", "three")
    mine = copy.deepcopy(base)
    mine["cells"].insert(2, {"id": "own", "cell_type": "code", "source": "own", "outputs": [], "metadata": {}})
    assert sources(merge(mine, texts(base), made("zero", "one", "two", "three")).notebook) == [
        "zero", "one", "two", "own", "three"]  # fmt: skip


def test_a_changed_cell_that_the_lesson_no_longer_has_stays_and_an_unchanged_one_goes():
    base = made("one", "two", "three")
    merged = merge(changed(base, "two", "two, mine"), texts(base), made("one"))
    assert sources(merged.notebook) == ["one", "two, mine"]


def test_a_deleted_cell_stays_deleted_and_outputs_of_unchanged_cells_stay():
    base = made("one", "two")
    mine = changed(base, "one", "one")
    del mine["cells"][1]
    merged = merge(mine, texts(base), made("one", "two", "three"))
    assert sources(merged.notebook) == ["one", "three"] and merged.notebook["cells"][0]["outputs"]


def test_a_notebook_whose_editor_dropped_the_ids_keeps_every_line_of_the_student_s():
    base = made("one", STUB)
    mine = changed(base, STUB, MINE)
    for cell in mine["cells"]:
        del cell["id"]
    assert MINE in sources(merge(mine, texts(base), made("one", STUB, "two")).notebook)
