"""Predictions: what is kept, what a lesson's end shows, and the form on the page."""

import json
import subprocess
import sys
from pathlib import Path
from types import SimpleNamespace

import pytest

from bootcourse.course import answer_files, compare_predictions, predict, predicted, progress
from bootcourse.course.edition import solutions_are_open
from bootcourse.course.lessons import registry, stem
from bootcourse.course.notebook import beside_the_notebook
from bootcourse.course.prediction_form import PredictionForm
from bootcourse.course.predictions import FILE, predictions
from bootcourse.course.progress_card import note_passed
from bootcourse.errors import BootcourseError
from tests.panels import raise_in_callbacks, words  # noqa: F401

CHOICES = ["it escapes", "it stays"]


@pytest.fixture(autouse=True)
def folder(tmp_path, monkeypatch, raise_in_callbacks):  # noqa: F811
    """The student's folder."""
    monkeypatch.chdir(tmp_path)
    return tmp_path


def ask(**more) -> PredictionForm:
    return predict("the_barrier.1", "What does it do?", CHOICES, **more)


def test_a_click_keeps_the_answer_with_its_question_and_the_time_and_locks_the_form():
    form = ask()
    form.field.value = "it stays"
    form.button.click()
    kept = json.loads(FILE.read_text())["the_barrier.1"]
    assert (kept["answer"], kept["question"], kept["choices"]) == ("it stays", "What does it do?", CHOICES)
    assert kept["time"].endswith("+00:00")
    assert form.field.disabled and form.button.disabled and "You predict: it stays." in words(form)


@pytest.mark.parametrize("editor", ["VS Code", "Jupyter's server"])
def test_what_is_kept_lies_beside_the_notebook_in_whatever_folder_its_kernel_works(editor, folder, monkeypatch):
    notebook = folder / "lessons/04_the_barrier.ipynb"
    notebook.parent.mkdir()
    names = {"__vsc_ipynb_file__": str(notebook)} if editor == "VS Code" else {}
    monkeypatch.setenv("JPY_SESSION_NAME", "elsewhere.ipynb" if names else str(notebook))
    shell = SimpleNamespace(user_ns=names)
    monkeypatch.setattr("IPython.get_ipython", lambda: SimpleNamespace(kernel=SimpleNamespace(shell=shell)))
    ask(answer="it stays")
    assert "it stays" in (notebook.parent / FILE).read_text() and not FILE.exists()
    assert answer_files.file_of("luck") == notebook.parent / "answers/luck.py"
    (notebook.parent / "handout.json").write_text('{"solutions": false}')
    assert not solutions_are_open()


def test_without_a_kernel_what_is_kept_lies_in_the_working_folder(folder, monkeypatch):
    monkeypatch.setenv("JPY_SESSION_NAME", "/anywhere/04_the_barrier.ipynb")  # as in a terminal of JupyterLab
    assert beside_the_notebook() == Path()


def test_the_first_answer_stays():
    ask(answer="it stays")
    again = ask(answer="it escapes")
    assert "committed to “it stays” before" in again.sentence
    assert predictions()["the_barrier.1"]["answer"] == "it stays"


COMMITS = """import sys
from bootcourse.course import predict
for place in range(int(sys.argv[1]), int(sys.argv[1]) + 20):
    predict(f"the_barrier.{place}", "Why?", answer=f"because {place}")
"""


def test_notebooks_that_commit_at_the_same_time_lose_nothing(folder):
    kernels = [subprocess.Popen([sys.executable, "-c", COMMITS, str(first)]) for first in (1, 21)]
    assert [kernel.wait() for kernel in kernels] == [0, 0]
    assert len(predictions()) == 40


def test_numbers_are_kept_as_numbers_and_words_as_words():
    predict("the_barrier.2", "How far?", unit="m", answer="12.5 m")
    predict("the_barrier.3", "Why?", answer=" because  it\n is slow ")
    assert [one["answer"] for one in predictions().values()] == [12.5, "because it is slow"]


@pytest.mark.parametrize(
    "how, sentence",
    [
        ({"choices": CHOICES, "answer": "it stay"}, "did you mean 'it stays'"),
        ({"unit": "m", "answer": "far"}, "= 'far': give a number"),
        ({"unit": "", "answer": "inf"}, "give a number"),
        ({"answer": "  "}, "is empty: write an answer"),
        ({"answer": "x" * 3000}, "3000 characters"),
        ({"name": "5.1"}, 'as "the_barrier.1"'),
    ],
)
def test_what_is_no_answer_is_refused_in_one_sentence(how, sentence):
    with pytest.raises(BootcourseError, match=sentence):
        predict(**{"name": "the_barrier.1", **how})
    assert predictions() == {}


def test_a_damaged_file_is_named_and_not_overwritten():
    FILE.parent.mkdir()
    for text in ("{", "[]", '{"the_barrier.1": 3}'):
        FILE.write_text(text)
        assert "predictions.json is damaged" in words(ask())
        with pytest.raises(BootcourseError, match="damaged"):
            ask(answer="it stays")
        assert FILE.read_text() == text


def test_the_end_of_a_lesson_compares_and_escapes_what_a_student_wrote():
    ask(answer="it stays")
    predict("the_barrier.2", "How far?", unit="m", answer=80)
    predict("the_barrier.3", "Why?", answer="<script>alert(1)</script> | x")
    shown = compare_predictions("the_barrier", {1: "it `stays`", 2: 31.25, 3: "traps", 4: "nothing"}).data
    assert "What does it do? | it stays | it `stays` |" in shown and "How far? | 80 m | 31.25 m |" in shown
    assert "<script" not in shown and "&lt;script&gt;" in shown and "3 of 4 predictions" in shown


def test_the_cell_that_answers_begins_with_what_was_predicted(capsys):
    predicted("the_barrier.1")
    ask(answer="it stays")
    predicted("the_barrier.1")
    before, after = capsys.readouterr().out.splitlines()
    assert "the answer to prediction" in before and after.endswith("it stays. Was it so?")


def test_a_card_counts_what_is_done_follows_it_and_says_the_same_after_a_restart(folder):
    asks = ["predict(\n", '    "the_barrier.1", ...)\n', 'predict("the_barrier.2")']
    (folder / f"{stem('the_barrier')}.ipynb").write_text(json.dumps({"cells": [{"cell_type": "code", "source": asks}]}))
    card, own = progress("the_barrier"), [each for each in registry().values() if each.lesson == stem("the_barrier")]
    assert f"0 of 2 predictions committed, 0 of {len(own)} exercises right" in card.value and not FILE.exists()
    ask(answer="it stays")
    note_passed(own[0].name)
    note_passed(own[0].name)
    left = sum(each.minutes for each in own[1:])
    said = f"1 of 2 predictions committed, 1 of {len(own)} exercises right, {left} minutes of exercises to go."
    assert said in card.value and said in progress("the_barrier").value, "also in a new one"
    assert "0 of 2 predictions" in card._repr_mimebundle_()["text/html"], "a saved notebook is nobody's"
    assert f"1 of {len(registry())} exercises right" in progress().value, "the course"
    (folder / "answers/progress.json").write_text("{")
    assert "progress.json is damaged" in progress("the_barrier").value
    (folder / "answers/progress.json").unlink()
    FILE.write_text("{")
    assert "predictions.json is damaged" in progress("the_barrier").value, "and no traceback in a lesson's first cell"
