"""A class: answers are read without running a notebook, judged in closed processes, and shown in a table and pages."""

import contextlib
import csv
import functools
import io
import json
import os
import socket
import sys
import tempfile
import unicodedata
from pathlib import Path

import msgspec
import pytest

from bootcourse.cli import main
from bootcourse.course import runner
from bootcourse.course.classroom import grading
from bootcourse.course.classroom import submission as classroom_submission
from bootcourse.course.classroom.answers import LONGEST, Answers, Clock, Notebook, unfinished
from bootcourse.course.classroom.commands import read_lessons
from bootcourse.course.classroom.grading import MISSING, Verdicts, handed_out, judge_all, key_of
from bootcourse.course.classroom.pages import write_report
from bootcourse.course.classroom.sandbox import HOLDS, shut_in
from bootcourse.course.classroom.submission import Submission, collect, fingerprint, from_notebooks
from bootcourse.course.exercise import source_of
from bootcourse.course.judge import judge
from bootcourse.course.lessons import number, registry, stem
from bootcourse.course.predictions import FILE
from bootcourse.errors import BootcourseError
from tests.answers import in_this_process
from tools.course.products import solved_notebook, student_file
from tools.course.source import lesson_of, sources

NAME = "luck"
LESSON = str(number(registry()[NAME].lesson.partition("_")[2]))
RIGHT = "def luck(good, decisions, tries):\n    return 1 - (1 - (good / 9) ** decisions) ** tries\n"
ONE_TRY = "def luck(good, decisions, tries):\n    return (good / 9) ** decisions\n"
SCRIPT = "<script>alert(1)</script>"
KEPT = {"5.1": {"question": "How many?", "answer": "none", "choices": ["none", "all"], "unit": None, "time": ""}}


def body(lines: str) -> str:
    """An answer that does something else instead."""
    return "def luck(good, decisions, tries):\n" + "\n".join(f"    {line}" for line in lines.splitlines())


def cell(source: str, *outputs: dict) -> dict:
    return {"cell_type": "code", "source": source.splitlines(keepends=True), "outputs": list(outputs)}


def notebook(*cells: dict) -> dict:
    return {"cells": list(cells), "metadata": {}, "nbformat": 4}


def read(notebook: dict) -> Notebook:
    return msgspec.json.decode(msgspec.json.encode(notebook), type=Notebook)


def answers_in(notebook: Notebook) -> dict[str, str]:
    return Answers(notebook, Clock()).texts()


# Answers --------------------------------------------------------------------------------------------


@pytest.mark.parametrize("path", sources(), ids=lesson_of)
def test_every_answer_of_a_solved_notebook_is_found_and_right_and_of_the_students_a_stub(path, monkeypatch):
    in_this_process(monkeypatch)
    expected = {name for name, exercise in registry().items() if exercise.lesson == stem(lesson_of(path))}
    stubs = answers_in(read(json.loads(student_file(path).read_bytes())))
    solved = answers_in(read(solved_notebook(path) or notebook()))
    assert set(solved) == set(stubs) == expected
    assert all(judge(registry()[name], text).passed for name, text in solved.items())
    assert not any(map(unfinished, solved.values())) and all(map(unfinished, stubs.values()))


def test_what_a_lesson_takes_over_from_earlier_ones_is_no_answer_of_its_own():
    takes_over = 'decode, reward = own_code.yours_or_ours("decode", "reward")'
    assert answers_in(read(notebook(cell(takes_over)))) == {}
    assert list(answers_in(read(notebook(cell(RIGHT), cell(takes_over))))) == ["luck"]


# Submissions ----------------------------------------------------------------------------------------


@pytest.fixture
def folder(tmp_path):
    """A student's folder: notebooks, a prediction, what the course has solved."""
    stub, decode = (f"def decode(observation, lanes):\n    {line}" for line in ("...", "return 1"))
    for name, source in {"05_the_barrier": RIGHT, "06_copy": decode, "07_empty": stub, "solved/08": ""}.items():
        path = tmp_path / "mine" / f"{name}.ipynb"
        path.parent.mkdir(parents=True, exist_ok=True)
        path.write_text(json.dumps(notebook(cell(source))))
    (tmp_path / "mine/answers").mkdir()
    (tmp_path / "mine/answers/predictions.json").write_text(json.dumps(KEPT))
    return tmp_path / "mine"


def test_submit_puts_answers_and_predictions_into_one_file_that_is_read_as_it_was(bootcourse, folder):
    out = folder.parent / "class" / "ada.json"
    answer = bootcourse("submit", folder, "--name", "Ada <b>Lovelace", "--out", out)
    assert answer.status == 0 and "Answers: 2. Predictions: 1. Hand in this file." in answer.out, answer.err
    (one,) = collect(out.parent)
    assert (one.student, one.name, one.exercises) == ("ada", "Ada <b>Lovelace", fingerprint())
    assert one.answers[NAME] == RIGHT.rstrip() + "\n" and one.predictions["5.1"].answer == "none"
    assert one.problems == () and "return 1" in one.answers["decode"], "a stub in another notebook does not replace it"
    (folder / "submission-ada.json").write_bytes(out.read_bytes())
    assert [each.answers for each in collect(folder.parent)][-1] == one.answers, "a folder with the file in it"


def test_a_name_is_the_same_whether_its_accents_were_typed_apart_or_not(bootcourse, folder):
    for name in ("René", "Rene\u0301"):
        answer = bootcourse("submit", folder, "--name", name)
        assert answer.status == 0 and (folder / "submission-rené.json").exists(), answer.err
    assert len(list(folder.glob("*.json"))) == 1


def test_submit_finds_what_a_kernel_kept_elsewhere_and_says_where_it_looked(bootcourse, folder, monkeypatch):
    monkeypatch.chdir(folder.parent)
    later, first = ({"answer": words, "time": f"2026-10-0{day}T00:00:00+00:00"} for day, words in ((2, "b"), (1, "a")))
    for place, kept in (("mine", {"a.1": later, "a.2": later}), (".", {"a.1": first})):
        Path(place, "answers").mkdir(exist_ok=True)
        Path(place, FILE).write_text(json.dumps(kept))
    answer = bootcourse("submit", "mine", "--name", "Ada")
    assert f"The predictions are those of mine/{FILE} and {folder.parent / FILE}." in answer.out
    handed_in = json.loads(Path("mine/submission-ada.json").read_text())["predictions"]
    assert [handed_in[name]["answer"] for name in ("a.1", "a.2")] == ["a", "b"], "the first answer to a question stays"
    assert from_notebooks(folder).predictions["a.1"].answer == "b", "a grading reads what is in the student's folder"
    for place in ("mine", "."):
        Path(place, FILE).unlink()
    answer = bootcourse("submit", "mine/06_copy.ipynb", "--name", "Ada")
    looked = f"there is no {FILE} in {folder} or {folder.parent}."
    assert f"No predictions were found: {looked}" in answer.out, answer.err


def test_a_notebook_that_was_handed_out_under_another_number_is_of_the_same_lesson(folder):
    (folder / "05_the_barrier.ipynb").rename(folder / "99_the_barrier.ipynb")
    assert from_notebooks(folder).lessons == ("the_barrier",)


def submission(**fields) -> dict:
    """The content of a file that `submit` writes."""
    return {"format": Submission.FORMAT, "exercises": fingerprint(), "time": "2030-01-01"} | fields


NO_SUBMISSION = {
    "half a file": '{"format": "bootcourse subm',
    "very deep": "[" * 100_000,
    "another format": '{"format": "other"}',
    "an answer that is a number": json.dumps(submission(answers={NAME: 3})),
    "an answer without an end": json.dumps(submission(answers={NAME: "x" * (LONGEST + 1)})),
    "a prediction without an answer": json.dumps(submission(predictions={"5.1": {}})),
}


@pytest.mark.parametrize("case", NO_SUBMISSION)
def test_what_is_no_submission_has_a_problem_that_names_the_file_and_no_answers(tmp_path, case):
    (tmp_path / "ada.json").write_text(NO_SUBMISSION[case])
    (one,) = collect(tmp_path)
    assert (one.student, one.answers) == ("ada", {}) and one.problems[0].startswith("ada.json")


TAKEN = {  # a file of the user's, and the command that would replace it
    "a notebook": ("mine/1.ipynb", ["submit", "mine", "--name", "Ada", "--out", "mine/1.ipynb"]),
    "another student's": ("submission-李.json", ["submit", "mine", "--name", "王", "--out", "submission-李.json"]),
    "a table among submissions": ("class/ada.json", ["grade", "class", "--out", "class/ada.csv"]),
    "a thesis": ("thesis.md", ["grade", "class", "--out", "thesis.md"]),
    "a table": ("pts.csv", ["grade", "class", "--out", "pts.csv"]),
    "verdicts": ("pts-verdicts.jsonl", ["grade", "class", "--out", "pts.csv"]),
    "a page of somebody": ("pts-pages/ada.html", ["grade", "class", "--out", "pts.csv"]),
    "an archive": ("course.zip", ["handout", "course", "--lessons", "5"]),
}  # fmt: skip


@pytest.mark.parametrize("case", TAKEN)
def test_no_command_replaces_a_file_that_it_did_not_write(case, bootcourse, folder, monkeypatch):
    monkeypatch.chdir(folder.parent)
    for name in ("class", "pts-pages"):
        (folder.parent / name).mkdir()
    taken, command = TAKEN[case]
    name = {"name": "李"} if case == "another student's" else {}
    for path in {"class/ada.json", taken}:
        (folder.parent / path).write_text(json.dumps(submission(time="by me", **name)))
    answer = bootcourse(*command)
    assert answer.status == 2 and len(answer.err.strip().splitlines()) == 1, answer.err
    assert "by me" in (folder.parent / taken).read_text()


def test_students_of_one_name_stay_apart_and_what_a_link_leads_to_is_not_read(tmp_path):
    secret, group = tmp_path / "secret", tmp_path / "class"
    for folder in (secret / "answers", group / "ada", group / ("d" * 255)):
        folder.mkdir(parents=True)
    (secret / "answers/predictions.json").write_text(json.dumps(KEPT))
    (group / "ada/answers").symlink_to(secret / "answers")
    (group / "bob").symlink_to(secret)
    for name in ("ada/05_the_barrier.ipynb", "ada.ipynb", "ada.json.ipynb", f"{'n' * 249}.ipynb"):
        (group / name).write_text(json.dumps(notebook(cell(RIGHT))))
    (group / "ada.json").write_text(json.dumps(submission(answers={NAME: RIGHT})))
    submissions = collect(group)
    long = "d" * 255, "n" * 249
    assert [one.student for one in submissions] == ["ada", "ada.ipynb", "ada.json", "ada.json.ipynb", "bob", *long]
    assert submissions[0].answers and not submissions[0].predictions and "was not read" in submissions[4].problems[0]
    worth, verdicts = {NAME: 2}, Verdicts(tmp_path / "v.jsonl")
    verdicts.known |= {key_of(NAME, one.answers[NAME]): MISSING for one in submissions if one.answers}
    write_report([grading.graded(one, worth, verdicts) for one in submissions], tmp_path / "out.csv", [])
    assert len(list((tmp_path / "out-pages").iterdir())) == len(submissions)


def test_the_pages_of_a_class_are_as_many_files_on_windows_and_macos(tmp_path):
    students = "ada", "Ada", "René", "Rene\u0301", "a:b", "a?b", "plain"
    own, verdicts = [Submission(student=name) for name in students], Verdicts(tmp_path / "v.jsonl")
    write_report([grading.graded(one, {NAME: 2}, verdicts) for one in own], tmp_path / "out.csv", [])
    pages = [path.name for path in (tmp_path / "out-pages").iterdir()]
    assert len({unicodedata.normalize("NFC", name).casefold() for name in pages}) == len(students)
    assert not set('<>:"|?*\\') & set("".join(pages)) and "plain.html" in pages


# Judging --------------------------------------------------------------------------------------------

SENDS = """import sys
frame = sys._getframe()
while 'connection' not in frame.f_locals:
    frame = frame.f_back
connection = frame.f_locals['connection']
from bootcourse.course.answer_process import Report, encoder
"""
ATTACKS = {
    "exits": "import os\nos._exit(0)",
    "kills": "import os\nfor process in (os.getppid(), {pid}, 1):\n    os.kill(process, 9)",
    "calls home": "import socket\nsocket.create_connection(('127.0.0.1', {port}), 2)",
    "writes": "open({target!r}, 'w').write('mine')",
    "deletes": "import shutil\nshutil.rmtree({folder!r}, ignore_errors=True)\nshutil.rmtree({folder!r})",
    "spies": "raise ValueError(open('/proc/{pid}/environ').read())",
    "fills": "x = bytearray(10**12)",
    "recurses": "def f():\n    return f()\nf()",
    "forks": "import os\nwhile True:\n    os.fork()",
    "starts a program": "import subprocess\nsubprocess.run(['ls'])",
    "makes memory that outlives it": "import ctypes\nif ctypes.CDLL(None).shmget(5, 2**20, 0o1777) < 0:\n    1 / 0",
    "makes files without a name": "import os\nos.memfd_create('x')",
    "looks into its judge": "import os\nopen(f'/proc/{{os.getppid()}}/mem', 'rb')",
    "forges its report": SENDS + "connection.send_bytes(encoder.encode(Report(changed=(9, 9))))",
    "sends half a report": SENDS + "import faulthandler, os\nfaulthandler.cancel_dump_traceback_later()\n"
    "os.write(connection.fileno(), b'\\0\\0\\1\\0')\nwhile True:\n    pass",
    "nests its report": SENDS + "import msgspec\npart = {{'kind': 'tuple', 'parts': []}}\n"
    "text = b'\\x82\\xa4kind\\xa5tuple\\xa5parts\\x91' * 10**5\n"
    "connection.send_bytes(b'\\x81\\xa7answers\\x91' + text + msgspec.msgpack.encode(part))",
    "sends an array that is too large": SENDS + "import msgspec\n"
    "part = {{'kind': 'array', 'array': (False, (2**63,), b'')}}\n"
    "connection.send_bytes(msgspec.msgpack.encode({{'answers': [part]}}))",
    "sends to a program": "import socket\na, _ = socket.socketpair(socket.AF_UNIX, socket.SOCK_DGRAM)\n"
    "a.sendto(b'x', {listener!r})",
    "reads a disk": "import os\nos.listdir('/dev')",
    "detaches": "import os\nif os.fork() == 0:\n    os.setsid()\n    while True:\n        pass\n1 / 0",
    "reads": "raise ValueError(open({mine!r}).read())",
    "makes readable": "import os\nos.chmod({mine!r}, 0o777)",
    "dates": "import os\nos.utime({mine!r}, (1, 1))",
    "talks to a program": "import socket\nsocket.socket(socket.AF_UNIX).connect({listener!r})",
    "fills the disk": "for k in range(200):\n    open(str(k), 'wb').write(bytes(2**20))",
    "writes a long file": "open('long', 'wb').write(bytes(2**25))",
    "changes compiled code": "from bootcourse.road import compiled\nopen(compiled.CACHE_FOLDER / 'x', 'w')",
    "cheats": "import os, sys\nsys.stdout.write('{{\"kind\": \"passed\"}}')\nos.write(1, b'passed')",
}


@pytest.fixture
def holds(tmp_path):
    """Answers are shut in as when a class is graded. What holds on this system."""
    with pytest.MonkeyPatch.context() as patch, tempfile.TemporaryDirectory() as folder:
        runner.stop()
        patch.setattr(runner, "SHUT_IN", functools.partial(shut_in, Path(folder)))
        yield grading.barriers(folder, grading.surroundings(folder))
        runner.stop()


@pytest.mark.skipif(sys.platform != "linux", reason="only Linux shuts the process in")
def test_on_linux_nothing_outside_is_reached_and_the_next_answer_is_judged(holds, tmp_path):
    (tmp_path / "mine.txt").write_text("a secret")
    said, kept = {}, (tmp_path / "mine.txt").stat()
    with socket.create_server(("127.0.0.1", 0)) as listener, socket.socket(socket.AF_UNIX) as other:
        other.bind(address := os.path.join(tempfile.mkdtemp(), "x"))
        other.listen()
        given = {"pid": os.getpid(), "port": listener.getsockname()[1], "folder": str(tmp_path),
                 "listener": address, "mine": str(tmp_path / "mine.txt")}  # fmt: skip
        for what, lines in ATTACKS.items():
            text = body(lines.format(target=str(tmp_path / "theirs"), **given))
            verdict = judge(registry()[NAME], text, 10)
            said[what] = verdict.sentence
            assert verdict.kind != "passed", what
            assert not any(ours in str(verdict) for ours in ("a secret", os.environ["PATH"][:20])), what
        if set(holds) == set(HOLDS):
            assert [path.name for path in tmp_path.iterdir()] == ["mine.txt"]
            changed = (tmp_path / "mine.txt").stat()  # all but the time of access: another program may read it
            assert changed[:7] == kept[:7] and changed.st_mtime == kept.st_mtime
            assert "No space left" in said["fills the disk"] and "File too large" in said["writes a long file"]
            refused = "reads", "makes readable", "dates", "talks to a program", "changes compiled code", "forks"
            for what in (
                *refused,
                "sends to a program",
                "reads a disk",
                "kills",
                "starts a program",
                "makes files without a name",
            ):
                assert "PermissionError" in said[what], said[what]
            assert "ZeroDivisionError" in said["makes memory that outlives it"]
            listener.settimeout(0.1)
            with pytest.raises(TimeoutError):
                listener.accept()
    assert judge(registry()[NAME], RIGHT, 10).passed


# Grading --------------------------------------------------------------------------------------------


@pytest.fixture(scope="module")
def graded(tmp_path_factory):
    """A small class, graded once: its folder."""
    folder = tmp_path_factory.mktemp("class")
    asked = {"5.1": {"question": f"How many? {SCRIPT}", "answer": SCRIPT}}
    students = {
        "ada": submission(answers={NAME: RIGHT}, predictions=asked),
        "Åke & co": submission(answers={NAME: RIGHT}),
        "mistaken": submission(
            answers={NAME: ONE_TRY}, right=[NAME], name="=1+1", exercises="older", predictions=asked
        ),
        "endless": submission(answers={NAME: body("while True:\n    pass")}),
        "mallory": submission(answers={NAME: body(f"raise ValueError('{SCRIPT}')")}, name=f"<b>M {SCRIPT}"),
    }
    (folder / "class/empty").mkdir(parents=True)
    for name in ("numpy", "bootcourse", "multiprocessing"):  # modules that somebody has handed in
        (folder / "class" / name).mkdir()
        (folder / "class" / name / "__init__.py").write_text(f"open({str(folder / 'ran')!r}, 'w')")
    (folder / "class/damaged.json").write_text("{")
    for student, content in students.items():
        (folder / f"class/{student}.json").write_text(json.dumps(content))
    with pytest.MonkeyPatch.context() as patch:
        arguments = ["grade", ".", "--out", folder / "grades.csv", "--lessons", LESSON, "--workers", "1"]
        patch.chdir(folder / "class")
        patch.setattr(sys, "argv", ["bootcourse", *map(str, arguments)])
        patch.setattr(grading, "LONGER", 0.5)
        with pytest.raises(SystemExit) as ended, contextlib.redirect_stderr(io.StringIO()) as said:
            main()
    assert not ended.value.code and not (folder / "ran").exists()
    (folder / "said").write_text(said.getvalue())
    return folder


def test_each_student_is_graded_whatever_the_others_do(graded):
    text = (graded / "grades.csv").read_text(encoding="utf-8-sig")
    rows = {row["id"]: row for row in csv.DictReader(text.splitlines())}
    assert rows["ada"][NAME] == rows["Åke & co"][NAME] == "2"
    assert all(float(rows[student]["points"]) == 0 for student in ("empty", "damaged", "endless", "mallory"))
    assert rows["mistaken"]["name"] == "'=1+1", "a name that a spreadsheet would compute is only text"
    assert "damaged: not all could be read. damaged.json is damaged" in (graded / "said").read_text()
    endless = (graded / "grades-pages/endless.html").read_text(encoding="utf-8")
    assert ", in line 2, <code>while True:</code>" in endless or ", in line 3, <code>pass</code>" in endless


def test_a_probe_that_returns_one_answer_for_each_row_costs_no_other_student(bootcourse, tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    imports = "import numpy as np\n"
    rows = "\n".join(line for line in source_of(registry()["unmasks"].solution).splitlines() if "return" not in line)
    rows = f"{imports}{rows}\n    return target(reward, demo, 3.0, end, value, 0.5) != right\n"
    right = imports + source_of(registry()["unmasks"].solution)
    many = "def unmasks(target):\n    return 20\n"
    Path("class").mkdir()
    for student, text in (("ada", right), ("by row", rows), ("how many", many)):
        Path(f"class/{student}.json").write_text(json.dumps(submission(answers={"unmasks": text})))
    lesson = str(number(registry()["unmasks"].lesson.partition("_")[2]))
    assert bootcourse("grade", "class", "--lessons", lesson, "--workers", "1").status == 0
    table = Path("grades.csv").read_text(encoding="utf-8-sig").splitlines()
    points = {row["id"]: float(row["unmasks"]) for row in csv.DictReader(table)}
    assert points["ada"] > 0 and points["by row"] == points["how many"] == 0
    said = [Path(f"grades-pages/{student}.html").read_text(encoding="utf-8") for student in ("by row", "how many")]
    assert all("Your function returns" in page or "Your probe returns" in page for page in said), said


def test_the_page_about_the_class_says_what_to_look_at_and_escapes_what_students_wrote(graded):
    text = (graded / "grades.html").read_text(encoding="utf-8")
    for part in (
        "made with another version", "did not run: <code>luck</code>",
        "right in the notebook, not here: <code>luck</code>",
        "damaged.json is damaged", "no answer written", "grades-pages/%C3%85ke%20%26%20co.html", "How many?",
        "Answers were judged", "(2)",
    ):  # fmt: skip
        assert part in text, part
    assert "<script" not in text and "<b>M" not in text


def test_a_student_s_page_has_the_check_s_words_and_no_foreign_tag(graded):
    text = (graded / "grades-pages/mallory.html").read_text(encoding="utf-8")
    assert "0 of" in text and "ValueError" in text and "<script" not in text and "Feedback for &lt;b&gt;" in text
    assert (graded / "grades-pages/Åke & co.html").exists()


def test_a_grading_goes_on_where_it_was_stopped(graded, tmp_path):
    lines = (graded / "grades-verdicts.jsonl").read_text(encoding="utf-8")
    (tmp_path / "v.jsonl").write_text(f'{lines}{{"key": "cut', encoding="utf-8")
    verdicts = Verdicts(tmp_path / "v.jsonl")
    assert len(verdicts.known) == len(lines.splitlines())
    assert judge_all(collect(graded / "class"), [NAME], verdicts, 1) == []


def test_a_class_is_graded_over_the_lessons_that_were_handed_out():
    given = [Submission(lessons=("the_barrier", "values")), Submission(lessons=("no lesson",)), Submission()]
    assert handed_out([given[0], *given]) == {number("the_barrier"), number("values")}
    assert handed_out(given[1:]) is None


def test_lessons_are_read_as_numbers():
    assert read_lessons("4-6,9") == {4, 5, 6, 9} and read_lessons("") is None
    for text in ("four", "4-", "6-4"):
        with pytest.raises(BootcourseError, match="numbers of lessons"):
            read_lessons(text)


# Whatever happens to one --------------------------------------------------------------------------


def dies_or_raises(exercise: str, source: str, seconds: float) -> grading.Judged:
    """In place of `judged`: one answer ends the process that judges it, and on another our own code raises an error."""
    if "ends it" in source:
        os._exit(9)
    if "breaks it" in source:
        raise RuntimeError("our own mistake")
    return grading.Judged("passed", "Right.")


@pytest.fixture(scope="module")
def broken(tmp_path_factory):
    """A class in which two answers break what judges them, and a file cannot be read: its folder, and what was said."""
    folder = tmp_path_factory.mktemp("broken")
    (folder / "class").mkdir()
    for k, text in enumerate(["right", "ends it", "breaks it", "right"]):
        content = submission(answers={NAME: f"{RIGHT}# {text} {k}\n"})
        (folder / f"class/{k}-{text.replace(' ', '-')}.json").write_text(json.dumps(content))
    (folder / "class/unread.json").write_text(json.dumps(submission(answers={NAME: RIGHT})))
    read_json, said = classroom_submission.read_json, io.StringIO()

    def unreadable(path, *more):
        if path.stem == "unread":
            raise RuntimeError("nobody thought of this")
        return read_json(path, *more)

    with pytest.MonkeyPatch.context() as patch, contextlib.redirect_stderr(said), pytest.raises(SystemExit) as ended:
        patch.chdir(folder)
        patch.setattr(grading, "judged", dies_or_raises)
        patch.setattr(classroom_submission, "read_json", unreadable)
        patch.setattr(sys, "argv", ["bootcourse", "grade", "class", "--lessons", LESSON, "--workers", "1"])
        main()
    return folder, ended.value.code, said.getvalue()


def test_an_answer_that_ends_its_judge_or_breaks_our_check_costs_no_other_student(broken):
    folder, status, said = broken
    rows = csv.DictReader((folder / "grades.csv").read_text(encoding="utf-8-sig").splitlines())
    points = {row["id"]: row[NAME] for row in rows}
    assert sorted(points.values()) == ["0"] * 3 + ["2"] * 2 and points["unread"] == "0"
    assert points["1-ends-it"] == points["2-breaks-it"] == "0"
    assert status == 1 and "Our own check broke off on 2 answers" in said and "luck of 1-ends-it" in said
    assert "unread: not all could be read. unread.json" in said and "nobody thought of this" in said


def test_the_pages_say_that_our_check_broke_off_and_what_to_send(broken):
    folder, *_ = broken
    page = (folder / "grades.html").read_text()
    assert "Our own check broke off on 2 answers." in page and "our check broke off: <code>luck</code>" in page
    own = (folder / "grades-pages/2-breaks-it.html").read_text()
    assert "our mistake and not yours" in own and "RuntimeError: our own mistake" in own


def test_what_our_check_broke_off_on_is_judged_again_next_time(broken):
    folder, *_ = broken
    assert len(Verdicts(folder / "grades-verdicts.jsonl").known) == 2


def test_a_class_in_which_no_process_starts_is_one_sentence(tmp_path, monkeypatch):
    monkeypatch.setattr(grading, "judge_together", lambda todo, pool, *more: todo)
    one = Submission(answers={NAME: RIGHT})
    with pytest.raises(BootcourseError, match="No process that judges starts"):
        judge_all([one], [NAME], Verdicts(tmp_path / "v.jsonl"), 1)
