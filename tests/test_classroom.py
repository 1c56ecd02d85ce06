"""A class: answers are found without running a notebook, judged again in a closed process, told in tables and pages.

`python -m tests.classroom` does the same with forty students and every exercise.
"""

import csv
import json
import os
import socket
import sys
from pathlib import Path

import pytest

from bootcourse.cli import main
from bootcourse.course.classroom import grading, pages, report
from bootcourse.course.classroom.answers import answers_in, errors_in, unfinished, verdicts_in
from bootcourse.course.classroom.collect import collect
from bootcourse.course.classroom.grading import Graded, Graduate, Verdicts, identical, judge_all, key, other_versions
from bootcourse.course.classroom.judging import Judge
from bootcourse.course.classroom.points import read_lessons, read_points
from bootcourse.course.classroom.submission import Submission, fingerprint, from_folder
from bootcourse.course.lessons import registry
from bootcourse.errors import BootcourseError
from tests.classroom import ATTACKS, body, make, submission
from tools.course.source import NOTEBOOKS

NAME = "luck"
GRADED = [NAME, "lowest_rate", "share_of_the_future"]
RIGHT = "def luck(good, decisions, tries):\n    return 1 - (1 - (good / 9) ** decisions) ** tries\n"
ONE_TRY = "def luck(good, decisions, tries):\n    return (good / 9) ** decisions\n"


def cell(source: str, *outputs: dict) -> dict:
    return {"cell_type": "code", "source": source.splitlines(keepends=True), "outputs": list(outputs)}


def notebook(*cells: dict) -> dict:
    return {"cells": list(cells), "metadata": {}, "nbformat": 4}


# Answers --------------------------------------------------------------------------------------------


def test_an_answer_comes_with_what_it_uses_of_other_cells_and_with_nothing_else():
    mine = notebook(
        cell("import math\nimport numpy as np\nfrom bootcourse.course import check\n%time\nlaunch_missiles()"),
        cell("SHARE = 9\n\ndef once(good, decisions):\n    return (good / SHARE) ** decisions"),
        cell("def luck(good, decisions, tries):\n    return 0"),
        cell("def luck(good, decisions, tries):\n    return -np.expm1(tries * np.log1p(-once(good, decisions)))\n"
             "check.luck(luck)"),
    )  # fmt: skip
    text = answers_in(mine)[NAME]
    assert "import numpy as np" in text and "def once" in text and "SHARE = 9" in text and "np.expm1" in text
    assert "math" not in text and "missiles" not in text and "check" not in text and "return 0" not in text
    space = {}
    exec(text, space)
    assert space[NAME](3, 2, 1) == pytest.approx(1 / 9)


def test_a_cell_that_is_not_python_is_kept_as_it_is_for_the_judge_to_say_so():
    text = answers_in(notebook(cell("def luck(good, decisions, tries:\n    return 1\n\ncheck.luck(luck)")))[NAME]
    assert text.startswith("def luck(good, decisions, tries:") and "check." not in text


def test_what_a_check_said_and_which_cells_failed_is_read_from_the_outputs():
    right = {"output_type": "execute_result", "data": {"text/plain": ["✓ Right.\n", "Well."]}}
    mine = notebook(cell("check.luck(luck)", right), cell("1/0", {"output_type": "error"}), {"cell_type": 3}, cell("x"))
    assert verdicts_in(mine) == {NAME: "✓ Right.\nWell."} and errors_in(mine) == 1


@pytest.mark.parametrize("path", sorted(NOTEBOOKS.glob("solved/*.ipynb")), ids=lambda path: path.stem)
def test_every_answer_of_a_solved_notebook_is_found_and_of_the_students_a_stub(path):
    expected = {name for name, exercise in registry().items() if exercise.lesson == path.stem}
    solved = answers_in(json.loads(path.read_text(encoding="utf-8")))
    stubs = answers_in(json.loads((NOTEBOOKS / path.name).read_text(encoding="utf-8")))
    assert set(solved) == set(stubs) == expected
    assert not any(map(unfinished, solved.values())) and all(map(unfinished, stubs.values()))


# Submissions ----------------------------------------------------------------------------------------


@pytest.fixture
def folder(tmp_path):
    """A student's folder: a notebook, a kept answer, a prediction."""
    (tmp_path / "answers").mkdir()
    (tmp_path / "05_the_barrier.ipynb").write_text(json.dumps(notebook(cell(RIGHT), cell(body("decode", "...")))))
    (tmp_path / "answers/decode.py").write_text("def decode(observation, lanes):\n    return 1\n")
    kept = {"5.1": {"question": "How many?", "answer": "none", "choices": ["none", "all"], "unit": None, "time": ""}}
    (tmp_path / "answers/predictions.json").write_text(json.dumps(kept))
    return tmp_path


def test_submit_puts_answers_predictions_and_versions_into_one_file(bootcourse, folder):
    answer = bootcourse("submit", folder, "--name", "Ada <b>Lovelace")
    assert answer.status == 0 and "2 answers, 1 predictions" in answer.out, answer.err
    told = json.loads((folder / "submission-ada-b-lovelace.json").read_text())
    assert told["answers"][NAME] == RIGHT.rstrip() + "\n" and told["name"] == "Ada <b>Lovelace"
    assert "return 1" in told["answers"]["decode"], "the kept answer stands in for the stub"
    assert told["predictions"]["5.1"]["answer"] == "none" and told["versions"]["bootcourse"]
    (read,) = collect(folder_with(folder, "submission-ada-b-lovelace.json"))
    assert (read.student, read.exercises) == ("submission-ada-b-lovelace", fingerprint())


def test_what_the_course_has_solved_is_nobody_s_answer(bootcourse, tmp_path):
    (tmp_path / "solved").mkdir()
    (tmp_path / "solved/05_the_barrier.ipynb").write_text(json.dumps(notebook(cell(RIGHT))))
    (tmp_path / "05_the_barrier.ipynb").write_text(json.dumps(notebook(cell(body("decode", "...")))))
    answer = bootcourse("submit", tmp_path, "--name", "Ada")
    assert answer.out.endswith("0 answers, 0 predictions. No exercise is answered yet.\n")


def folder_with(folder: Path, file: str) -> Path:
    (folder / "class").mkdir()
    return (folder / file).rename(folder / "class" / file).parent


def test_submit_refuses_a_folder_without_notebooks_and_an_empty_name(bootcourse, folder, tmp_path):
    (tmp_path / "none").mkdir()
    assert "holds no notebook" in bootcourse("submit", tmp_path / "none", "--name", "A").err
    assert "The name is empty" in bootcourse("submit", folder, "--name", " ").err


def test_a_damaged_notebook_is_a_problem_and_not_the_end(folder):
    (folder / "06_demonstrations.ipynb").write_text('{"cells": [')
    made = from_folder(folder)
    assert NAME in made.answers and "06_demonstrations.ipynb is damaged" in made.problems[0]


@pytest.mark.parametrize("wrong", ['{"a"', "[]", "[" * 100_000, '{"format": "other"}', "\x00\xff"])
def test_what_is_no_submission_has_a_problem_and_no_answers(tmp_path, wrong):
    (tmp_path / "ada.json").write_text(wrong)
    (one,) = collect(tmp_path)
    assert one.student == "ada" and one.answers == {} and len(one.problems) == 1


def test_a_submission_with_parts_of_other_types_is_read_as_far_as_it_goes(tmp_path):
    odd = submission({NAME: RIGHT, "decode": 3, "unknown": "x"}, {"a": 1}, predictions={"5.1": 4, "x": {}}, problems=4)
    (tmp_path / "ada.json").write_text(odd.replace('"problems": 4', '"problems": [1, "late"]'))
    (one,) = collect(tmp_path)
    assert set(one.answers) == {NAME} and one.predictions == {} and one.problems == ("late",)


def test_late_is_a_day_after_the_deadline():
    on_the_day = Submission(made="2030-05-31T23:00:00+00:00", deadline="2030-05-31")
    assert not on_the_day.late and Submission(made="2030-06-01T00:10:00+00:00", deadline="2030-05-31").late


# Judging --------------------------------------------------------------------------------------------


@pytest.fixture(scope="module")
def judge():
    judge = Judge()
    yield judge
    judge.close()


def test_a_right_answer_passes_and_a_known_mistake_gets_its_sentence(judge):
    assert judge.ask(NAME, RIGHT, 10)["kind"] == "passed"
    verdict = judge.ask(NAME, ONE_TRY, 10)
    assert verdict["kind"] == "wrong" and verdict["sentence"] in [m.says for m in registry()[NAME].mistakes]


@pytest.mark.skipif(sys.platform != "linux", reason="only Linux shuts the process in")
def test_on_linux_nothing_outside_is_reached_and_the_next_answer_is_judged(judge, tmp_path):
    listener = socket.create_server(("127.0.0.1", 0))
    (tmp_path / "mine.txt").write_text("mine")
    given = {"pid": os.getpid(), "port": listener.getsockname()[1], "folder": str(tmp_path)}
    for what, lines in ATTACKS.items():
        text = body(NAME, lines.format(target=str(tmp_path / "theirs"), **given))
        verdict = judge.ask(NAME, text, 10)
        assert verdict["kind"] != "passed", what
        assert os.environ["PATH"][:20] not in str(verdict) or what != "spies"
    if set(judge.holds) == {"network", "processes", "files"}:
        assert [path.name for path in tmp_path.iterdir()] == ["mine.txt"]
        listener.settimeout(0.1)
        with pytest.raises(TimeoutError):
            listener.accept()
    listener.close()
    assert judge.ask(NAME, RIGHT, 10)["kind"] == "passed"


def test_a_process_that_dies_is_started_anew(judge):
    judge.ask(NAME, RIGHT, 10)
    judge.process.kill()
    assert judge.ask(NAME, RIGHT, 10)["kind"] == "passed"


# Other systems --------------------------------------------------------------------------------------


@pytest.mark.skipif(not Path("/bin/sh").exists(), reason="there it is so without a wrapper")
def test_without_fork_namespaces_and_landlock_answers_are_judged_in_processes_of_their_own(tmp_path, monkeypatch):
    as_elsewhere = (
        "from bootcourse.course.classroom import judging, sandbox; from bootcourse.course import runner; "
        "sandbox.shut_in = lambda folder: []; runner.FORKS = False; judging.main()"
    )
    python = tmp_path / "python"
    python.write_text(f"#!/bin/sh\nexec {sys.executable} -c '{as_elsewhere}' \"$3\"\n")
    python.chmod(0o755)
    monkeypatch.setattr(sys, "executable", str(python))
    judge = Judge()
    assert judge.ask(NAME, RIGHT, 10)["kind"] == "passed" and judge.holds == []
    assert "was stopped after 0.5 s" in judge.ask(NAME, body(NAME, "while True:\n    pass"), 0.5)["sentence"]
    assert judge.ask(NAME, ONE_TRY, 10)["kind"] == "wrong"
    judge.close()


def test_files_with_the_line_ends_of_windows_are_read_as_others(judge, folder):
    windows = {name: path.read_text().replace("\n", "\r\n") for name, path in (
        (path.name, path) for path in (folder / "answers/decode.py", folder / "answers/predictions.json"))}  # fmt: skip
    for name, text in windows.items():
        (folder / "answers" / name).write_bytes(text.encode())
    stub, mine = body("decode", "...").replace("\n", "\r\n"), RIGHT.replace("\n", "\r\n")
    saved = json.dumps(notebook(cell(mine), cell(stub)), indent=1).replace("\n", "\r\n")
    (folder / "05_the_barrier.ipynb").write_bytes(saved.encode())
    read = from_folder(folder)
    assert set(read.written) == {NAME, "decode"} and read.problems == () and read.predictions["5.1"]["answer"] == "none"
    assert judge.ask(NAME, read.answers[NAME], 10)["kind"] == "passed"
    assert "line 2, `retrun 1" in judge.ask(NAME, mine.replace("return 1", "retrun 1"), 10)["sentence"]


# Grading --------------------------------------------------------------------------------------------


@pytest.fixture(scope="module")
def graded(tmp_path_factory):
    """A small class, graded once: (folder, exit status, rows of the wide table)."""
    folder = tmp_path_factory.mktemp("class")
    few = {what: ATTACKS[what] for what in ("exits", "scribbles")}
    make(folder / "class", 2, GRADED, few)
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(sys, "argv", ["bootcourse", "grade", str(folder / "class"), "--out", str(folder / "grades.csv"),
                                    "--lessons", "5", "--workers", "1"])  # fmt: skip
        patch.setattr(grading, "LONGER", 0.5)
        with pytest.raises(SystemExit) as ended:
            main()
    return folder, ended.value.code or 0, rows(folder / "grades.csv")


def rows(path: Path) -> dict[str, dict]:
    return {row["id"]: row for row in csv.DictReader(path.read_text(encoding="utf-8-sig").splitlines())}


def test_each_student_is_graded_whatever_the_others_do(graded):
    _, status, table = graded
    assert status == 0
    assert table["twin-1"][NAME] == table["twin-2"][NAME] == "2"
    for student in ("empty", "damaged", "nested", "endless", "it-exits", "it-scribbles"):
        assert float(table[student]["points"]) == 0, student
    assert {"id", "name", "points", *GRADED} <= set(table["twin-1"])


def test_a_name_that_a_spreadsheet_would_compute_is_only_text(graded):
    assert graded[2]["other-version"]["name"] == "'=1+1"


def test_the_long_table_has_a_row_for_each_answer(graded):
    text = (graded[0] / "grades-answers.csv").read_text(encoding="utf-8-sig")
    found = list(csv.DictReader(text.splitlines()))
    assert len(found) == len(graded[2]) * sum(e.lesson.startswith("05") for e in registry().values())
    assert {row["result"] for row in found} == {"passed", "wrong", "did_not_run", "missing"}


def test_the_page_about_the_class_says_what_to_look_at(graded):
    text = (graded[0] / "grades-pages/class/index.html").read_text(encoding="utf-8")
    assert "other-version.html" in text and "made with another version" in text
    assert "did not run: <code>luck</code>" in text and "identical in all but spaces" in text
    assert "damaged.json is damaged" in text and "<b>Mallory" not in text and "<script>" not in text
    assert "How many?" in text


def test_a_student_s_page_has_the_check_s_words_and_no_foreign_tag(graded):
    text = (graded[0] / "grades-pages/it-scribbles.html").read_text(encoding="utf-8")
    assert "0 of" in text and "ValueError" in text and "<script>" not in text and "Feedback for &lt;b&gt;" in text


def test_a_grading_goes_on_where_it_was_stopped(graded, tmp_path):
    kept = (graded[0] / "grades-verdicts.jsonl").read_text().splitlines()
    (tmp_path / "v.jsonl").write_text("\n".join(kept) + '\n{"key": "cut')
    verdicts = Verdicts(tmp_path / "v.jsonl")
    assert len(verdicts.known) == len(kept)
    assert judge_all(collect(graded[0] / "class"), GRADED, verdicts, 1, progress=False) == []


def test_twins_are_found_and_who_wrote_little_is_not():
    text = dict.fromkeys(("a", "b", "c"), RIGHT)
    spaced = {name: RIGHT.replace("\n", "\n\n") for name in text}
    one, two, short = (Submission(student=s, answers=a) for s, a in (("1", text), ("2", spaced), ("3", {"a": RIGHT})))
    assert identical([one, two, short, Submission(student="4", answers={"a": RIGHT})]) == [["1", "2"]]


def test_another_version_is_told_and_an_unknown_one_is_not():
    own, other, unknown = (Submission(student=s, exercises=e) for s, e in (("a", fingerprint()), ("b", "x"), ("c", "")))
    assert other_versions([own, other, unknown]) == ["b"]


def test_known_mistakes_are_counted(tmp_path):
    mistake = registry()[NAME].mistakes[0]
    verdicts = Verdicts(tmp_path / "v.jsonl")
    verdicts.add(key(NAME, ONE_TRY), {"kind": "wrong", "sentence": mistake.says, "details": [], "known": True})
    two = [grading.graded(Submission(student=s, answers={NAME: ONE_TRY}), {NAME: 2.0}, verdicts) for s in ("a", "b")]
    text = pages.class_page(two, {NAME: 2.0}, {"a": "a.html", "b": "b.html"}, "")
    assert f"{pages.escape(mistake.says)} (2)" in text and "0&nbsp;of&nbsp;2" in text


def test_pages_of_students_with_like_names_do_not_overwrite_each_other():
    each = [Graduate(Submission(student=name), ()) for name in ("Ada B", "ada/b", "../ada b", "…")]
    names = pages.file_names(each)
    assert len(set(names.values())) == 4 and all("/" not in name for name in names.values())


def test_points_are_the_difficulty_unless_the_file_says_otherwise(tmp_path):
    assert read_points(None, {5})[NAME] == registry()[NAME].difficulty
    (tmp_path / "p.toml").write_text("default = 2\n[exercises]\nluck = 5.5\n")
    points = read_points(tmp_path / "p.toml")
    assert points[NAME] == 5.5 and points["decode"] == 2 and len(points) == len(registry())


@pytest.mark.parametrize(
    "text, sentence",
    [("[exercises]\nluk = 1", "did you mean 'luck'"), ("[exercises]\nluck = -1", "0 or more"),
     ("points = 3", "'points' is unknown"), ("= 3", "is no TOML"), ("default = true", "number of points")],
)  # fmt: skip
def test_a_wrong_file_of_points_gets_one_sentence(tmp_path, text, sentence):
    (tmp_path / "p.toml").write_text(text)
    with pytest.raises(BootcourseError, match=sentence):
        read_points(tmp_path / "p.toml")


def test_lessons_are_read_as_numbers():
    assert read_lessons("4-6,9") == {4, 5, 6, 9} and read_lessons("") is None
    with pytest.raises(BootcourseError, match="numbers of lessons"):
        read_lessons("four")


def test_the_table_of_an_empty_class_has_its_heading():
    assert report.wide([]) == [["id", "name", "points"]]
    assert Graded(NAME, "todo", 0.0).passed is False
