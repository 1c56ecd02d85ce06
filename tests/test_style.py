"""Ruff, over every file of the course and every cell of its notebooks; and which room imports from which."""

import ast
import re
import subprocess
import sys
from pathlib import Path

import pytest

ROOT = Path(__file__).resolve().parent.parent


def ruff(*arguments: str) -> subprocess.CompletedProcess:
    return subprocess.run([sys.executable, "-m", "ruff", *arguments], cwd=ROOT, capture_output=True, text=True)


def test_ruff_has_nothing_to_say():
    result = ruff("check", ".")
    assert result.returncode == 0, f"`ruff check --fix` mends some of this:\n{result.stdout}{result.stderr}"


def test_every_file_is_formatted():
    result = ruff("format", "--check", ".")
    assert result.returncode == 0, f"run `ruff format`:\n{result.stdout}{result.stderr}"


def test_the_code_of_the_lessons_texts_is_formatted_for_a_notebook_s_narrow_cells():
    texts = sorted(map(str, ROOT.glob("bootcourse/course/lessons/*/text.py")))
    result = ruff("format", "--check", "--line-length=100", "--config=format.exclude=[]", *texts)
    assert result.returncode == 0 and f"{len(texts)} files already" in result.stdout, result.stdout + result.stderr


def named(path: Path) -> set[str]:
    """The modules of this package that a file imports or names in its words, wherever in it."""
    nodes = list(ast.walk(ast.parse(path.read_text(encoding="utf-8"))))
    names = {alias.name for node in nodes if isinstance(node, ast.Import) for alias in node.names}
    froms = [node for node in nodes if isinstance(node, ast.ImportFrom)]
    names |= {f"{node.module}.{alias.name}" for node in froms for alias in node.names}
    texts = [node.value for node in nodes if isinstance(node, ast.Constant) and isinstance(node.value, str)]
    return names | {name for text in texts for name in re.findall(r"\bbootcourse(?:\.\w+)+", text)}


CLOSED = {"research": ("bootcourse.course",), "course": ()}  # of the other parts of the package: both


def test_no_room_names_one_behind_it():
    room = ROOT / "bootcourse"
    for path in room.rglob("*.py"):
        closed = CLOSED.get(path.relative_to(room).parts[0], ("bootcourse.course", "bootcourse.research"))
        assert [name for name in named(path) if name.startswith(closed)] == [], path


@pytest.mark.parametrize("text", ["import bootcourse.course.check", 'place = "bootcourse.course.shipped:board"'])
def test_a_name_in_an_import_or_in_a_text_is_found(text, tmp_path):
    (tmp_path / "some.py").write_text(text)
    assert [name for name in named(tmp_path / "some.py") if name.startswith("bootcourse.course")]
