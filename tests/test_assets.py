"""What ships: made from a study, checked against its manifest, never silently wrong."""

import json
import shutil
from functools import partial

import pytest

from bootcourse.episodes.rollout import Rollout
from bootcourse.errors import BootcourseError
from bootcourse.research import commands, ship
from bootcourse.research.cells import train_and_test, trained
from bootcourse.research.computed import in_assets
from bootcourse.research.jobs import Job, run_job
from bootcourse.research.results import load_results
from bootcourse.scenario import CALIBRATED, DEFAULT
from bootcourse.storage import assets
from bootcourse.storage.runs import find_runs, load_run

LONGER = "longer-view/gamma-0.95.npz"


def compute(root, name: str, method: str, seeds: int = 2, tests: int = 3, scenario=DEFAULT, teacher: str = "rule"):
    (root / "study.json").write_text("{}")
    tiny = {"learning_starts": 16, "hidden": (8,), "buffer_size": 2000}
    arguments = trained(seeds, 2, tests, (method,), scenario, teacher, **tiny)
    assert run_job(Job(name, partial(train_and_test, keep_runs=True), arguments), root) == ""


pytestmark = pytest.mark.usefixtures("unrendered")


@pytest.fixture(scope="module")
def study(unrendered, tmp_path_factory):
    """The smallest study that assets can be built from."""
    root = tmp_path_factory.mktemp("study")
    for name in ("default/sac", "longer-view/gamma-0.95", "sensitivity/as-it-is"):
        compute(root, name, "sac")
    compute(root, "default/soft", "soft")
    compute(root, "calibrated/sac", "sac", scenario=CALIBRATED)
    compute(root, "teachers/late-soft", "soft", teacher="late")
    return root


@pytest.fixture(scope="module")
def built(study, tmp_path_factory):
    folder = tmp_path_factory.mktemp("built") / "assets"
    ship.build(study, folder)
    return folder


@pytest.fixture
def shipped(built, tmp_path):
    return shutil.copytree(built, tmp_path / "assets")


def contents(folder) -> dict:
    return {path: path.read_bytes() for path in folder.rglob("*") if path.is_file()}


def test_everything_that_ships_is_listed_right_and_reads_back(built):
    assert assets.verify(built) == []
    entries = {entry["file"]: entry for entry in json.loads((built / "manifest.json").read_text())["files"]}
    assert {"study-default.npz", "study-calibrated.npz", LONGER, "MODEL_CARD.md"} <= entries.keys()
    assert {"sensitivity/as-it-is.npz", "report/report.md", "report/figures/default-returns.png"} <= entries.keys()
    assert all(entry["command"].startswith("bootcourse") and entry["versions"] for entry in entries.values())
    assert load_results(built / "study-default.npz").methods == ["sac", "soft"]
    taught = in_assets(built).experiments["teachers"]["late, soft"]
    assert [agent["teacher"] for agent in taught.agents] == ["late", "late"] and taught.sizes == (3, 2)
    assert [path.name for path in find_runs(built / "runs")] == ["sac-0", "sac-1", "soft-0", "soft-1"]
    assert Rollout.load(built / "rollouts/rule.npz").success
    card = (built / "MODEL_CARD.md").read_text()
    assert " of 2 (" in card.split("| sac |")[1] and "3 held-out episodes" in card


def test_a_damaged_missing_or_unlisted_file_is_named_with_the_command_that_makes_it(shipped, capsys):
    (shipped / LONGER).write_bytes(b"half")
    (shipped / "MODEL_CARD.md").unlink()
    (shipped / "notes.txt").write_text("mine")
    assert commands.report_assets(shipped) == 1
    printed = capsys.readouterr().out
    assert "gamma-0.95.npz is damaged" in printed and "bootcourse study longer-view --out DIR" in printed
    assert "MODEL_CARD.md is missing" in printed and "notes.txt is not in" in printed and "3 wrong" in printed


def test_a_text_whose_line_endings_were_changed_is_said_to_have_changed_there_and_in_nothing_else(shipped):
    for name in ("MODEL_CARD.md", "runs/sac-0/config.json"):
        (shipped / name).write_bytes((shipped / name).read_bytes().replace(b"\n", b"\r\n"))
    sentences = assets.verify(shipped)
    assert len(sentences) == 2 and all("line endings were changed" in words for words in sentences), sentences
    with pytest.raises(BootcourseError, match=r"config.json .* line endings were changed.*`git checkout` again\.$"):
        load_run(shipped / "runs/sac-0")


def test_what_cannot_be_built_is_one_sentence_and_what_ships_stays(study, shipped, tmp_path, monkeypatch):
    before, odd = contents(shipped), shutil.copytree(study, tmp_path / "study")
    (odd / "jobs/sensitivity/as-it-is").rename(odd / "jobs/sensitivity/what's-new")
    with pytest.raises(BootcourseError, match="'sensitivity/what's-new.npz' cannot ship .* a file's name has letters"):
        ship.build(odd, shipped)
    with monkeypatch.context() as patch, pytest.raises(BootcourseError, match="must stay under"):
        patch.setattr(ship, "LIMIT", 1000)
        ship.build(study, shipped)
    assert contents(shipped) == before
    shutil.copytree(study / "jobs/calibrated", tmp_path / "part/jobs/calibrated")
    with pytest.raises(BootcourseError, match="no finished jobs in jobs/default"):
        ship.build(tmp_path / "part", tmp_path / "new")
    with pytest.raises(BootcourseError, match="nothere holds no finished jobs"):
        ship.build(tmp_path / "nothere", shipped)
    with pytest.raises(BootcourseError, match="build needs --study"):
        commands.assets("build", None)


def test_what_a_study_has_not_computed_stays_as_it_ships(study, shipped, tmp_path):
    before = (shipped / "study-default.npz").read_bytes()
    shutil.copytree(study / "jobs/longer-view", tmp_path / "later/jobs/longer-view")
    (shipped / LONGER).write_bytes(b"old")
    (shipped / "readme").mkdir()
    (shipped / "readme" / "trap.png").write_bytes(b"picture")
    ship.build(tmp_path / "later", shipped)
    assert assets.verify(shipped) == [] and load_results(shipped / LONGER).methods == ["sac"]
    assert (shipped / "study-default.npz").read_bytes() == before
    assert (shipped / "readme" / "trap.png").read_bytes() == b"picture"


def test_what_ships_with_the_course_is_right_and_made_by_its_own_commands():
    assert assets.verify() == []
    entries = assets.read_manifest(assets.FOLDER)["files"]
    commands = {command.split()[0] for entry in entries for command in entry["command"].split(" && ")}
    assert commands == {"bootcourse"}


def test_the_report_is_made_again_from_what_ships_without_a_study(tmp_path):
    folder = shutil.copytree(assets.FOLDER, tmp_path / "assets")
    (folder / "report/report.md").write_text("spoiled")
    ship.build(None, folder)
    assert assets.verify(folder) == []
    for name in ("report/report.md", "study-default.npz"):
        assert (folder / name).read_bytes() == (assets.FOLDER / name).read_bytes()
