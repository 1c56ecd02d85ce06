"""What a lecturer hands out, and how a new version meets what a student wrote in the old one."""

import ast
import json
import re
import zipfile
from pathlib import Path

import pytest

from bootcourse.course import check, edition
from bootcourse.course.classroom import handout
from bootcourse.course.exercise import source_of
from bootcourse.course.lessons import number, registry, stem
from bootcourse.errors import BootcourseError

NAME = f"notebooks/{stem('the_barrier')}.ipynb"


@pytest.fixture
def small(monkeypatch):
    """A handout of a few files."""
    monkeypatch.setattr(handout, "COPIED", ("LICENSE", "Makefile", "pyproject.toml", "tools/install.sh"))


@pytest.fixture
def folder(tmp_path, small):
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


def test_solutions_are_closed_in_it_until_the_lecturer_opens_them_and_hints_are_not(folder, monkeypatch):
    monkeypatch.chdir(folder / "notebooks")
    with pytest.raises(BootcourseError, match="Solutions are closed"):
        check.solution("luck")
    assert check.hint("luck").kind == "hint"
    handout.update(folder, None, solutions=True)
    assert edition.solutions_are_open() and "1 - (1 - once)" in check.solution("luck").data


@pytest.mark.parametrize(
    "work",
    [
        lambda cell: cell.update(
            source=cell["source"].replace("    ...\n", "    return 1 - (1 - good / 9) ** tries\n")
        ),
        lambda cell: cell.update(
            outputs=[{"data": {"application/vnd.jupyter.widget-view+json": {}, "text/plain": "3"}}]
        ),
    ],
)
def test_a_lesson_in_which_the_lecturer_has_worked_is_not_handed_out(tmp_path, small, monkeypatch, work):
    (tmp_path / "kit/notebooks").mkdir(parents=True)
    path = tmp_path / "kit" / NAME
    lesson = json.loads((handout.KIT / NAME).read_text())
    (exercise,) = [cell for cell in lesson["cells"] if "def luck" in handout.source(cell)]
    exercise["source"] = handout.source(exercise)
    work(exercise)
    path.write_text(json.dumps(lesson))
    monkeypatch.setattr(handout, "KIT", tmp_path / "kit")
    with pytest.raises(BootcourseError, match=f"git restore {NAME}"):
        handout.write(tmp_path / "course", None, False)
    assert not (tmp_path / "course").exists()


@pytest.mark.parametrize(
    "how, sentence",
    [(("full", None), "exists already"), (("new", {77}), "none of these lessons")],
)
def test_a_wrong_request_gets_one_sentence_and_writes_nothing(tmp_path, small, how, sentence):
    (tmp_path / "full").mkdir()
    (tmp_path / "full/mine.txt").write_text("mine")
    with pytest.raises(BootcourseError, match=sentence):
        handout.write(tmp_path / how[0], how[1], False)
    assert not (tmp_path / "new").exists() and len(list((tmp_path / "full").iterdir())) == 1
    with pytest.raises(BootcourseError, match="is no handout"):
        handout.update(tmp_path / "full", None, None)


def test_an_update_replaces_what_nobody_changed_and_writes_the_new_version_beside_the_student_s(folder, monkeypatch):
    (folder / NAME).write_text("mine")
    content = handout.content

    def changed(*arguments):
        return {name: data + b"\n" for name, data in content(*arguments).items()}

    monkeypatch.setattr(handout, "content", changed)
    (said,) = handout.update(folder, None, None)
    new = folder / "notebooks" / said.partition("the new version is ")[2].rstrip(".")
    assert (folder / NAME).read_text() == "mine" and new.stem.startswith(f"{stem('the_barrier')}.new-")
    assert (folder / "LICENSE").read_bytes() == changed({number("the_barrier")}, False)["LICENSE"]
    new.write_text("mine, too")
    handout.update(folder, None, None)
    assert new.read_text() == "mine, too"


def test_a_file_whose_line_endings_alone_were_changed_is_not_the_students_own(folder):
    (folder / "LICENSE").write_bytes((folder / "LICENSE").read_bytes().replace(b"\n", b"\r\n"))
    assert handout.update(folder, None, None) == [] and b"\r" not in (folder / "LICENSE").read_bytes()


# A whole one --------------------------------------------------------------------------------------


@pytest.fixture(scope="module")
def whole(tmp_path_factory) -> tuple[Path, list[str]]:
    """A handout of all lessons as a lecturer writes it: its folder, and what the command said."""
    folder = tmp_path_factory.mktemp("whole") / "course"
    return folder, handout.write(folder, None, solutions=False)


def squeezed(text: str) -> str:
    return re.sub(r"\s+", "", text)


def body_of(solution) -> str:
    """The statements of a solution, without its docstring."""
    node = ast.parse(source_of(solution)).body[0]
    statements = node.body[ast.get_docstring(node) is not None :]
    return squeezed("\n".join(map(ast.unparse, statements)))


def code_of(path: Path) -> list[str]:
    """The code of a notebook's cells, as `squeezed`."""
    cells = json.loads(path.read_text(encoding="utf-8"))["cells"]
    texts = ["".join(cell["source"]) for cell in cells if cell["cell_type"] == "code"]
    return [squeezed(ast.unparse(ast.parse(re.sub(r"^\s*[%!].*$", "", text, flags=re.M)))) for text in texts]


def test_what_students_open_holds_no_solution_and_says_where_the_kit_does(whole):
    folder, said = whole
    names = {path.relative_to(folder).as_posix() for path in folder.rglob("*") if path.is_file()}
    assert {name.partition("/")[0] for name in names if "/" in name} == {"bootcourse", "assets", "notebooks", "tools"}
    kept_back = r"solved|instructor|(^|/)tests/|lessons/\w+/(text|numbers|answers)\.py$"
    assert not [name for name in names if re.search(kept_back, name)]
    for path in (folder / "notebooks").glob("*.ipynb"):
        code = code_of(path)
        for exercise in (each for each in registry().values() if each.lesson == path.stem):
            assert not [text for text in code if body_of(exercise.solution) in text], exercise.name
    in_the_kit = (folder / "bootcourse/course/lessons/the_barrier/exercises.py").read_text()
    assert "def luck" in in_the_kit, "so the sentence is true"
    assert handout.HOLDS_SOLUTIONS in said and handout.HOLDS_SOLUTIONS in (folder / "README.md").read_text()
    for page in ("README.md", "book/teaching/classroom.md"):
        text = " ".join((handout.KIT / page).read_text(encoding="utf-8").split())
        assert "no solutions" not in text and "right answers" in text, page
