"""Runs and checkpoints on disk: whole or not at all, and never believed when damaged."""

import json
import shutil
from dataclasses import asdict, replace

import numpy as np
import pytest
from safetensors.torch import load_file, save_file

from bootcourse.errors import BootcourseError
from bootcourse.files import sha256, write_json
from bootcourse.learn.settings import settings_for, with_seeds
from bootcourse.learn.training import Training
from bootcourse.scenario import DEFAULT, Sight
from bootcourse.storage.runs import find_runs, load_run, save_runs
from bootcourse.storage.sealed import write_sealed


def small_training(method: str = "bootstrapped", episodes: int = 12) -> Training:
    return Training(with_seeds(settings_for(method, demonstration_episodes=3, learning_starts=16), 2), episodes)


@pytest.fixture(scope="module")
def result():
    return small_training().run(progress=False)


@pytest.fixture
def run(result, tmp_path):
    return save_runs(result, tmp_path / "runs")[0]


def test_what_cannot_be_saved_or_asked_is_refused_with_a_sentence(result, run, tmp_path):
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


def test_weights_that_are_not_numbers_are_refused_even_with_the_right_hash(run):
    weights = load_file(run / "weights.safetensors")
    weights["actor.0"][0, 0, 0] = np.nan
    save_file(weights, run / "weights.safetensors")
    stored = json.loads((run / "provenance.json").read_text())
    stored["sha256"]["weights.safetensors"] = sha256(run / "weights.safetensors")
    del stored["seal"]
    write_sealed(run / "provenance.json", stored)
    with pytest.raises(BootcourseError, match="NaN or infinity"):
        load_run(run)


def replaced(run, name: str, **entries) -> None:
    """Replace entries of one of a run's JSON files, and its hash in provenance.json."""
    content = json.loads((run / name).read_text()) | entries
    content.pop("seal", None)
    (write_sealed if name == "provenance.json" else write_json)(run / name, content)
    if name != "provenance.json":
        digests = json.loads((run / "provenance.json").read_text())["sha256"]
        replaced(run, "provenance.json", sha256=digests | {name: sha256(run / name)})


@pytest.mark.parametrize(
    ("name", "entries", "words"),
    [
        ("config.json", {"format": "bootcourse run 99"}, "this version reads 'bootcourse run 1'"),
        ("config.json", {"scenario": asdict(replace(DEFAULT, sight=Sight(neighbours=6)))}, "actor.0"),
        ("config.json", {"settings": {"method": "bootstrapped", "hidden": [32, 32]}}, "actor.0"),
        ("config.json", {"settings": {"method": "bootstrapped", "hidden": [64]}}, "weights.safetensors is incomplete"),
        ("config.json", {"settings": {"method": "sac", "invented_later": 1}}, "no invented_later"),
        ("config.json", {"settings": {"method": "bootstrapped", "gamma": 10**400}}, "gamma"),
        ("config.json", {"episodes": 13}, "curves.npz"),
        ("config.json", {"comment": "x"}, "comment"),
        ("provenance.json", {"sha256": []}, "`$.sha256`"),
    ],
)
def test_a_wrong_entry_of_a_run_is_named_even_with_the_right_hash(run, name, entries, words):
    replaced(run, name, **entries)
    with pytest.raises(BootcourseError) as error:
        load_run(run)
    assert words in str(error.value) and str(run) in str(error.value) and "\n" not in str(error.value)


def test_a_run_that_cannot_be_written_leaves_nothing_behind(result, tmp_path, monkeypatch):
    def full(*args):
        raise OSError(28, "No space left on device")

    monkeypatch.setattr("os.fsync", full)
    with pytest.raises(BootcourseError, match="Cannot write"):
        save_runs(result, tmp_path / "runs")
    assert list((tmp_path / "runs").iterdir()) == []
    shutil.rmtree(tmp_path / "runs")
