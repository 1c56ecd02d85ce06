"""Runs on disk: whole or not at all. (test_hostile_files.py has the damages, test_behaviour.py what is read back.)"""

import shutil
import subprocess
from dataclasses import replace

import numpy as np
import pytest

from bootcourse.errors import BootcourseError
from bootcourse.learn.settings import settings_for, with_seeds
from bootcourse.learn.training import Training
from bootcourse.storage import runs
from bootcourse.storage.runs import find_runs, load_run, save_runs


def small_training(method: str = "bootstrapped", episodes: int = 12) -> Training:
    return Training(with_seeds(settings_for(method, demonstration_episodes=3, learning_starts=16), 2), episodes)


@pytest.fixture(scope="module")
def result():
    return small_training().run(progress=False)


@pytest.mark.skipif(not shutil.which("git"), reason="there is no Git")
def test_the_commit_is_the_kit_s_own_and_unknown_inside_somebody_else_s_repository(tmp_path, monkeypatch):
    thesis, kit = tmp_path / "thesis", tmp_path / "thesis/kit"
    kit.mkdir(parents=True)
    git = ("git", "-c", "user.name=x", "-c", "user.email=x@x")
    for repository in (thesis, kit):
        monkeypatch.setenv("GIT_DIR", str(thesis / ".git"))  # as in a hook of that repository
        assert runs._commit(kit) == "unknown"
        monkeypatch.delenv("GIT_DIR")
        assert runs._commit(kit) == "unknown"
        for command in (["init", "-q"], ["commit", "-q", "--allow-empty", "-m", f"of {repository.name}"]):
            subprocess.run([*git, "-C", str(repository), *command], check=True)
    own = subprocess.run(["git", "-C", kit, "rev-parse", "--short=12", "HEAD"], capture_output=True, text=True).stdout
    monkeypatch.setenv("GIT_DIR", str(thesis / ".git"))
    assert runs._commit(kit) == own.strip()


def test_what_cannot_be_saved_or_asked_is_refused_with_a_sentence(result, tmp_path):
    run = save_runs(result, tmp_path / "runs")[0]
    twice = replace(result, agents=result.agents[:1] * 2)
    refused = [
        (lambda: save_runs(result, run.parent), "exists already"),
        (lambda: save_runs(twice, tmp_path / "twice"), "the same method and seed"),
        (lambda: save_runs(result, tmp_path / "with\0null"), "Choose another folder"),
        (lambda: save_runs(result, tmp_path / ("x" * 300)), "Choose another folder"),
        (lambda: load_run(run).agent.probabilities(np.zeros((1, 36))), "observes 26 numbers, not 36"),
        (lambda: find_runs(tmp_path / "nowhere"), "is not a folder"),
    ]
    for call, sentence in refused:
        with pytest.raises(BootcourseError, match=sentence):
            call()


def test_a_run_that_cannot_be_written_leaves_nothing_behind(result, tmp_path, monkeypatch):
    def full(*args):
        raise OSError(28, "No space left on device")

    monkeypatch.setattr("os.fsync", full)
    with pytest.raises(BootcourseError, match="Cannot write"):
        save_runs(result, tmp_path / "runs")
    assert list((tmp_path / "runs").iterdir()) == []
    shutil.rmtree(tmp_path / "runs")
