"""The set-up: the lock, the doctor, and a command line that says what it wants."""

import io
import json
import os
import re
import shutil
import socket
import subprocess
import sys
import tomllib
from pathlib import Path

import pytest

from bootcourse import __version__, doctor
from bootcourse.course import board
from bootcourse.course.verdict import Verdict
from bootcourse.statistics import Estimate
from bootcourse.storage import assets
from tests.jupyterlab import CALM

ROOT = Path(__file__).resolve().parent.parent
LOCKS = ("environment.lock", "student.lock")


def requirements(lock: str) -> list[str]:
    """The lock's requirements, each with its hashes on one line."""
    text = (ROOT / lock).read_text().replace("\\\n", " ")
    return [line for line in text.splitlines() if not line.startswith("#")]


# The lock


@pytest.mark.parametrize("lock", LOCKS)
def test_a_lock_is_exact_and_hashed_and_names_no_cuda_package_no_address_and_no_folder(lock):
    for line in requirements(lock):
        assert re.fullmatch(r"[a-z0-9.-]+==\S+( ; [^-]+)?(\s+--hash=sha256:[0-9a-f]{64})+", line), line
    text = (ROOT / lock).read_text()
    assert not re.search(r"^(nvidia|cuda|triton)|://|--index|--find-links|\s/\w", text, flags=re.MULTILINE)


def test_on_linux_the_lock_takes_only_the_cpu_build_of_torch():
    (linux,) = [line for line in requirements("environment.lock") if re.match(r"torch==.* == 'linux'", line)]
    (others,) = [line for line in requirements("environment.lock") if re.match(r"torch==.* != 'linux'", line)]
    assert linux.startswith("torch==2.13.0+cpu ;")
    assert others.startswith("torch==2.13.0 ;")
    hashes = [set(re.findall(r"sha256:(\w+)", line)) for line in (linux, others)]
    assert not hashes[0] & hashes[1]


def test_everything_that_pyproject_asks_for_is_in_the_lock():
    project = tomllib.loads((ROOT / "pyproject.toml").read_text())["project"]
    locked = {line.partition("==")[0] for line in requirements("environment.lock")}
    extras = project["optional-dependencies"]
    assert "bootcourse[book]" in extras["test"]
    asked = project["dependencies"] + extras["test"] + extras["book"]
    assert {re.match(r"[\w-]+", requirement)[0] for requirement in asked} - {"bootcourse"} <= locked


def test_the_students_lock_is_the_part_of_the_lock_that_the_lessons_need():
    project = tomllib.loads((ROOT / "pyproject.toml").read_text())["project"]
    lessons = {re.match(r"[\w-]+", requirement)[0] for requirement in project["dependencies"]}
    student = requirements("student.lock")
    assert set(student) < set(requirements("environment.lock"))
    names = {line.partition("==")[0] for line in student}
    assert lessons | {"setuptools"} <= names, "setuptools builds the package itself"
    assert not names & {"pytest", "sphinx", "playwright", "ruff"}


# Where it is installed


def test_every_place_has_the_oldest_python_that_the_course_runs_on():
    oldest = tomllib.loads((ROOT / "pyproject.toml").read_text())["project"]["requires-python"].removeprefix(">=")
    assert (ROOT / ".binder/runtime.txt").read_text() == f"python-{oldest}\n"
    assert json.loads((ROOT / ".devcontainer/devcontainer.json").read_text())["image"] == f"python:{oldest}"
    assert f"\nFROM python:{oldest}-slim\n" in (ROOT / "tools/image/Dockerfile").read_text()


@pytest.mark.skipif(not shutil.which("bash"), reason="the scripts are for Linux and macOS")
@pytest.mark.parametrize("script", ["tools/install.sh", "tools/hub.sh", ".binder/postBuild"])
def test_a_script_has_no_error_of_syntax_and_calls_files_that_exist(script):
    assert subprocess.run(["bash", "-n", script], cwd=ROOT).returncode == 0
    text = (ROOT / script).read_text()
    assert re.search(r"^set -e", text, re.M), "a step that fails ends it"
    assert [name for name in re.findall(r"tools/[\w.]+", text) if not (ROOT / name).exists()] == []


@pytest.mark.skipif(not shutil.which("bash"), reason="the scripts are for Linux and macOS")
def test_the_install_compiles_the_road_and_the_learner_and_jupyterlab_will_ask_nothing(tmp_path):
    python, called = tmp_path / "python", tmp_path / "called"
    python.write_text(f'#!/bin/sh\necho "$@" >> {called}\ncase "$2" in *sys.prefix*) echo {tmp_path};; esac\n')
    python.chmod(0o755)
    subprocess.run(["sh", "tools/install.sh", str(python), "student.lock"], cwd=ROOT, check=True, capture_output=True)
    *_, lock, package, prefix, compiled, page, learner = called.read_text().splitlines()
    assert lock.endswith("--require-hashes -r student.lock") and "--editable ." in package
    assert "bootcourse.doctor import road" in compiled and "bundle" in page and "learner='compiled'" in learner
    exec(learner.removeprefix("-c "), names := {})
    assert names["t"].updates == 1, "the first update compiles the learner"
    settings = json.loads((tmp_path / "share/jupyter/lab/settings/overrides.json").read_text())
    assert settings == {name: CALM[name] for name in settings}, "the settings that the tests of JupyterLab rely on"
    assert CALM["@jupyterlab/apputils-extension:notification"] in settings.values()


@pytest.mark.skipif(not shutil.which("git"), reason="there is no Git")
def test_a_clone_as_git_for_windows_makes_it_has_the_same_bytes(tmp_path):
    kit, clone, git = tmp_path / "kit", tmp_path / "clone", ("git", "-c", "user.name=x", "-c", "user.email=x@x")
    one_of_each = {path.suffix: path.relative_to(ROOT) for path in sorted((ROOT / "assets").rglob("*.*"))}
    for name in (".gitattributes", ".ci/run", ".binder/postBuild", "Makefile", "tools/hub.sh", *one_of_each.values()):
        (kit / name).parent.mkdir(parents=True, exist_ok=True)
        shutil.copy(ROOT / name, kit / name)
    for command in (["init", "-q", kit], ["-C", kit, "add", "."], ["-C", kit, "commit", "-q", "-m", "all"]):
        subprocess.run([*git, *command], check=True)
    subprocess.run([*git, "-c", "core.autocrlf=true", "clone", "-q", kit, clone], check=True)
    files = [path.relative_to(kit) for path in kit.rglob("*") if path.is_file() and ".git" not in path.parts]
    assert {".sh", ".npz", ".json", ".png"} <= {path.suffix for path in files}
    assert [name for name in files if (clone / name).read_bytes() != (kit / name).read_bytes()] == []


# The doctor


def test_the_doctor_finds_nothing_that_stops_the_lessons_here(bootcourse):
    answer = bootcourse("doctor")
    assert answer.status == 0 and "STOP" not in answer.out, answer.out
    assert len(answer.out.splitlines()) < 40, "it fits on one screen"


@pytest.mark.parametrize(
    ("package", "version", "status", "said"),
    [
        ("gymnasium", "0.0.1", 0, r"note  gymnasium is 0\.0\.1, and the lessons were made with \d(.|\n)*make lab"),
        ("numba", None, 1, "STOP  not installed: numba\n        -> Run `make lab`"),
        ("nbval", None, 0, "note  not installed, and only the tests need it: nbval"),
    ],
    ids=["another version is noted", "what the lessons need stops", "what only the tests need is noted"],
)
def test_the_doctor_says_what_is_wrong_with_a_package(package, version, status, said, monkeypatch, capsys):
    real = doctor.installed_version
    monkeypatch.setattr(doctor, "installed_version", lambda name: version if name == package else real(name))
    monkeypatch.setattr(doctor, "CHECKS", (doctor.packages,))
    assert doctor.main() == status and re.search(said, capsys.readouterr().out)


def refuses(error: Exception):
    """A function that only raises this."""

    def refuse(*arguments, **options):
        raise error

    return refuse


AMISS = {
    "gymnasium is not installed": (
        doctor.road, (sys.modules, "gymnasium", None), "STOP  road: gymnasium is not installed",
    ),
    "no local port can be opened": (
        doctor.port, (socket, "create_server", refuses(PermissionError(13, "Permission denied"))),
        "no page can be served on 127.0.0.1",
    ),
    "the cache is full": (
        doctor.cache, (doctor.tempfile, "TemporaryFile", refuses(OSError(28, "No space left on device"))),
        "cannot hold the compiled road: No space left on device",
    ),
    "the lessons are not there": (doctor.lessons, (doctor, "ROOT", Path("nowhere")), "STOP  the lessons are not in"),
    "the shipped results are not there": (
        doctor.lessons, (assets, "FOLDER", Path("nowhere")), "STOP  the results that the lessons",
    ),
}  # fmt: skip


@pytest.mark.parametrize("what", AMISS)
def test_the_doctor_finds_that(what, monkeypatch, capsys):
    import bootcourse.road.compiled  # noqa: F401  it looks for its folder once, here before anything is amiss

    check, (place, name, value), sentence = AMISS[what]
    (monkeypatch.setitem if isinstance(place, dict) else monkeypatch.setattr)(place, name, value)
    monkeypatch.setattr(doctor, "CHECKS", (check,))
    assert doctor.main() == 1 and sentence in capsys.readouterr().out


@pytest.mark.parametrize(("cloned", "remedy"), [(True, "git checkout assets"), (False, "new download")])
def test_the_doctor_s_remedy_for_damaged_files_fits_a_clone_and_a_download(cloned, remedy, tmp_path, monkeypatch):
    (tmp_path / "notebooks").mkdir()
    (tmp_path / "notebooks/01.ipynb").touch()
    if cloned:
        (tmp_path / ".git").mkdir()
    monkeypatch.setattr(doctor, "ROOT", tmp_path)
    monkeypatch.setattr(assets, "verify", lambda: ["One is damaged."])
    (found,) = doctor.lessons()
    assert found.level == "STOP" and remedy in found.remedy


def test_the_doctor_reads_the_lock_for_this_platform_only():
    lines = ["here==1.0 ; sys_platform != 'nowhere'", "elsewhere==2.0 ; sys_platform == 'nowhere'", "plain==3.0+cpu"]
    lock = "".join(f"{line} \\\n    --hash=sha256:00\n" for line in lines)
    assert doctor.locked_versions(lock) == {"here": "1.0", "plain": "3.0+cpu"}


def test_the_doctor_speaks_when_nothing_is_installed():
    bare = [sys.executable, "-I", "-S", "bootcourse/doctor.py"]  # -S: no site-packages
    result = subprocess.run(bare, cwd=ROOT, capture_output=True, text=True, timeout=120)
    assert result.returncode == 1
    assert "is not installed" in result.stdout
    assert "make lab" in result.stdout


# The command line


def test_help_lists_the_commands_of_every_room(bootcourse):
    answer = bootcourse("--help")
    commands = re.findall(r"^  (\w+)  +[A-Z]", answer.out.partition("Commands:")[2], re.M)
    assert answer.status == 0 and {"doctor", "train", "study", "assets", "handout", "submit", "grade"} <= set(commands)


def test_a_command_imports_nothing_of_the_rooms_that_it_does_not_need():
    code = "import sys; from bootcourse.cli import main; sys.argv[1:] = ['train', '--help']\n"
    code += "try: main()\nfinally: print(*sys.modules)"
    said = subprocess.run([sys.executable, "-c", code], cwd=ROOT, capture_output=True, text=True).stdout
    loaded = said.splitlines()[-1].split()
    assert "bootcourse.cli" in loaded and not {"bootcourse.course", "bootcourse.research"} & set(loaded)


@pytest.mark.parametrize("command", ["", "study", "train"])
def test_help_can_be_printed_in_windows_usual_encoding(command, bootcourse, monkeypatch):
    printed = io.TextIOWrapper(io.BytesIO(), encoding="cp1252")
    monkeypatch.setattr(sys, "stdout", printed)
    assert bootcourse(*command.split(), "--help").status == 0
    print("of p, ξ and c → ✓", file=printed, flush=True)
    assert b"--help" in printed.buffer.getvalue() and b"of p, xi and c ? ?" in printed.buffer.getvalue()


@pytest.mark.parametrize("encoding", ["ascii", "cp1252"])
def test_what_a_notebook_shows_can_be_printed_on_every_terminal(encoding, monkeypatch):
    shown = [
        board.Board((board.Row("ξ = 200 α – mine", Estimate(1.0, 0.0, 2.0), own=True),)),
        Verdict("passed", "Right: α…"),
    ]
    printed = io.TextIOWrapper(io.BytesIO(), encoding=encoding)
    monkeypatch.setattr(sys, "stdout", printed)
    print(*shown, sep="\n", flush=True)
    text = printed.buffer.getvalue().decode(encoding)
    assert "xi = 200 alpha" in text and ("alpha..." in text) == (encoding == "ascii")


def test_the_version_is_the_packages_own(bootcourse):
    assert bootcourse("--version").out == f"bootcourse {__version__}\n"
    assert f"\nversion: {__version__}\n" in (ROOT / "CITATION.cff").read_text()


@pytest.mark.skipif(not Path("/bin/sh").exists(), reason="make is for Linux and macOS")
def test_make_refuses_an_old_python_in_one_sentence(tmp_path):
    old = tmp_path / "python3"
    old.write_text("#!/bin/sh\nexit 1\n")
    old.chmod(0o755)
    for name in ("Makefile", "environment.lock", "pyproject.toml"):
        (tmp_path / name).write_bytes((ROOT / name).read_bytes())
    environment = {**os.environ, "PYTHON": str(old)}
    result = subprocess.run(["make", "lab"], cwd=tmp_path, env=environment, capture_output=True, text=True)
    assert result.returncode != 0
    assert "bootcourse needs Python 3.11 or newer" in result.stdout


# The notebooks' marks


def test_a_student_sees_no_mark_of_the_tests():
    from tools.course.products import node
    from tools.course.source import read, sources

    cells = [cell for path in sources() for cell in read(path) if cell.is_code]
    assert not [cell.student for cell in cells if "NBVAL" in cell.student + cell.solved]
    assert any("nbval-check-output" in node(cell, cell.student).metadata.get("tags", []) for cell in cells)
