"""A wheel, as `pip install .` makes it, holds all of the package, and says what only a clone has."""

import json
import os
import shutil
import subprocess
import sys
from pathlib import Path

import pytest

from bootcourse.storage import assets
from bootcourse.web import build, bundle

ROOT = Path(__file__).resolve().parent.parent
PIP = [sys.executable, "-m", "pip", "--disable-pip-version-check", "--quiet"]
IN_THE_WHEEL = """
import json, shutil, sys
import bootcourse as bc
from bootcourse.storage import assets
from bootcourse.web import build, bundle

agents, drive = (lambda: bc.shipped_agents("sac")), (lambda: bc.shipped_drive("rule"))
said = []
for what in (bc.board, agents, bc.shipped_results, drive, build.page):
    try:
        what()
    except bc.BootcourseError as error:
        said.append(str(error))
for name in ("manifest.json", "report/ablation.json"):
    (assets.FOLDER / name).parent.mkdir(exist_ok=True)
    shutil.copy(f"{sys.argv[1]}/{name}", assets.FOLDER / name)
bundle.content = lambda: {"names": build.names(), "data": "{}"}  # nothing is compiled
print(json.dumps({"file": bc.__file__, "said": said, "page": build.page()}))
"""


@pytest.fixture(scope="module")
def site(tmp_path_factory):
    """The folder into which the wheel is installed."""
    folder = tmp_path_factory.mktemp("wheel")
    kit, wheels, site = folder / "kit", folder / "wheels", folder / "site"
    shutil.copytree(ROOT / "bootcourse", kit / "bootcourse", ignore=shutil.ignore_patterns("numba-*"))
    for name in ("pyproject.toml", "README.md", "LICENSE"):
        shutil.copy(ROOT / name, kit)
    (kit / "bootcourse/__pycache__/numba-0").mkdir(parents=True, exist_ok=True)
    (kit / "bootcourse/__pycache__/numba-0/x.nbc").write_bytes(b"compiled for this machine")
    wheel = [*PIP, "wheel", "--no-deps", "--no-index", "--no-build-isolation", "-w", wheels, kit]
    subprocess.run(wheel, check=True, timeout=200)
    install = [*PIP, "install", "--no-deps", "--no-index", "--no-compile", "--target", site, *wheels.glob("*.whl")]
    subprocess.run(install, check=True, timeout=200)
    return site


def files(folder: Path) -> set[str]:
    inside = (path.relative_to(folder) for path in folder.rglob("*") if path.is_file())
    return {path.as_posix() for path in inside if "__pycache__" not in path.parts}


def test_it_holds_every_file_of_the_package_and_nothing_that_was_compiled(site):
    assert files(site / "bootcourse") == files(ROOT / "bootcourse")
    assert len(files(site / "bootcourse")) > 200 and not list(site.rglob("__pycache__"))


def test_its_page_is_the_clone_s_and_what_needs_the_shipped_results_says_so(site, monkeypatch):
    environment = os.environ | {"PYTHONPATH": str(site), "NUMBA_CACHE_DIR": str(site)}
    command = [sys.executable, "-P", "-c", IN_THE_WHEEL, str(assets.FOLDER)]
    run = subprocess.run(command, cwd=site, env=environment, capture_output=True)
    assert run.returncode == 0, run.stderr.decode()
    there = json.loads(run.stdout)
    assert Path(there["file"]).parent == site / "bootcourse"
    monkeypatch.setattr(bundle, "content", lambda: {"names": build.names(), "data": "{}"})
    assert there["page"] == build.page() and "</script>" in there["page"]
    assert len(there["said"]) == 5
    for sentence in there["said"]:
        assert "holds no shipped results" in sentence and "`pip install -e .`" in sentence
