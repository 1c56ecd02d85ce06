"""What every test shares."""

import gc
import os
import signal
import sys
from dataclasses import dataclass
from pathlib import Path

import pytest

sys.path.insert(0, str(Path(__file__).resolve().parent.parent))  # so that `tests.agreement` is found under plain pytest

if signal.getsignal(signal.SIGINT) is signal.SIG_IGN:  # a shell ignores Ctrl-C for what it starts in the background
    signal.signal(signal.SIGINT, signal.default_int_handler)


# Students' notebooks, as they come, hold no answer: nothing that judges one is loaded ahead, seconds for each kernel.
os.environ["BOOTCOURSE_NO_ANSWERS"] = "1"


gc.disable()  # until all tests are known: what is loaded stays, and the garbage collector would look at it in vain


def pytest_configure(config):
    """The kernels of notebooks come from one warm process, begun before the workers."""
    if sys.platform != "linux":
        return
    from jupyter_client.provisioning import local_provisioner

    from tests import warm_kernels

    local_provisioner.launch_kernel = warm_kernels.launch
    if not hasattr(config, "workerinput") and any("notebooks" in given for given in config.args):
        process = warm_kernels.begin()
        config.add_cleanup(process.stdin.close)


def pytest_collection_finish(session):
    """What is loaded stays: the garbage collector looks at it no more, and looks less often."""
    gc.collect()
    gc.freeze()
    gc.set_threshold(20_000, 50, 100)
    gc.enable()


@pytest.hookimpl(wrapper=True, optionalhook=True)
def pytest_xdist_auto_num_workers(config):
    """One more than pytest-xdist takes: a quarter of the time a test waits, for a kernel, a browser or a process."""
    return (yield) + 1


# What takes each process a minute to compute, one process computes for all files that need it: the numbers in the
# lessons' texts, what the course claims, and the right answers to the exercises.
TOGETHER = {
    **dict.fromkeys(("test_book", "test_classroom", "test_course", "test_teaching"), "texts"),
    **dict.fromkeys(("test_assets", "test_stress"), "claims"),
    **dict.fromkeys(("test_lessons_checks", "test_lessons_values", "test_answer_forms"), "answers"),
}


@pytest.hookimpl(optionalhook=True)
def pytest_xdist_make_scheduler(config, log):
    """Each file in one process, and the files of `TOGETHER` in the same."""
    from xdist.scheduler import LoadFileScheduling

    class Scheduling(LoadFileScheduling):
        def _split_scope(self, nodeid: str) -> str:
            file = super()._split_scope(nodeid)
            return TOGETHER.get(Path(file).stem, file)

    return Scheduling(config, log) if config.getvalue("dist") == "loadfile" else None


@pytest.fixture(autouse=True)
def nothing_stays_open():
    """Every replay, panel, world and card that a test showed is closed after it."""
    yield
    if (register := sys.modules.get("bootcourse.one_per_cell")) is not None:
        for shown in register.running():
            shown.close()


def drive_road_3(driver, label: str):
    from bootcourse.episodes.record import record
    from bootcourse.scenario import DEFAULT

    return record(driver, [3], DEFAULT, label)[0]


@pytest.fixture(scope="module")
def escape():
    """The rule gets out."""
    from bootcourse.policies import rule_policy
    from bootcourse.scenario import DEFAULT

    return drive_road_3(rule_policy(DEFAULT), "rule")


@pytest.fixture(scope="module")
def idle():
    """Nothing is done."""
    from bootcourse.policies import idle_policy

    return drive_road_3(idle_policy, "idle")


@pytest.fixture(scope="module")
def crash():
    """Into trap 1, by hand."""
    from bootcourse.policies import plan_policy

    return drive_road_3(plan_policy([("accelerate straight", 30)]), "you")


@pytest.fixture(scope="module")
def web_page(tmp_path_factory):
    """The file of the page on which anyone drives and agents learn."""
    from bootcourse.web import build

    path = tmp_path_factory.mktemp("web") / "trap.html"
    build.main(["--out", str(path)])
    return path


@pytest.fixture(scope="module")
def visit(web_page):
    """Opens the page in Chromium without a network: visit("#road=7", width=390)."""
    from functools import partial

    from tests.browser import open_browser
    from tests.drive_page import opened

    with open_browser(offline=True) as new_page:
        yield partial(opened, new_page, web_page)


@dataclass(frozen=True)
class Answer:
    status: int
    out: str
    err: str


@pytest.fixture
def bootcourse(monkeypatch, capsys):
    """`bootcourse ARGUMENTS...`, run in this process."""

    from bootcourse.cli import main

    def run(*arguments) -> Answer:
        monkeypatch.setattr(sys, "argv", ["bootcourse", *map(str, arguments)])
        with pytest.raises(SystemExit) as ended:
            main()
        return Answer(ended.value.code or 0, *capsys.readouterr())

    return run


@pytest.fixture(scope="module")
def unrendered():
    """For tests of a report's words: bands are not resampled, and every figure is written as one pixel."""
    from matplotlib.figure import Figure
    from PIL import Image

    from bootcourse.plots import training_curves
    from bootcourse.statistics import iqm

    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(training_curves, "band", lambda curves: (iqm(curves, axis=0),) * 3)
        patch.setattr(Figure, "savefig", lambda figure, file, **options: Image.new("RGB", (1, 1)).save(file, "png"))
        yield
