"""The command line, as a user meets it: sentences, exit statuses, files."""

import os
import re
import shutil
import signal
import subprocess
import sys
import time
from pathlib import Path

import pytest

from bootcourse.cli.driving import Driver, alike
from bootcourse.course.lessons import LESSONS
from bootcourse.episodes.rollout import Rollout
from bootcourse.errors import BootcourseError
from bootcourse.learn.settings import settings_for
from bootcourse.learn.training import Training
from bootcourse.methods import METHODS
from bootcourse.scenario import DEFAULT
from bootcourse.storage.runs import load_run
from bootcourse.storage.work import locked
from tests.waiting import until

LAST = len(LESSONS) - 1  # the number of the last lesson
COMMAND = [sys.executable, "-m", "bootcourse"]


def test_a_table_shows_the_accidents_apart_with_intervals(bootcourse):
    answer = bootcourse("evaluate", "idle", "--episodes", 20)
    assert answer.status == 0, answer.err
    assert re.search(r"success % +0\.0 \[0\.0, 16\.8\]", answer.out) and "23.4 [23.4, 23.4]" in answer.out
    for row in ("return", "speed m/s", "distance m", "collision %", "road departure %", "stoppage %"):
        assert f"\n{row} " in answer.out


def test_train_then_evaluate_then_drive(bootcourse, tmp_path):
    out = tmp_path / "runs"
    trained = bootcourse("train", "--method", "sac", "--seeds", 2, "--episodes", 3, "--out", out, "--quiet")
    assert trained.status == 0 and "No update was made" in trained.err, trained.err
    assert sorted(path.name for path in out.iterdir()) == ["sac-0", "sac-1"]
    evaluated = bootcourse("evaluate", out, "--episodes", 5)
    assert "sac-0" in evaluated.out and "mean of sac" in evaluated.out
    picture = tmp_path / "drive.png"
    driven = bootcourse("drive", out / "sac-1", "--out", tmp_path / "drive.npz", "--seed", 4, "--png", picture)
    assert driven.status == 0 and picture.read_bytes().startswith(b"\x89PNG"), driven.err
    rollout = Rollout.load(tmp_path / "drive.npz")
    assert (rollout.label, rollout.seed) == ("sac", 4) and rollout.q_values is not None


def test_a_training_takes_the_method_s_own_number_of_episodes_or_the_given_one(bootcourse, tmp_path, monkeypatch):
    keep = []
    monkeypatch.setattr(Training, "run", lambda training, *_: keep.append(training.episodes) or training.result(True))
    for folder, given in (("own", ()), ("given", ("--episodes", 7))):
        bootcourse("train", "--method", "ppo", "--seeds", 1, "--out", tmp_path / folder, "--quiet", *given)
    assert keep == [METHODS["ppo"].episodes, 7]


TEACHERS = """
def nine(cars, scenario):
    return 9
"""


@pytest.mark.parametrize(
    ("teacher", "sentence"),
    [
        ("t.py:nine", "Your rule 'nine' failed with the ego at x = 0.0 m, y = 8.0 m, 10.0 m/s: it returned 9, but"),
        ("t.py:ten", "t.py has no function 'ten'"),
        ("bad.py:nine", "bad.py cannot be loaded: SyntaxError: '(' was never closed (bad.py, line 1)."),
        ("lacks.py:nine", "lacks.py cannot be loaded: ModuleNotFoundError: No module named 'absent'."),
        ("t.txt:nine", "--teacher t.txt:nine: give a file and a function in it"),
        ("absent.py:nine", "--teacher absent.py:nine: there is no file absent.py."),
    ],
)
def test_what_is_wrong_with_a_teacher_is_one_sentence(teacher, sentence, bootcourse, tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    files = {"t.py": TEACHERS, "t.txt": TEACHERS, "bad.py": "nine = (", "lacks.py": "import absent"}
    for name, text in files.items():
        Path(name).write_text(text)
    answer = bootcourse("train", "--seeds", 1, "--episodes", 2, "--out", "new", "--quiet", "--teacher", teacher)
    assert answer.status == 2 and answer.err.startswith(sentence) and len(answer.err.splitlines()) == 1, answer.err
    assert not Path("new").exists()


def test_only_agents_that_differ_in_nothing_but_their_seed_are_averaged():
    def driver(label, **settings):
        return Driver(label, None, DEFAULT, settings_for(**settings))

    drivers = [driver("a-0", method="sac"), driver("a-1", method="sac"), driver("b-0", method="soft")]
    assert alike(drivers) == {"mean of sac": ["a-0", "a-1"]}
    others = [driver(f"c-{i}", method="sac", gamma=0.9) for i in range(2)]
    assert alike(drivers + others) == {"mean of a-0 ...": ["a-0", "a-1"], "mean of c-0 ...": ["c-0", "c-1"]}
    assert alike([Driver("rule", None, DEFAULT)] * 2) == {}


NEW = ["--out", "new"]
REFUSED = {
    "a mistyped method": (["train", "--method", "bootstraped", "--out", "new"], "did you mean 'bootstrapped'"),
    "a folder that is not empty": (["train", "--out", "full"], "exists already and is not empty"),
    "nothing to resume": (["train", "--out", "new", "--resume"], "no unfinished training"),
    "too many episodes": (["train", "--episodes", "99999999999", "--out", "new"], "from 1 to 100,000"),
    "a seed that is too large": (["train", "--first-seed", str(2**63), "--out", "new"], "from 0 to 8,000,000"),
    "a name that is too long": (["train", "--out", "x" * 300], "File name too long"),
    "a mistyped driver": (["evaluate", "rul"], "did you mean 'rule'"),
    "a method of another study": (
        ["study", "--only", "ppo", *NEW],
        "Method 'ppo' is not in this study: run `bootcourse study beyond --only ppo`.",
    ),
    "one part of a hundred": (["study", "elsewhere", "--only", "lander-god", *NEW], "Choose one of"),
    "a method of no study": (["study", "--only", "pso", *NEW], "did you mean 'soft'? Choose from"),
    "a mistyped backend": (["study", "--backend", "dusk", *NEW], "did you mean 'dask'"),
    "a scheduler for this machine": (["study", "--scheduler", "tcp://a:1", *NEW], "needs --backend dask"),
    "a method that an experiment has not": (["study", "teachers", "--only", "sac", *NEW], "'sac' is unknown"),
    "a folder without runs": (["evaluate", "full"], "holds no run: train one"),
    "a folder that is not there": (["evaluate", "runs/nope"], "'runs/nope' is unknown"),
    "the folder above the runs": (["evaluate", "deep"], "deep holds no run itself: name a folder in it, such as deep/"),
    "a study among runs": (["study", "--out", "deep/runs"], "deep/runs holds runs of `bootcourse train`: choose"),
    "a lesson that is not there": (
        ["handout", "new", "--lessons", "4-99"],
        f"there is no lesson 99, the last is {len(LESSONS) - 1}.",
    ),
    "no rollout": (["replay", "full/file.txt", "--text"], "file.txt is not a rollout: record one with"),
    "a held-out block that does not exist": (["evaluate", "rule", "--seed", "5000"], "seed = 5000"),
    "a rollout that exists": (["drive", "rule", "--out", "full/file.txt"], "exists already"),
    "a teacher for a driver that has none": (
        ["evaluate", "idle", "--teacher", "t.py:nine"],
        "--teacher t.py:nine: rule, idle, random drive without a teacher: leave it out.",
    ),
    "a submission of no folder": (["submit", "nowhere", "--name", "Ada"], "is not there: "),
    "a rollout with another ending": (["drive", "rule", "--out", "new"], "new does not end in .npz"),
}


@pytest.mark.parametrize("case", REFUSED)
def test_bad_input_gets_one_sentence_and_status_2(case, bootcourse, tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    (tmp_path / "full").mkdir()
    (tmp_path / "full" / "file.txt").write_text("mine")
    (tmp_path / "deep" / "runs" / "sac-0").mkdir(parents=True)
    for name in ("config.json", "provenance.json"):
        (tmp_path / "deep" / "runs" / "sac-0" / name).write_text("{}")
    arguments, sentence = REFUSED[case]
    answer = bootcourse(*arguments)
    assert answer.status == 2 and sentence in answer.err and len(answer.err.splitlines()) == 1, answer.err
    assert (tmp_path / "full" / "file.txt").read_text() == "mine" and not (tmp_path / "new").exists()


def test_a_command_imports_nothing_from_the_folder_in_which_it_is_typed(tmp_path):
    ran = tmp_path / "ran"
    for name in ("numpy", "gymnasium", "typer", "torch"):
        (tmp_path / "class" / name).mkdir(parents=True)
        (tmp_path / "class" / name / "__init__.py").write_text(f"open({str(ran)!r}, 'w')")
    elsewhere = os.environ | {"PYTHONPATH": str(Path(__file__).parents[1])}
    command = [*COMMAND, "grade", ".", "--out", "../grades.csv", "--lessons", "5"]
    answer = subprocess.run(command, cwd=tmp_path / "class", env=elsewhere, capture_output=True, timeout=60)
    assert answer.returncode == 0 and not ran.exists(), answer.stderr


@pytest.mark.skipif(os.name == "nt", reason="Windows has no SIGINT to send")
def test_a_training_that_is_stopped_loses_nothing_and_resumes(bootcourse, tmp_path):
    out = tmp_path / "runs"
    command = [*COMMAND, "train", "--method", "sac", "--seeds", "1", "--episodes", "600", "--out", str(out), "--quiet"]
    process = subprocess.Popen(command, stderr=subprocess.PIPE, text=True)
    assert until((out / "unfinished" / "checkpoint.npz").exists, 60)
    time.sleep(0.3)
    process.send_signal(signal.SIGINT)
    _, said = process.communicate(timeout=60)
    assert process.returncode == 130 and "To continue, run" in said
    again = bootcourse("train", "--out", out)
    assert again.status == 2 and "add --resume" in again.err
    resumed = bootcourse("train", "--out", out, "--resume", "--quiet")
    assert resumed.status == 0, resumed.err
    assert [path.name for path in out.iterdir()] == ["sac-0"]


def test_a_training_that_is_stopped_before_its_first_decision_says_how_to_go_on(bootcourse, tmp_path, monkeypatch):
    def stopped(*arguments):
        raise KeyboardInterrupt

    arguments = ("train", "--method", "sac", "--seeds", 1, "--episodes", 1, "--out", tmp_path / "runs", "--quiet")
    with monkeypatch.context() as patched:
        patched.setattr(Training, "run", stopped)
        answer = bootcourse(*arguments)
    assert answer.status == 130 and "To continue, run" in answer.err
    assert bootcourse(*arguments, "--resume").status == 0


def test_a_second_training_in_a_folder_is_refused(bootcourse, tmp_path):
    out = tmp_path / "runs"
    arguments = ("train", "--method", "sac", "--seeds", 1, "--episodes", 1, "--out", out, "--quiet")
    with locked(out / "unfinished", "training"):
        refused = bootcourse(*arguments)
        assert refused.status == 2 and "Another training is at work in" in refused.err
    assert list(out.iterdir()) == []
    assert bootcourse(*arguments).status == 0
    assert bootcourse(*arguments).status == 2 and [path.name for path in out.iterdir()] == ["sac-0"]
    assert "is finished" in bootcourse(*arguments, "--resume").out


def test_a_training_whose_checkpoint_is_damaged_says_what_to_do(bootcourse, tmp_path):
    work = tmp_path / "runs" / "unfinished"
    work.mkdir(parents=True)
    (work / "checkpoint.npz").write_bytes(b"half")
    arguments = ("train", "--method", "sac", "--seeds", 1, "--episodes", 1, "--out", tmp_path / "runs", "--quiet")
    refused = bootcourse(*arguments, "--resume")
    assert refused.status == 2 and f"Delete {work}, and start again without --resume." in refused.err
    assert "unfinished training" in bootcourse("evaluate", tmp_path / "runs").err
    shutil.rmtree(work)
    assert bootcourse(*arguments).status == 0


def test_a_resumed_training_refuses_other_settings_and_its_command_has_all_options(bootcourse, tmp_path, monkeypatch):
    (tmp_path / "mine.py").write_text("def follows(cars, scenario):\n    return 4\n")
    mine = ("--teacher", f"{tmp_path / 'mine.py'}:follows")
    begun = ("train", "--method", "soft", "--seeds", 1, "--episodes", 3, "--xi", 50, "--out", tmp_path / "runs", *mine)
    finished = Training.run
    monkeypatch.setattr(Training, "run", lambda training, *_: training.result(True))
    stopped = bootcourse(*begun, "--quiet")
    monkeypatch.setattr(Training, "run", finished)
    assert stopped.status == 130
    for words in (f"--teacher {mine[1]}", "--xi 50", "--episodes 3", "--quiet --resume"):
        assert words in stopped.err
    untaught = bootcourse("train", "--out", tmp_path / "runs", "--resume")
    assert untaught.status == 2 and "began with the teacher 'follows" in untaught.err
    given = {"--seeds": (3, " (not 1)"), "--xi": (70.0, " (not 50.0)"), "--method": ("sac", " (not soft)")}
    for option, (value, began) in (given | {"--setting": ("paper", "")}).items():
        refused = bootcourse("train", "--out", tmp_path / "runs", *mine, "--resume", option, value)
        expected = f"{option} {value}{began}: this training began with other options."
        assert refused.status == 2 and expected in refused.err
    assert bootcourse(*begun, "--quiet", "--resume").status == 0


LEARNER = """
from bootcourse.learn.learner import SACLearner

class MyLearner(SACLearner):
    def actor_loss(self, log_pi, q, kl):
        return super().actor_loss(log_pi, q, kl) + 0.01 * log_pi.exp().square().sum(-1).mean(-1)

class NoLearner:
    pass
"""


def test_a_learner_of_one_s_own_trains_and_drives(bootcourse, tmp_path):
    before = dict(METHODS)
    (tmp_path / "mine.py").write_text(LEARNER)
    mine = ("--learner", f"{tmp_path / 'mine.py'}:MyLearner")
    arguments = ("train", "--seeds", 1, "--episodes", 3, "--out", tmp_path / "runs")
    trained = bootcourse(*arguments, "--method", "sac", *mine)
    assert trained.status == 0, trained.err
    assert f"bootcourse evaluate {tmp_path / 'runs'} --learner" in trained.out
    assert "MyLearner-0" in bootcourse("evaluate", tmp_path / "runs", "--episodes", 3, *mine).out
    run, drive = tmp_path / "runs/MyLearner-0", tmp_path / "drive.npz"
    assert bootcourse("drive", run, "--out", drive, *mine).status == 0 and drive.exists()
    alone = bootcourse("drive", run, "--out", tmp_path / "other.npz")
    assert alone.status == 2 and "add the --learner FILE.py:CLASS" in alone.err and "damaged" not in alone.err
    refused = bootcourse(*arguments, "--learner", f"{tmp_path / 'mine.py'}:NoLearner")
    assert refused.status == 2 and "bootcourse.learn.protocol.Learner" in refused.err
    assert METHODS == before


def test_the_compiled_learner_trains_and_its_runs_say_so(bootcourse, tmp_path):
    arguments = ("train", "--method", "soft", "--seeds", 1, "--episodes", 3, "--learner", "compiled")
    trained = bootcourse(*arguments, "--out", tmp_path / "runs")
    assert trained.status == 0, trained.err
    assert "--learner" not in trained.out  # its agents are evaluated as all others
    assert load_run(tmp_path / "runs/soft-0").provenance["learner"] == "compiled"
    refused = bootcourse(*arguments[:2], "ppo", *arguments[3:], "--out", tmp_path / "other")
    assert refused.status == 2 and "The compiled learner has no method 'ppo'" in refused.err


def test_a_slow_teacher_is_announced_before_it_drives(bootcourse, tmp_path, monkeypatch):
    def no_training(*args, **kwargs):
        raise BootcourseError("Stopped here.")

    monkeypatch.setattr("bootcourse.learn.training.Training", no_training)
    waits = bootcourse("train", "--method", "dagger", "--teacher", "planner", "--out", tmp_path / "a")
    assert "may take minutes" in waits.err and "Stopped here." in waits.err
    quick = bootcourse("train", "--method", "dagger", "--teacher", "timid", "--out", tmp_path / "b")
    assert "may take minutes" not in quick.err and "Stopped here." in quick.err
