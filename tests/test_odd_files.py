"""Files as other programs write them: notebooks with huge or odd outputs, other encodings, names of no Unicode."""

import json
import os
from pathlib import Path

import pytest

from bootcourse.course.classroom import answers
from bootcourse.course.classroom.submission import Submission, collect, from_notebooks
from bootcourse.course.predictions import Question, commit, predictions
from bootcourse.errors import BootcourseError
from bootcourse.files import read_json, write_json
from tests.test_classroom import NAME, RIGHT, cell, notebook

SAYS_RIGHT = {
    "output_type": "display_data",
    "data": {"text/plain": ["✓ Right."], "image/png": "A" * 1000},
    "metadata": {},
}


def written(outputs=(), more: str = "") -> str:
    """A notebook with a right answer, its check, and these outputs."""
    cells = [cell(RIGHT), cell(f"check.{NAME}({NAME}){more}") | {"outputs": [SAYS_RIGHT, *outputs]}]
    return json.dumps(notebook(*cells), ensure_ascii=False)


NAN = {"output_type": "execute_result", "data": {"application/json": {"loss": float("nan"), "most": float("-inf")}}}
PRINTED = written([{"output_type": "stream", "text": "@"}])
FORMS = {
    "as Jupyter saves it": written().encode(),
    "with a byte order mark": written().encode("utf-8-sig"),
    "in UTF-16": written().encode("utf-16"),
    "in UTF-16 without a mark": written().encode("utf-16-le"),
    "with NaN in an output": written([NAN]).encode(),
    "with half a letter in an output": PRINTED.replace("@", "\ud83d").encode("utf-8", "surrogatepass"),
    "with half a letter, escaped": PRINTED.replace("@", r"\ud83d").encode(),
    "with half a letter in a comment": written(more="  # \ud83d").encode("utf-8", "surrogatepass"),
    "with an output in Latin-1": PRINTED.replace("@", "é").encode("latin-1", "replace"),
    "with outputs of no known kind": written([{"data": [1, 2]}]).encode(),
}


def answered(folder: Path, data: bytes) -> Submission:
    (folder / "05_the_barrier.ipynb").write_bytes(data)
    read = from_notebooks(folder)
    assert read.problems == () and read.answers[NAME].strip() == RIGHT.strip()
    return read


@pytest.mark.parametrize("form", FORMS)
def test_an_answer_is_read_whatever_the_outputs_and_the_encoding_are(form, tmp_path):
    right = answered(tmp_path, FORMS[form]).right
    assert right == (() if form in ("with outputs of no known kind", "with an output in Latin-1") else (NAME,))


def test_an_answer_is_read_beside_40_megabytes_of_output(tmp_path):
    assert answered(tmp_path, PRINTED.replace("@", "x" * 40_000_000).encode()).right == (NAME,)


def test_a_notebook_that_is_too_large_is_refused_with_the_remedy_that_helps(tmp_path, monkeypatch):
    monkeypatch.setattr(answers, "LARGEST", 1000)
    (tmp_path / "05_the_barrier.ipynb").write_bytes(FORMS["as Jupyter saves it"])
    (problem,) = from_notebooks(tmp_path).problems
    assert "at most 1,000 are read: clear the outputs of all its cells, and save it again." in problem


@pytest.mark.parametrize("who", ["student", "lecturer"])
def test_a_damaged_notebook_has_a_remedy_for_who_reads_it(who, tmp_path, bootcourse):
    (tmp_path / "ada").mkdir()
    (tmp_path / "ada/05_the_barrier.ipynb").write_text(written()[:-40])
    if who == "student":
        said = bootcourse("submit", tmp_path / "ada", "--name", "Ada").out
    else:
        (said,) = collect(tmp_path)[0].problems
    remedy = {"student": "open it in JupyterLab, save it, and submit again", "lecturer": "ask for it again"}[who]
    assert "damaged or cut short" in said and remedy in said


@pytest.mark.skipif(os.name == "nt", reason="there, every argument is Unicode")
def test_a_name_with_a_byte_that_is_no_unicode_is_handed_in_read_and_handed_in_again(tmp_path, bootcourse):
    (tmp_path / "mine").mkdir()
    (tmp_path / "mine/05_the_barrier.ipynb").write_text(written())
    out = tmp_path / "class/zoe.json"
    for _ in range(2):
        answer = bootcourse("submit", tmp_path / "mine", "--out", out, "--name", os.fsdecode(b"Zo\xeb"))
        assert answer.status == 0, answer.err
    (one,) = collect(out.parent)
    assert one.problems == () and one.name == "Zo?" and NAME in one.answers


@pytest.mark.parametrize("text", ["Zo\udceb", "\ud83d alone", "a whole one: \U0001f600", "written out: \\ud83d"])
def test_what_is_written_as_json_can_be_read_again(text, tmp_path):
    write_json(tmp_path / "a.json", {"text": text, text: 1})
    sensible = text.encode("utf-8", "replace").decode()
    assert read_json(tmp_path / "a.json", dict) == {"text": sensible, sensible: 1}


def test_a_prediction_with_half_a_letter_is_kept_and_read(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    commit(Question("the_barrier.1", "Why?"), "because \ud83d")
    assert predictions()["the_barrier.1"]["answer"] == "because ?"


@pytest.mark.parametrize("encoding", ["utf-8-sig", "utf-16", "utf-16-le"])
def test_json_that_an_editor_saved_in_another_encoding_is_read(encoding, tmp_path):
    (tmp_path / "a.json").write_bytes('{"name": "Zoë"}'.encode(encoding))
    assert read_json(tmp_path / "a.json", dict) == {"name": "Zoë"}
    (tmp_path / "a.json").write_bytes('{"name": "Zoë"'.encode(encoding))
    with pytest.raises(BootcourseError, match="a.json is damaged"):
        read_json(tmp_path / "a.json", dict)
