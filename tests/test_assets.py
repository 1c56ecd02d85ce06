"""What ships: made from a study, checked against its manifest, never silently wrong."""

import importlib.util
import json
import shutil

import numpy as np
import pytest

from bootcourse.cli import studies
from bootcourse.episodes.rollout import Rollout
from bootcourse.errors import BootcourseError
from bootcourse.learn.settings import settings_for, with_seeds
from bootcourse.research import ship
from bootcourse.research.fingerprint import older
from bootcourse.research.jobs import Job, read_job, run_job
from bootcourse.research.results import in_assets, load_results
from bootcourse.scenario import CALIBRATED, DEFAULT
from bootcourse.storage import assets
from bootcourse.storage.runs import find_runs, load_run
from bootcourse.storage.sealed import write_sealed


@pytest.fixture(scope="module")
def study(tmp_path_factory):
    """The smallest study that assets can be built from."""
    root = tmp_path_factory.mktemp("study")
    (root / "study.json").write_text("{}")
    for name, scenario, method, teacher in (
        ("default/sac", DEFAULT, "sac", "rule"),
        ("default/soft", DEFAULT, "soft", "rule"),
        ("calibrated/sac", CALIBRATED, "sac", "rule"),
        ("sweep/00", DEFAULT, "sac", "rule"),
        ("sensitivity/as-it-is", DEFAULT, "sac", "rule"),
        ("teachers/late-soft", DEFAULT, "soft", "late"),
    ):
        agents = with_seeds(settings_for(method, learning_starts=16, hidden=(8,), buffer_size=2000), 2)
        assert run_job(Job(name, tuple(agents), scenario, 2, 3, teacher=teacher), root) == ""
    return root


@pytest.fixture(scope="module")
def built(study, tmp_path_factory):
    folder = tmp_path_factory.mktemp("built") / "assets"
    ship.build(study, folder)
    return folder


@pytest.fixture
def shipped(built, tmp_path):
    return shutil.copytree(built, tmp_path / "assets")


def test_everything_that_ships_is_listed_and_right(built):
    assert assets.verify(built) == []
    manifest = json.loads((built / "manifest.json").read_text())
    names = {entry["file"] for entry in manifest["files"]}
    assert {"study-default.npz", "study-calibrated.npz", "sweep.npz", "demonstrations.npz", "MODEL_CARD.md"} <= names
    assert {"sensitivity/as-it-is.npz", "report/report.md", "report/figures/default-returns.png"} <= names
    assert all(entry["command"].startswith("bootcourse") for entry in manifest["files"])
    behaviour = {entry["file"]: set(entry["behaviour"]) for entry in manifest["files"]}
    assert behaviour["study-default.npz"] == {"road", "rule", "sac", "soft"}
    assert behaviour["runs/sac-1/curves.npz"] == {"road", "sac"} and set(manifest["behaviours"]["sac"]) != set()
    assert behaviour["teachers/late-soft.npz"] == {"road", "rule", "teachers", "soft"}


def test_what_ships_reads_back(built):
    assert load_results(built / "study-default.npz").methods == ["sac", "soft"]
    taught = in_assets(built).experiments["teachers"]["late, soft"]
    assert [agent["teacher"] for agent in taught.agents] == ["late", "late"] and taught.sizes == (3, 2)
    assert [load_run(path).agent.settings.method for path in find_runs(built / "runs")] == [
        "sac",
        "sac",
        "soft",
        "soft",
    ]
    assert Rollout.load(built / "rollouts/rule.npz").success
    card = (built / "MODEL_CARD.md").read_text()
    assert " of 2 (" in card.split("| sac |")[1] and "3 held-out episodes" in card


def test_a_damaged_missing_or_unlisted_file_is_named_with_the_command_that_makes_it(shipped, capsys):
    (shipped / "sweep.npz").write_bytes(b"half")
    (shipped / "demonstrations.npz").unlink()
    (shipped / "notes.txt").write_text("mine")
    problems = assets.verify(shipped)
    text = "\n".join(problems)
    assert len(problems) == 3
    assert "sweep.npz is damaged" in text and "demonstrations.npz is missing" in text and "notes.txt is not in" in text
    assert "bootcourse sweep --out DIR" in text
    assert studies.report_assets(shipped) == 1 and "3 wrong" in capsys.readouterr().out


def test_a_file_made_by_older_code_is_named_and_not_called_wrong(shipped, capsys):
    manifest = assets.read_manifest(shipped)
    manifest["behaviours"]["sac"]["0000"] = [0.0]
    for entry in manifest["files"]:
        if entry["file"] == "sweep.npz":
            entry["behaviour"] |= {"sac": "0000", "removed since": "1111"}
    write_sealed(shipped / "manifest.json", manifest | {"format": assets.FORMAT})
    assert studies.report_assets(shipped) == 0
    printed = capsys.readouterr().out
    assert "sweep.npz is older than the code's removed since, sac: bootcourse sweep --out DIR" in printed
    assert "0 wrong, 1 made by older code" in printed and printed.count("is older than") == 1


def test_what_older_code_computed_stays_older_when_it_is_shipped_by_newer_code(study, tmp_path):
    later = shutil.copytree(study, tmp_path / "later")
    for name in ("sac", "soft"):
        path = later / "jobs/default" / name / "job.json"
        made = read_job(path.parent)
        if name == "sac":
            made["behaviour"]["sac"] = [0.0]
        else:  # earlier versions recorded no behaviour
            del made["behaviour"]
        write_sealed(path, made)
    ship.build(later, tmp_path / "assets")
    old = {sentence.split()[0]: sentence for sentence in older(tmp_path / "assets")}
    assert "study-default.npz" in old and "study-calibrated.npz" not in old and "sweep.npz" not in old
    assert "the code's sac:" in old["runs/sac-0/config.json"]
    assert "unrecorded behaviour" in old["runs/soft-0/config.json"]


def test_assets_that_are_too_large_are_refused_and_the_old_ones_stay(study, shipped, monkeypatch):
    monkeypatch.setattr(ship, "LIMIT", 1000)
    with pytest.raises(BootcourseError, match="must stay under"):
        ship.build(study, shipped)
    monkeypatch.undo()
    assert assets.verify(shipped) == [] and [path.name for path in shipped.parent.iterdir()] == ["assets"]


def test_a_study_that_is_not_complete_is_named(study, tmp_path):
    shutil.copytree(study / "jobs/calibrated", tmp_path / "jobs/calibrated")
    with pytest.raises(BootcourseError, match="no finished jobs in jobs/default"):
        ship.build(tmp_path, tmp_path / "assets")
    with pytest.raises(BootcourseError, match="build needs --study"):
        studies.assets("build", None, False)
    with pytest.raises(BootcourseError, match="did you mean 'verify'"):
        studies.assets("verfy", None, False)


def test_a_folder_that_is_no_study_is_named_and_changes_nothing(shipped, tmp_path):
    with pytest.raises(BootcourseError, match="nothere holds no finished jobs"):
        ship.build(tmp_path / "nothere", shipped)
    assert assets.verify(shipped) == [] and [path.name for path in tmp_path.iterdir()] == ["assets"]


def test_a_smaller_study_replaces_a_larger_one_only_if_told_to_and_the_other_runs_stay(shipped, tmp_path):
    small = tmp_path / "small"
    small.mkdir()
    (small / "study.json").write_text("{}")
    agents = with_seeds(settings_for("sac", learning_starts=16, hidden=(8,), buffer_size=2000), 1)
    assert run_job(Job("default/sac", tuple(agents), DEFAULT, 2, 2), small) == ""
    before = {path: path.read_bytes() for path in shipped.rglob("*") if path.is_file()}
    with pytest.raises(BootcourseError, match=r"smaller.*1 agents of sac instead of 2.*2 held-out.*--replace-larger"):
        ship.build(small, shipped)
    assert before == {path: path.read_bytes() for path in shipped.rglob("*") if path.is_file()}
    ship.build(small, shipped, replace_larger=True)
    assert len(load_results(shipped / "study-default.npz")) == 1 and assets.verify(shipped) == []
    assert {"soft-0", "sac-1"} <= {path.name for path in find_runs(shipped / "runs")}


def test_the_agents_of_a_method_that_a_study_has_not_computed_stay(study, shipped, tmp_path):
    before, later = load_results(shipped / "study-default.npz"), tmp_path / "later"
    later.mkdir()
    (later / "study.json").write_text("{}")
    for method in ("soft", "demos"):  # one that ships, and a new one
        agents = with_seeds(settings_for(method, learning_starts=16, hidden=(8,), buffer_size=2000, batch=8), 3)
        assert run_job(Job(f"default/{method}", tuple(agents), DEFAULT, 2, 3), later) == ""
    ship.build(later, shipped)
    after = load_results(shipped / "study-default.npz")
    assert [(agent["method"], agent["seed"]) for agent in after.agents] == [
        *(("demos", seed) for seed in range(3)),
        *(("sac", seed) for seed in range(2)),
        *(("soft", seed) for seed in range(3)),
    ]
    for kind in ("tested", "curves"):
        for name, values in getattr(after.of("sac"), kind).items():
            np.testing.assert_array_equal(values, getattr(before.of("sac"), kind)[name])
    entries = {entry["file"]: entry for entry in json.loads((shipped / "manifest.json").read_text())["files"]}
    assert {"sac", "soft", "demos"} <= entries["study-default.npz"]["behaviour"].keys()
    assert assets.verify(shipped) == [] and older(shipped) == []


def test_files_that_a_killed_build_had_moved_aside_are_put_back(shipped, bootcourse, monkeypatch):
    monkeypatch.setattr(assets, "FOLDER", shipped)
    assets.unfinished(shipped).mkdir()
    shipped.rename(assets.unfinished(shipped) / "old")
    answer = bootcourse("assets", "verify")
    assert answer.status == 0 and "0 wrong" in answer.out


def test_the_readme_s_pictures_stay_and_are_listed(study, shipped):
    (shipped / "readme").mkdir()
    (shipped / "readme" / "trap.png").write_bytes(b"picture")
    assert len(assets.verify(shipped)) == 1
    for _ in range(2):
        ship.build(study, shipped)
        assert assets.verify(shipped) == [] and (shipped / "readme" / "trap.png").read_bytes() == b"picture"


def test_what_a_study_has_not_computed_stays_as_it_ships(study, shipped, tmp_path):
    before = (shipped / "study-default.npz").read_bytes()
    shutil.copytree(study / "jobs/sweep", tmp_path / "later/jobs/sweep")
    (shipped / "sweep.npz").write_bytes(b"old")
    ship.build(tmp_path / "later", shipped)
    assert assets.verify(shipped) == [] and load_results(shipped / "sweep.npz").methods == ["sac"]
    assert (shipped / "study-default.npz").read_bytes() == before


def test_every_module_that_a_shipped_file_s_command_names_exists():
    commands = {entry["command"] for entry in json.loads((assets.FOLDER / "manifest.json").read_text())["files"]}
    modules = {command.split()[2] for command in commands if command.startswith("python -m")}
    assert len(modules) == 5 and all(importlib.util.find_spec(module) for module in modules)


def test_the_report_is_made_again_from_what_ships_without_a_study(tmp_path):
    folder = tmp_path / "assets"
    shutil.copytree(assets.FOLDER, folder)
    (folder / "report/report.md").write_text("spoiled")
    ship.build(None, folder)
    assert assets.verify(folder) == []
    assert (folder / "report/report.md").read_bytes() == (assets.FOLDER / "report/report.md").read_bytes()
    assert (folder / "study-default.npz").read_bytes() == (assets.FOLDER / "study-default.npz").read_bytes()
