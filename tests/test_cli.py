"""The command line, as a user meets it: sentences, exit statuses, files."""

import json
import os
import signal
import subprocess
import sys
import time
from pathlib import Path

import pytest

from bootcourse.episodes.rollout import Rollout


def bootcourse(*arguments, cwd=None) -> subprocess.CompletedProcess:
    command = [sys.executable, "-m", "bootcourse", *map(str, arguments)]
    return subprocess.run(command, capture_output=True, text=True, cwd=cwd, timeout=120)


def test_the_rule_s_table_shows_the_accidents_apart_with_intervals():
    answer = bootcourse("evaluate", "rule", "--episodes", 40)
    assert answer.returncode == 0, answer.stderr
    assert "success %                100.0 [91.2, 100.0]" in answer.stdout
    for row in ("return", "speed m/s", "distance m", "collision %", "road departure %", "stoppage %"):
        assert f"\n{row} " in answer.stdout


def test_json_holds_every_number_with_its_interval():
    answer = bootcourse("evaluate", "idle", "--episodes", 20, "--json")
    table = json.loads(answer.stdout)["idle"]
    assert table["returns"]["value"] == pytest.approx(23.4375) and table["success"]["high"] == pytest.approx(
        0.168, abs=1e-3
    )


def test_train_then_evaluate_then_drive(tmp_path):
    out = tmp_path / "runs"
    trained = bootcourse("train", "--method", "sac", "--seeds", 2, "--episodes", 3, "--out", out, "--quiet")
    assert trained.returncode == 0, trained.stderr
    assert sorted(path.name for path in out.iterdir()) == ["sac-0", "sac-1"]
    evaluated = bootcourse("evaluate", out, "--episodes", 5)
    assert "sac-0" in evaluated.stdout and "mean over seeds" in evaluated.stdout
    driven = bootcourse("drive", out / "sac-1", "--out", tmp_path / "drive.npz", "--seed", 4)
    assert driven.returncode == 0, driven.stderr
    rollout = Rollout.load(tmp_path / "drive.npz")
    assert (rollout.label, rollout.seed) == ("sac", 4) and rollout.q_values is not None


REFUSED = {
    "a mistyped method": (["train", "--method", "bootstraped", "--out", "new"], "did you mean 'bootstrapped'"),
    "a mistyped scenario": (["train", "--scenario", "calibratd", "--out", "new"], "did you mean 'calibrated'"),
    "a folder that is not empty": (["train", "--out", "full"], "exists already and is not empty"),
    "nothing to resume": (["train", "--out", "new", "--resume"], "no unfinished training"),
    "a mistyped driver": (["evaluate", "rul"], "did you mean 'rule'"),
    "a folder without runs": (["evaluate", "full"], "holds no run"),
    "a held-out block that does not exist": (["evaluate", "rule", "--seed", "5000"], "seed = 5000"),
    "a rollout that exists": (["drive", "rule", "--out", "full/file.txt"], "exists already"),
}


@pytest.mark.parametrize("case", REFUSED)
def test_bad_input_gets_one_sentence_and_status_2(case, tmp_path):
    (tmp_path / "full").mkdir()
    (tmp_path / "full" / "file.txt").write_text("mine")
    arguments, sentence = REFUSED[case]
    answer = bootcourse(*arguments, cwd=tmp_path)
    assert answer.returncode == 2 and sentence in answer.stderr, answer.stderr
    assert len(answer.stderr.strip().splitlines()) == 1 and "Traceback" not in answer.stderr
    assert (tmp_path / "full" / "file.txt").read_text() == "mine" and not (tmp_path / "new").exists()


@pytest.mark.skipif(os.name == "nt", reason="Windows has no SIGINT and SIGKILL to send")
@pytest.mark.parametrize("how", [signal.SIGINT, signal.SIGKILL])
def test_a_training_that_is_stopped_loses_nothing_and_resumes(how, tmp_path):
    out = tmp_path / "runs"
    command = [sys.executable, "-m", "bootcourse", "train", "--method", "sac", "--seeds", "1", "--episodes", "400"]
    process = subprocess.Popen([*command, "--out", str(out), "--quiet"], stderr=subprocess.PIPE, text=True)
    wait_for(out / "checkpoint.npz")
    time.sleep(0.5)
    process.send_signal(how)
    _, said = process.communicate(timeout=60)
    if how is signal.SIGINT:
        assert process.returncode == 130 and "Nothing is lost" in said
    again = bootcourse("train", "--out", out)
    assert again.returncode == 2 and "add --resume" in again.stderr
    resumed = bootcourse("train", "--out", out, "--resume", "--quiet")
    assert resumed.returncode == 0, resumed.stderr
    assert [path.name for path in out.iterdir()] == ["sac-0"]


def wait_for(path: Path, seconds: float = 60) -> None:
    end = time.monotonic() + seconds
    while not path.exists():
        assert time.monotonic() < end, f"{path} did not appear"
        time.sleep(0.05)
