"""What a command asks of a system before it works: places for its output, processes that work together, processors."""

import json
import os
from pathlib import Path
from types import SimpleNamespace

import pytest

from bootcourse import caches, processes
from bootcourse.cli import places
from bootcourse.course.classroom import commands
from bootcourse.course.classroom.grading import Verdicts, judge_all
from bootcourse.course.classroom.submission import Submission
from bootcourse.errors import BootcourseError
from bootcourse.learn import training
from bootcourse.policies import idle_policy
from bootcourse.research.runner import run_jobs
from tests.conftest import drive_road_3

EMPTY = {"cells": [], "metadata": {}, "nbformat": 4, "nbformat_minor": 5}


def refuse(*arguments, **options):
    raise AssertionError("the work has begun")


@pytest.fixture
def folder(tmp_path, monkeypatch):
    """A working folder with a class of one, a drive, and a file where a command shall make a folder."""
    (tmp_path / "class").mkdir()
    (tmp_path / "class/ada.ipynb").write_text(json.dumps(EMPTY))
    drive_road_3(idle_policy, "idle").save(tmp_path / "drive.npz")
    (tmp_path / "file").write_text("mine")
    monkeypatch.chdir(tmp_path)
    monkeypatch.setenv("HOME", str(tmp_path / "home"))
    monkeypatch.setenv("USERPROFILE", str(tmp_path / "home"))
    return tmp_path


OUTPUTS = {
    "grade": ("grade", "class", "--out", "{}/grades.csv"),
    "train": ("train", "--episodes", "1", "--out", "{}/runs"),
    "drive": ("drive", "rule", "--out", "{}/drive.npz"),
    "the picture of drive": ("drive", "rule", "--out", "new.npz", "--png", "{}/drive.png"),
    "replay": ("replay", "drive.npz", "--png", "one.png", "--gif", "{}/two.gif"),
}


@pytest.mark.parametrize("what", OUTPUTS)
def test_a_place_that_cannot_be_written_is_named_before_the_work(what, folder, bootcourse, monkeypatch):
    for place, name in ((training, "Training"), (commands, "read_lessons")):
        monkeypatch.setattr(place, name, refuse)
    for module, function in (("episodes.record", "record"), ("plots.animation", "key_frame")):
        monkeypatch.setattr(f"bootcourse.{module}.{function}", refuse)
    before = sorted(folder.iterdir())
    answer = bootcourse(*(word.format("file") for word in OUTPUTS[what]))
    assert answer.status == 2 and answer.err.startswith("Cannot write file/") and answer.err.count("\n") == 1, (
        answer.err
    )
    assert sorted(folder.iterdir()) == before


def test_a_full_disk_is_noticed_before_the_work(folder, monkeypatch):
    def full(dir):
        raise OSError(28, "No space left on device")

    monkeypatch.setattr(places.tempfile, "TemporaryFile", full)
    with pytest.raises(BootcourseError, match="Cannot write results.csv: No space left on device. Free some space"):
        places.ask_for(Path("results.csv"))


def test_a_folder_that_is_missing_is_made_and_the_command_says_so(folder, bootcourse):
    answer = bootcourse("grade", "class", "--out", "results/grades.csv")
    assert answer.status == 0 and "There was no folder results: it is made." in answer.err
    assert Path("results/grades.csv").exists() and Path("results/grades.html").exists()


@pytest.mark.parametrize("option", ["--out=~/mine/ada.json", "--out ~/mine/ada.json"])
def test_what_a_shell_left_of_the_home_folder_is_the_home_folder(option, folder, bootcourse):
    answer = bootcourse("submit", "class", "--name", "Ada", *option.split())
    assert answer.status == 0 and Path("home/mine/ada.json").exists() and not Path("~").exists(), answer.err


def test_a_user_without_a_home_folder_is_told_and_other_words_stay(monkeypatch):
    monkeypatch.setattr(places.os.path, "expanduser", lambda path: path)
    with pytest.raises(BootcourseError, match="--out=~/runs: this user has no home folder"):
        places.with_home("--out=~/runs")
    for word in ("--name=~x", "~x", "a~/b", "--quiet", "C:\\a~1"):
        assert places.with_home(word) == word


@pytest.mark.parametrize("answer", [RuntimeError("no home"), "~/.cache/bootcourse"], ids=["raised", "left as it is"])
def test_compiled_code_of_a_user_without_a_home_folder_is_never_looked_for_in_the_working_folder(answer, monkeypatch):
    def without_home(name):
        if isinstance(answer, Exception):
            raise answer
        return answer

    monkeypatch.setattr(caches, "user_cache_dir", without_home)
    monkeypatch.delenv("NUMBA_CACHE_DIR", raising=False)
    assert caches.cache_places() == [caches.PACKAGE / "__pycache__"]


def test_where_processes_cannot_share_a_semaphore_one_sentence_comes_before_the_work(folder, monkeypatch):
    def semaphore():
        raise OSError(30, "Read-only file system")

    context = SimpleNamespace(Semaphore=semaphore)
    monkeypatch.setattr(processes.multiprocessing, "get_context", lambda name: context)
    with pytest.raises(BootcourseError, match="Read-only file system.*/dev/shm that can be written"):
        run_jobs([], folder / "study")
    answers = Submission(answers={"luck": "def luck(good, decisions, tries):\n    return 1"})
    with pytest.raises(BootcourseError, match="/dev/shm"):
        judge_all([answers], ["luck"], Verdicts(folder / "verdicts.jsonl"), 2)


@pytest.mark.skipif(not hasattr(os, "sched_setaffinity"), reason="this system gives every process all processors")
def test_processes_are_counted_by_the_processors_that_may_be_used(folder, bootcourse, monkeypatch):
    asked = []
    monkeypatch.setattr("bootcourse.course.classroom.grading.judge_all", lambda *given: asked.append(given[-1]) or [])
    before = os.sched_getaffinity(0)
    os.sched_setaffinity(0, {min(before)})
    try:
        bootcourse("grade", "class")
    finally:
        os.sched_setaffinity(0, before)
    assert asked == [1]


def test_no_file_counts_processors_in_another_way():
    kit = Path(processes.__file__).resolve().parents[1]
    files = [path for top in ("bootcourse", "tools") for path in (kit / top).rglob("*.py")]
    counting = {path.name for path in files if b"cpu_count" in path.read_bytes()}
    assert len(files) > 100 and counting == {"processes.py"}
    assert not [path for path in files if b"ProcessPoolExecutor()" in path.read_bytes()], "as many as the machine has"
