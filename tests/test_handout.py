"""What a lecturer hands out, and how a new version meets what a student wrote in the old one."""

import zipfile

import pytest

from bootcourse.course import check, edition
from bootcourse.course.classroom import handout
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
